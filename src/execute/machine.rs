//! A graph with the builders of its nodes, and the end or failure of its run.

use crate::graph::quantity::SETTLEMENT;
use crate::graph::{Blocks, Clock, Fault, Graph, Model, Node, TrackNode};
use crate::nodes::{
    Builders, CellGround, CellParts, CheckingCells, GrainGround, GrainParts, NodeError, Substructure, Superstructure,
    TrackSystem,
};
use crate::store::Beds;
use std::fmt;
use std::ops::ControlFlow;

/// End of a run without failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The schedule is done.
    Finished,
    /// A listener ended it.
    Stopped,
}

/// Failure of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    /// The nodes and edges of the graph are not consistent.
    Faults(Vec<Fault>),
    /// A node failed.
    Node { clock: Clock, cause: Box<NodeError> },
    /// A checkpoint of another schedule.
    ForeignCheckpoint,
    /// A schedule of another program, which this program cannot run.
    NoSchedule { kind: String },
}

impl RunError {
    /// The failure of a node, and the progress of the schedule.
    pub fn node(clock: Clock, cause: NodeError) -> RunError {
        RunError::Node { clock, cause: Box::new(cause) }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::Faults(faults) => {
                let faults: Vec<String> = faults.iter().map(Fault::to_string).collect();
                write!(f, "the plan is not consistent: {}", faults.join("; "))
            }
            RunError::Node { clock, cause } => write!(f, "after {clock}: {cause}"),
            RunError::ForeignCheckpoint => f.write_str("the checkpoint belongs to another schedule"),
            RunError::NoSchedule { kind } => write!(f, "no schedule `{kind}` is known to this program"),
        }
    }
}

impl std::error::Error for RunError {}

/// A graph with the builders of its nodes.
pub struct Machine<'a> {
    pub graph: &'a Graph,
    pub(super) builders: &'a Builders,
    pub(super) beds: &'a Beds,
}

impl<'a> Machine<'a> {
    /// The track of the graph, its name first; `None` if there is none.
    fn track_node(&self) -> Option<(&'a str, &'a TrackNode)> {
        self.graph.nodes.iter().find_map(|node| match &node.model {
            Model::Track(track) | Model::Riding(track) => Some((node.name.as_str(), &**track)),
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
        self.standing(self.graph.blocks(), |ground| ground.prepare(&mut |_, _| ControlFlow::Continue(())))
    }

    /// The same, where `begin` prepares the ground or restores it.
    pub(super) fn track_on_ground_that(
        &self,
        begin: impl FnOnce(&mut dyn Substructure) -> Result<(), NodeError>,
    ) -> Result<(TrackSystem<'a>, Box<dyn Substructure + 'a>), NodeError> {
        self.standing(self.graph.blocks(), begin)
    }

    /// The same without the time steps of trains, which take most of the time to make it.
    pub(super) fn track_without_trains(&self) -> Result<(TrackSystem<'a>, Box<dyn Substructure + 'a>), NodeError> {
        self.standing(None, |ground| ground.prepare(&mut |_, _| ControlFlow::Continue(())))
    }

    fn standing(
        &self,
        blocks: Option<&'a Blocks>,
        begin: impl FnOnce(&mut dyn Substructure) -> Result<(), NodeError>,
    ) -> Result<(TrackSystem<'a>, Box<dyn Substructure + 'a>), NodeError> {
        let none = |kind: &str| NodeError::NoBuilder { node: kind.to_owned(), kind: kind.to_owned() };
        let (name, node) = self.track_node().ok_or_else(|| none("track"))?;
        let ground = self.ground_node(name).ok_or_else(|| none("ground"))?;
        let mut ground: Box<dyn Substructure> = match (&ground.model, self.grain_parts()) {
            (Model::Grains(_), Some(parts)) => Box::new(GrainGround::new(parts)),
            (Model::Cells(cells), _) => Box::new(CellGround::new(CellParts { cells, beds: self.beds })),
            _ => self.builders.substructure(ground)?,
        };
        begin(&mut *ground)?;
        let mut track = TrackSystem::new(node, blocks, &self.graph.records);
        track.stand_on(ground.responses())?;
        Ok((track, ground))
    }

    /// The cells that check the settlement of the graph; `None` if none do.
    pub(super) fn checking_cells(&self) -> Option<CheckingCells<'a>> {
        self.graph.check().map(|cells| CheckingCells::new(CellParts { cells, beds: self.beds }))
    }

    /// Grains under the track of the graph, with the soil below them; `None` if there are none.
    pub(super) fn grain_parts(&self) -> Option<GrainParts<'a>> {
        let nodes = || self.graph.nodes.iter().map(|node| &node.model);
        let grains = nodes().find_map(|model| if let Model::Grains(grains) = model { Some(grains) } else { None })?;
        let soil = nodes().find_map(|model| if let Model::Soil(soil) = model { Some(soil) } else { None });
        let (_, track) = self.track_node()?;
        Some(GrainParts { grains, soil, track, beds: self.beds })
    }
}
