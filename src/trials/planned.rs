//! The passages in the plan of a scene: the track on its supports and the trains that run over it.

use crate::graph::{Blocks, Graph, Responses, TrackNode};
use crate::lower::Origins;

/// A planned scene with traffic, as trials vary it.
#[derive(Debug, Clone)]
pub struct Planned {
    pub graph: Graph,
    pub origins: Origins,
    pub node: TrackNode,
    /// Responses of the supports at the start of the scene: stiffness, damping and seating.
    pub responses: Responses,
    pub blocks: Blocks,
}

impl Planned {
    /// The passages of a plan; `None` if no train runs over a track.
    pub fn new(graph: &Graph, origins: &Origins) -> Option<Planned> {
        let (node, blocks) = (graph.track()?.clone(), graph.blocks()?.clone());
        let seats = graph.supports.iter().map(|support| support.spring).collect();
        let responses = Responses { revision: 0, seats };
        Some(Planned { graph: graph.clone(), origins: origins.clone(), node, responses, blocks })
    }

    /// Settlement of every seat as the scene starts, m.
    pub fn initial_settlement(&self) -> Vec<f64> {
        self.graph.supports.iter().map(|support| support.settlement).collect()
    }
}
