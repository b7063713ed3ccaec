//! The state of a soil as data, and back, bit by bit.

use super::energy::Ledger;
use super::error::SoilError;
use super::soil::{Clock, Soil};
use serde::{Deserialize, Serialize};

/// Everything that changes while a soil moves. Mesh, materials, settings and supports are not in it: it is restored into a soil
/// that was made in the same way. Serialise it with a format that keeps every bit of a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    clock: Clock,
    displacement: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    external: Vec<[f64; 3]>,
    borne: Vec<[f64; 3]>,
    ledger: Ledger,
}

impl Soil {
    /// The state as data. A soil restored from it goes on bit by bit as this one does.
    pub fn state(&self) -> State {
        State {
            clock: self.clock,
            displacement: self.nodes.displacement.clone(),
            velocity: self.nodes.velocity.clone(),
            external: self.nodes.external.clone(),
            borne: self.nodes.borne.clone(),
            ledger: self.ledger,
        }
    }

    /// Takes up a state.
    ///
    /// # Errors
    /// It is of another soil; this one is left as it was then.
    pub fn restore(&mut self, state: State) -> Result<(), SoilError> {
        let State { clock, displacement, velocity, external, borne, ledger } = state;
        let expected = self.nodes.mass.len();
        for nodes in [&displacement, &velocity, &external, &borne] {
            if nodes.len() != expected {
                return Err(SoilError::OtherSoil { what: "nodes", expected, found: nodes.len() });
            }
        }
        for ((x, made), u) in self.nodes.position.iter_mut().zip(self.mesh.nodes()).zip(&displacement) {
            *x = [0, 1, 2].map(|axis| made[axis] + u[axis]);
        }
        let nodes = &mut self.nodes;
        (nodes.displacement, nodes.velocity, nodes.external, nodes.borne) = (displacement, velocity, external, borne);
        (self.clock, self.ledger) = (clock, ledger);
        Ok(())
    }
}
