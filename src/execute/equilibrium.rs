//! The schedule of one state of rest: a track under test loads.

use super::machine::{Ending, Machine, RunError};
use super::{Event, Listener};
use crate::graph::{Clock, Graph, Model, PointLoad, Schedule};
use crate::nodes::{Builders, NodeError, Superstructure};
use crate::store::Beds;
use std::borrow::Cow;

/// A track of more elements is checked at rest on fewer of them.
const MANY: usize = 100_000;
/// Elements per bay in this check: cubic elements are exact at their nodes under the loads of a track at rest.
const ELEMENTS: u32 = 2;

pub(super) fn run(machine: &Machine<'_>, loads: &[PointLoad], listener: &mut dyn Listener) -> Result<Ending, RunError> {
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let (track, ground) = machine.track_on_ground().map_err(at)?;
    let settlement = ground.settlement();
    let unloaded = track.equilibrium(&settlement, &[]).map_err(at)?;
    let loaded = track.equilibrium(&settlement, loads).map_err(at)?;
    let told = listener.hear(&Event::Equilibrium { unloaded: &unloaded, loaded: &loaded });
    if told.is_break() || listener.hear(&Event::Progress { done: 1, all: 1 }).is_break() {
        return Ok(Ending::Stopped);
    }
    Ok(Ending::Finished)
}

/// The state of rest at the beginning of a run: computing it in the check finds errors before the run. Nothing is
/// computed for a graph without a track, or on a ground of another program.
pub fn at_rest(graph: &Graph) -> Result<(), RunError> {
    let known = |model: &Model| matches!(model, Model::Track(_) | Model::Law(_) | Model::Springs(_));
    if graph.track().is_none() || !graph.nodes.iter().all(|node| known(&node.model)) {
        return Ok(());
    }
    let loads = if let Schedule::Static { loads } = &graph.schedule { loads.as_slice() } else { &[] };
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let coarse = coarse(graph);
    let machine = Machine { graph: &coarse, builders: &Builders::default(), beds: &Beds::default() };
    let (track, ground) = machine.track_without_trains().map_err(at)?;
    let settlement = ground.settlement();
    track.equilibrium(&settlement, &[]).map_err(at)?;
    if !loads.is_empty() {
        track.equilibrium(&settlement, loads).map_err(at)?;
    }
    Ok(())
}

/// The graph itself, or with as few elements of its track as a state of rest needs.
fn coarse(graph: &Graph) -> Cow<'_, Graph> {
    let elements = graph.track().map_or(0, |track| track.seats.len() * track.elements_per_bay as usize);
    if elements <= MANY {
        return Cow::Borrowed(graph);
    }
    let mut coarse = graph.clone();
    for node in &mut coarse.nodes {
        if let Model::Track(track) = &mut node.model {
            track.elements_per_bay = ELEMENTS;
        }
    }
    Cow::Owned(coarse)
}
