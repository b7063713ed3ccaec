//! From a graph to a machine that runs: which schedule, which nodes, and why it stopped.

use super::event::{Checkpoint, Listener};
use super::{blocks, equilibrium, tests_of_beds};
use crate::graph::quantity::SETTLEMENT;
use crate::graph::{Clock, Fault, Graph, Node, Schedule, TrackNode, faults};
use crate::nodes::{Builders, NodeError, Substructure, Superstructure, TrackSystem};
use crate::store::Beds;
use std::collections::BTreeMap;
use std::fmt;

/// How a run ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The schedule is done.
    Finished,
    /// A listener ended it.
    Stopped,
}

/// Why a run failed.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    /// The nodes and edges of the graph do not fit together.
    Faults(Vec<Fault>),
    /// A node found no answer.
    Node { clock: Clock, cause: Box<NodeError> },
    /// A checkpoint of another schedule.
    ForeignCheckpoint,
    /// A schedule of another program, which nobody here can run.
    NoSchedule { kind: String },
}

impl RunError {
    /// The failure of a node, and how far the schedule was.
    pub fn node(clock: Clock, cause: NodeError) -> RunError {
        RunError::Node { clock, cause: Box::new(cause) }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::Faults(faults) => {
                let faults: Vec<String> = faults.iter().map(Fault::to_string).collect();
                write!(f, "the plan does not fit together: {}", faults.join("; "))
            }
            RunError::Node { clock, cause } => write!(f, "after {clock}: {cause}"),
            RunError::ForeignCheckpoint => f.write_str("the checkpoint is of another schedule"),
            RunError::NoSchedule { kind } => write!(f, "no schedule `{kind}` is known to this program"),
        }
    }
}

impl std::error::Error for RunError {}

/// What a schedule of another program does: it advances the nodes of the graph and tells what happens.
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

/// A graph with the means to build its nodes.
pub struct Machine<'a> {
    pub graph: &'a Graph,
    pub(super) executor: &'a Executor,
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

    /// Runs a graph, from its beginning or from a checkpoint. May be called from several threads at once; what does not need each
    /// other runs in the thread pool of the caller, and the result does not depend on the number of its threads.
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
        let machine = Machine { graph, executor: self };
        match &graph.schedule {
            Schedule::Static { loads } => equilibrium::run(&machine, loads, listener),
            Schedule::Blocks(plan) => blocks::run(&machine, plan, listener, from),
            Schedule::Actuators(tests) => tests_of_beds::run(&machine, tests, listener, from),
            Schedule::Custom { kind, parameters } => {
                let schedule = self.schedules.get(kind).ok_or_else(|| RunError::NoSchedule { kind: kind.clone() })?;
                let from = match from.map(|checkpoint| checkpoint.state) {
                    None => None,
                    Some(super::ScheduleState::Custom(state)) => Some(state),
                    Some(_) => return Err(RunError::ForeignCheckpoint),
                };
                schedule(&machine, parameters, listener, from)
            }
        }
    }
}

impl<'a> Machine<'a> {
    pub(super) fn beds(&self) -> &Beds {
        &self.executor.beds
    }

    /// The track of the graph, its name first; `None` where there is none.
    fn track_node(&self) -> Option<(&'a str, &'a TrackNode)> {
        self.graph.nodes.iter().find_map(|node| match &node.model {
            crate::graph::Model::Track(track) => Some((node.name.as_str(), &**track)),
            _ => None,
        })
    }

    /// The node from which an edge brings settlement to the track.
    fn ground_node(&self, track: &str) -> Option<&'a Node> {
        let edge = self.graph.edges.iter().find(|edge| edge.to == track && edge.quantity == SETTLEMENT.name)?;
        self.graph.node(&edge.from)
    }

    /// The track and the ground that an edge joins to it, standing on each other.
    pub fn track_on_ground(&self) -> Result<(TrackSystem<'a>, Box<dyn Substructure + 'a>), NodeError> {
        let none = |kind: &str| NodeError::NoBuilder { node: kind.to_owned(), kind: kind.to_owned() };
        let (name, node) = self.track_node().ok_or_else(|| none("track"))?;
        let ground = self.ground_node(name).ok_or_else(|| none("ground"))?;
        let ground = self.executor.builders.substructure(ground)?;
        let mut track = TrackSystem::new(node, self.graph.blocks(), &self.graph.records);
        track.stand_on(ground.responses())?;
        Ok((track, ground))
    }
}
