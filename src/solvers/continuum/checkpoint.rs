//! The state of a soil as data, and back, bit by bit.

use super::chunk::Chunk;
use super::energy::Ledger;
use super::error::SoilError;
use super::flow::Memory;
use super::soil::{Clock, Soil};
use serde::{Deserialize, Serialize};

/// All data that change while a soil moves. Mesh, materials, settings and supports are not included: the state is
/// restored into a soil that was built in the same way. Serialise it with a format that keeps every bit of a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    clock: Clock,
    displacement: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    external: Vec<[f64; 3]>,
    borne: Vec<[f64; 3]>,
    memories: Vec<Memory>,
    ledger: Ledger,
}

impl Soil {
    /// The state as data. A soil restored from it continues bit by bit like this soil.
    pub fn state(&self) -> State {
        State {
            clock: self.clock,
            displacement: self.nodes.displacement.clone(),
            velocity: self.nodes.velocity.clone(),
            external: self.nodes.externals().to_vec(),
            borne: self.nodes.borne.clone(),
            memories: self.chunks.iter().flat_map(Chunk::memories).cloned().collect(),
            ledger: self.ledger,
        }
    }

    /// Restores a state.
    ///
    /// # Errors
    /// The state belongs to another soil; this soil is then unchanged.
    pub fn restore(&mut self, state: State) -> Result<(), SoilError> {
        let State { clock, displacement, velocity, external, borne, memories, ledger } = state;
        let expected = self.nodes.mass.len();
        for nodes in [&displacement, &velocity, &external] {
            if nodes.len() != expected {
                return Err(SoilError::OtherSoil { what: "nodes", expected, found: nodes.len() });
            }
        }
        let (expected, found) = (self.nodes.borne.len(), borne.len());
        if expected != found {
            return Err(SoilError::OtherSoil { what: "nodes of quiet faces", expected, found });
        }
        let own = self.chunks.iter().flat_map(Chunk::memories).map(|memory| memory.points.len());
        let (expected, found) = (own.sum(), memories.iter().map(|memory| memory.points.len()).sum());
        if expected != found || memories.len() != self.chunks.iter().flat_map(Chunk::memories).count() {
            return Err(SoilError::OtherSoil { what: "points that can yield", expected, found });
        }
        for (own, memory) in self.chunks.iter_mut().flat_map(Chunk::memories_mut).zip(memories) {
            *own = memory;
        }
        let nodes = &mut self.nodes;
        (nodes.displacement, nodes.velocity, nodes.borne) = (displacement, velocity, borne);
        nodes.clear_forces();
        external
            .iter()
            .enumerate()
            .filter(|(_, force)| **force != [0.0; 3])
            .for_each(|(node, &force)| nodes.add_force(node, force));
        (self.clock, self.ledger) = (clock, ledger);
        Ok(())
    }
}
