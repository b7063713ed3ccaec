//! Speed of the steps of a graph with grains under its track, without a full run.

use super::machine::{Machine, RunError};
use crate::graph::{Clock, Graph, Runner};
use crate::nodes::{
    Builders, Forces, GrainGround, Kept, Load, NodeError, Request, Substructure, Superstructure, Telling, TimedSteps,
    TrackSystem,
};
use crate::store::Beds;

/// Measurements of a track on grains under its first train.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measured {
    /// Steps that are timed.
    pub steps: u64,
    /// Whether a whole passage is run too, with an account of its energy.
    pub energy: bool,
    /// Whether the track is also computed for a second without a train, to measure its movement.
    pub idle: bool,
}

/// Time without a train, s.
const IDLE: f64 = 1.0;

/// Builds a track on grains, lets its first train come and times steps under its wheels. Fails if the scene has no
/// grains under a track with trains.
pub fn time_steps(
    graph: &Graph,
    beds: &Beds,
    measured: Measured,
    tell: &mut Telling<'_>,
) -> Result<TimedSteps, RunError> {
    let machine = Machine { graph, builders: &Builders::default(), beds };
    timed(&machine, measured, tell).map_err(|cause| RunError::node(Clock::Axles(0), cause))
}

fn timed(machine: &Machine<'_>, measured: Measured, tell: &mut Telling<'_>) -> Result<TimedSteps, NodeError> {
    let no_grains = NodeError::Other { node: "grains".into(), why: "the scene has no grains under a track".into() };
    let parts = machine.grain_parts().ok_or(no_grains)?;
    let blocks = machine.graph.blocks().ok_or(NodeError::NoTrain)?;
    let mut ground = GrainGround::new(parts);
    ground.prepare(tell)?;
    let mut track = TrackSystem::new(parts.track, Some(blocks), &machine.graph.records);
    track.stand_on(ground.responses())?;
    let runner = Runner { kind: 0, direction: blocks.leading_direction() };
    let settlement = ground.settlement();
    let request = Request { axles: 0, settlement: &settlement, runner, kept: Kept::Nothing, forces: Forces::Wheels };
    let (_, passage) = track.passage(request)?;
    let load = Load::new(&passage, 1);
    let mut timed = ground.time_steps(&load, measured.steps)?;
    timed.energy = if measured.energy { Some(ground.energy_of(&load, tell)?) } else { None };
    timed.idle_m = if measured.idle { Some(ground.idle(IDLE, tell)?) } else { None };
    Ok(timed)
}
