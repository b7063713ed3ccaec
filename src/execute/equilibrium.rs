//! The schedule of one state of rest: a track under test loads.

use super::machine::{Ending, Machine, RunError};
use super::{Event, Listener};
use crate::graph::{Clock, PointLoad};
use crate::nodes::{NodeError, Superstructure};

pub(super) fn run(machine: &Machine<'_>, loads: &[PointLoad], listener: &mut dyn Listener) -> Result<Ending, RunError> {
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let (track, ground) = machine.track_on_ground().map_err(at)?;
    let state = track.equilibrium(&ground.settlement(), loads).map_err(at)?;
    let told = listener.hear(&Event::Equilibrium(&state));
    if told.is_break() || listener.hear(&Event::Progress { done: 1, all: 1 }).is_break() {
        return Ok(Ending::Stopped);
    }
    Ok(Ending::Finished)
}
