//! Runs a graph: checks that it fits together, and lets its schedule advance its nodes.

use super::event::{Checkpoint, Listener, ScheduleState};
use super::machine::{Ending, Machine, RunError};
use super::{blocks, equilibrium, riding, tests_of_beds};
use crate::graph::{Graph, Schedule, faults};
use crate::nodes::Builders;
use crate::store::Beds;
use std::collections::BTreeMap;

/// A schedule of another program: it advances the nodes of the graph and reports events.
pub type Custom = dyn Fn(&Machine<'_>, &serde_json::Value, &mut dyn Listener, Option<serde_json::Value>) -> Result<Ending, RunError>
    + Send
    + Sync;

/// Runs graphs: with the nodes and schedules of this crate, and those that a program adds.
#[derive(Default)]
pub struct Executor {
    builders: Builders,
    schedules: BTreeMap<String, Box<Custom>>,
    beds: Beds,
}

impl Executor {
    /// With beds that are kept.
    pub fn with_beds(self, beds: Beds) -> Executor {
        Executor { beds, ..self }
    }

    /// With nodes of another program.
    pub fn with_builders(self, builders: Builders) -> Executor {
        Executor { builders, ..self }
    }

    /// With a schedule of another program, by its kind.
    pub fn with_schedule(mut self, kind: impl Into<String>, schedule: Box<Custom>) -> Executor {
        self.schedules.insert(kind.into(), schedule);
        self
    }

    /// Runs a graph, from its beginning or from a checkpoint. May be called from several threads at once. Independent
    /// parts run in the thread pool of the caller, and the result does not depend on the number of threads.
    pub fn run(
        &self,
        graph: &Graph,
        listener: &mut dyn Listener,
        from: Option<Checkpoint>,
    ) -> Result<Ending, RunError> {
        let faults = faults(graph);
        if !faults.is_empty() {
            return Err(RunError::Faults(faults));
        }
        let machine = Machine { graph, builders: &self.builders, beds: &self.beds };
        match &graph.schedule {
            Schedule::Static { loads } => equilibrium::run(&machine, loads, listener),
            Schedule::Blocks(plan) if graph.is_ridden() => riding::run(&machine, plan, listener, from),
            Schedule::Blocks(plan) => blocks::run(&machine, plan, listener, from),
            Schedule::Actuators(tests) => tests_of_beds::run(&machine, tests, listener, from),
            Schedule::Custom { kind, parameters } => {
                let schedule = self.schedules.get(kind).ok_or_else(|| RunError::NoSchedule { kind: kind.clone() })?;
                let from = match from.map(|checkpoint| checkpoint.state) {
                    None => None,
                    Some(ScheduleState::Custom(state)) => Some(state),
                    Some(_) => return Err(RunError::ForeignCheckpoint),
                };
                schedule(&machine, parameters, listener, from)
            }
        }
    }
}
