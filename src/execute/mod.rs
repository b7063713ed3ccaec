//! The executor: it checks a graph, builds its nodes, and advances them by the schedule.
//!
//! Listeners follow a run: recorders, progress, checkpoints, studies and charts get the same [`Event`]s, and each may
//! end the run.

mod blocks;
mod comparing;
mod comparison;
mod disturbed;
mod equilibrium;
mod event;
mod exchange;
mod executor;
mod failure;
mod loading;
mod machine;
mod oscillation;
mod pair;
mod riding;
mod step;
mod tests_of_beds;
mod timed;

pub use comparison::Comparison;
pub use disturbed::{BLOCKS, Disturbance, blocks_of_run, disturbances};
pub use equilibrium::at_rest;
pub use event::{Between, Both, Checkpoint, Event, Listener, ScheduleState};
pub use executor::{Custom, Executor};
pub use failure::diagnose;
pub use loading::Loading;
pub use machine::{Ending, Machine, RunError};
pub use step::BlockMeasures;
pub use timed::{Measured, time_steps};

pub use blocks::passage_as_built;

use crate::graph::Graph;
use rayon::prelude::*;

/// Runs a graph from its beginning with the nodes and schedules of this crate.
pub fn execute(graph: &Graph, listener: &mut dyn Listener) -> Result<Ending, RunError> {
    Executor::default().run(graph, listener, None)
}

/// Runs several graphs at once, each from its beginning, and keeps their order. The results are those of [`execute`],
/// bit for bit.
pub fn execute_all<L: Listener + Send>(runs: &mut [(&Graph, L)]) -> Vec<Result<Ending, RunError>> {
    runs.par_iter_mut().map(|(graph, listener)| execute(graph, listener)).collect()
}
