//! The solver graph as data: nodes that own state, the ports through which they exchange quantities, the edges between
//! them, and the schedule that advances them (Fig. 3 of the paper).
//!
//! `lower` makes the graph of a scene, `trackbed plan` prints it, and `execute` runs it. A graph has SI numbers for one
//! rail and does not depend on the language; `lower` has the places of its numbers in the scene.

mod blocks;
mod cells;
mod control;
mod decision;
mod grains;
mod ground;
mod listing;
mod node;
mod passing;
mod port;
pub mod quantity;
mod record;
mod schedule;
mod track;
mod train;

pub use blocks::Due;
pub use cells::{CellPlan, CellsNode, SeatOnCell, seats_alike};
pub use control::{Control, UNEVEN};
pub use decision::{Cost, Decision, ExpectedError, PassageWork, Rejected, TestWork, Work};
pub use grains::{
    ActuatorsNode, BedError, BedNode, BedPlan, BedRecipe, GrainStretch, GrainsNode, SensorNode, SensorVolume,
    SleeperOnGrains, SoilBlock, SoilLayer, SoilNode, StandingBody, StiffnessFrom, VolumeUnderTrack,
};
pub use ground::{LawBounds, LawNode, NamedLaw, OwnLaw, SpringsNode, SupportNode};
pub use listing::Listing;
pub use node::{CustomNode, Model, Node};
pub use passing::{BlockWeight, Passing};
pub use port::{Edge, Fault, Ports, faults};
pub use quantity::{Basis, Quantity, Rate};
pub use record::{History, InVolume, Record};
pub use schedule::{
    AdaptiveSteps, Block, Blocks, Clock, Compared, LoadedPart, PassagePlan, PointLoad, Runner, Schedule, Tamping,
    Tests, Update,
};
pub use track::{Responses, TrackFoot, TrackNode, TrackSeat, TrackSection};
pub use train::{Bogie, Runs, Train};

use serde::{Deserialize, Serialize};

/// A lowered scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    pub nodes: Vec<Node>,
    pub edges: Vec<Edge>,
    pub schedule: Schedule,
    pub records: Vec<Record>,
    /// The support under each seat of a track from the scene and its layers, independent of the node that carries it;
    /// empty in a rig.
    pub supports: Vec<SupportNode>,
    /// Decisions of the passes, with their reasons.
    pub decisions: Vec<Decision>,
    pub cost: Cost,
    pub error: ExpectedError,
    /// Whether this version has every node of the graph; otherwise the graph is shown but not run.
    pub runs: bool,
}

impl Graph {
    /// The node with a name.
    pub fn node(&self, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name == name)
    }

    /// The track; `None` in a rig without rails.
    pub fn track(&self) -> Option<&TrackNode> {
        self.nodes.iter().find_map(|node| match &node.model {
            Model::Track(track) | Model::Riding(track) => Some(&**track),
            _ => None,
        })
    }

    /// The passing of trains over the grains under a track; `None` if there are no grains.
    pub fn passing(&self) -> Option<Passing> {
        self.nodes
            .iter()
            .find_map(|node| if let Model::Grains(grains) = &node.model { Passing::over(grains) } else { None })
    }

    /// Weight of a block in the progress of a run over grains; `None` if no grains lie under a track.
    pub fn block_weight(&self) -> Option<BlockWeight> {
        let cells = || self.nodes.iter().any(|node| matches!(node.model, Model::Cells(_)));
        self.passing().map(BlockWeight::Time).or_else(|| cells().then_some(BlockWeight::Equal))
    }

    /// Whether grains lie under the track: over its whole length, in part or in cells.
    pub fn has_grains_under_track(&self) -> bool {
        self.nodes.iter().any(|node| matches!(node.model, Model::Grains(_) | Model::Cells(_)))
    }

    /// Whether any grains are glued.
    pub fn has_bonds(&self) -> bool {
        self.nodes.iter().any(|node| match &node.model {
            Model::Bed(bed) => !bed.glued.is_empty(),
            Model::Grains(grains) => grains.stretches.iter().any(|stretch| !stretch.glued.is_empty()),
            Model::Cells(cells) => cells.cells.iter().any(|cell| !cell.glued.is_empty()),
            _ => false,
        })
    }

    /// Volumes of grains under the track in which passages are recorded; empty without grains.
    pub fn volumes(&self) -> &[VolumeUnderTrack] {
        let grains = |node: &Node| matches!(node.model, Model::Grains(_));
        match self.nodes.iter().find(|node| grains(node)).map(|node| &node.model) {
            Some(Model::Grains(grains)) => &grains.volumes,
            _ => &[],
        }
    }

    /// Whether vehicles, rail and grains are computed together, without an exchange between blocks.
    pub fn is_ridden(&self) -> bool {
        self.nodes.iter().any(|node| matches!(node.model, Model::Riding(_)))
    }

    /// The settlement laws of the supports, the driving law first.
    pub fn laws(&self) -> impl Iterator<Item = &NamedLaw> {
        let law = self.nodes.iter().find_map(|node| if let Model::Law(law) = &node.model { Some(law) } else { None });
        law.into_iter().flat_map(|node| std::iter::once(&node.law).chain(&node.followers))
    }

    /// The cells of grains that check a settlement law; `None` if none do.
    pub fn check(&self) -> Option<&CellsNode> {
        self.nodes.iter().find_map(|node| if let Model::Check(cells) = &node.model { Some(cells) } else { None })
    }

    /// Every bed of grains.
    pub fn beds(&self) -> impl Iterator<Item = &BedPlan> {
        self.nodes.iter().flat_map(|node| match &node.model {
            Model::Bed(bed) => std::slice::from_ref(&bed.bed),
            Model::Grains(grains) => grains.beds.as_slice(),
            Model::Cells(cells) | Model::Check(cells) => cells.beds.as_slice(),
            _ => &[],
        })
    }

    /// A bed under actuators, with the actuators.
    pub fn bed_under_actuators(&self) -> Option<(&BedNode, &ActuatorsNode)> {
        let bed =
            self.nodes.iter().find_map(|node| if let Model::Bed(bed) = &node.model { Some(&**bed) } else { None });
        let loads = self
            .nodes
            .iter()
            .find_map(|node| if let Model::Actuators(loads) = &node.model { Some(loads) } else { None });
        bed.zip(loads)
    }

    /// The same graph with the test of one packing only, by its place among all packings.
    #[must_use]
    pub fn with_one_packing(mut self, place: u32) -> Graph {
        if let Schedule::Actuators(tests) = &mut self.schedule {
            (tests.first, tests.packings, tests.least) = (tests.first + place, 1, 1);
        }
        self
    }

    /// Number of packings that are computed independently of each other: tests of beds.
    pub fn tested_packings(&self) -> Option<u32> {
        if let Schedule::Actuators(tests) = &self.schedule { Some(tests.packings.max(1)) } else { None }
    }

    /// The loop over axles; `None` if no train runs.
    pub fn blocks(&self) -> Option<&Blocks> {
        if let Schedule::Blocks(blocks) = &self.schedule { Some(blocks) } else { None }
    }
}
