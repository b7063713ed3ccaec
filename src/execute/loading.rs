//! Forces of the first train of a graph on the supports of its seats, for settlements of one's own choice.

use super::machine::{Machine, RunError};
use crate::graph::{Clock, Graph, Runner};
use crate::nodes::{
    Builders, Forces, Kept, NodeError, PassageOutcome, Request, Substructure, Superstructure, Unloaded,
};
use crate::nodes::{Telling, TrackSystem};
use crate::store::Beds;
use std::ops::Range;

/// Steps by which a support is sunk, and the difference from the wanted void that is left / this void.
const SINKINGS: u32 = 200;
const NEAR: f64 = 0.01;

/// The plane track of a graph on its ground as built.
pub struct Loading<'a> {
    track: TrackSystem<'a>,
    ground: Box<dyn Substructure + 'a>,
    runner: Runner,
    passed: Range<f64>,
}

impl<'a> Loading<'a> {
    /// Builds the ground; `tell` gets the progress. `None` if no train runs.
    pub fn prepare(
        graph: &'a Graph,
        builders: &'a Builders,
        beds: &'a Beds,
        tell: &mut Telling<'_>,
    ) -> Result<Option<Loading<'a>>, RunError> {
        let Some(blocks) = graph.blocks() else { return Ok(None) };
        let machine = Machine { graph, builders, beds };
        let begun = machine.track_on_ground_that(|ground| ground.prepare(tell));
        let (track, ground) = begun.map_err(|cause| RunError::node(Clock::Axles(0), cause))?;
        let runner = Runner { kind: 0, direction: blocks.leading_direction() };
        let (train, plan) = blocks.kind(runner.kind);
        Ok(Some(Loading { track, ground, runner, passed: plan.passed(train) }))
    }

    /// Whether every wheel of the train passes a chainage, m.
    pub fn passes(&self, x: f64) -> bool {
        self.passed.contains(&x)
    }

    /// Settlement of every seat at the start of the scene, m.
    pub fn settlement(&self) -> Vec<f64> {
        self.ground.settlement()
    }

    /// These settlements (m) with some seats sunk together until the sleeper of `seat` hangs by a void, m. A rail that
    /// bends follows a support for a while before the sleeper leaves it.
    pub fn with_void(
        &self,
        settlement: &[f64],
        (seats, seat): (&[usize], usize),
        void: f64,
    ) -> Result<Vec<f64>, NodeError> {
        let mut sunk = settlement.to_vec();
        for _ in 0..SINKINGS {
            let found = self.track.equilibrium(&sunk, &[])?.seats[seat].void;
            if void == 0.0 || (found - void).abs() <= NEAR * void {
                return Ok(sunk);
            }
            seats.iter().for_each(|seat| sunk[*seat] += void - found);
        }
        let why = format!("no settlement of a sleeper gives it a void of {:.2} mm", 1e3 * void);
        Err(NodeError::Other { node: "track".into(), why })
    }

    /// One train over the track with these settlements (m), with the force history of every support.
    pub fn passage(&self, settlement: &[f64]) -> Result<(Unloaded, PassageOutcome), NodeError> {
        let forces = Forces::Histories;
        self.track.passage(Request { axles: 0, settlement, runner: self.runner, kept: Kept::Nothing, forces })
    }
}
