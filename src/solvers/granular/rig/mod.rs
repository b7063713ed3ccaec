//! Test rigs: sleepers that are set down on a packed bed and loaded by actuators.
//!
//! A sleeper is a block that moves up and down under its own mass, weight, the force of its actuator and the forces of the grains
//! below; it does not tilt. Nothing lies beside it: the space between sleepers is empty. It is set down where it touches the first
//! grain and comes to rest under its own weight, by the forces that are out of balance; from there settlement counts, downwards.
//!
//! A cycle goes from the lower force to the upper one and back. What is read of it: the settlement at its end, the resilient
//! stiffness, range of force / rebound from the deepest place to the end, and the work that the bed keeps.
//!
//! A plate over the whole bed may be driven down instead of loaded, and the sides of a bed that is a box may give way under a
//! pressure: see [`Specimen`]. Forces on the plate are then on top of that pressure.

mod error;
mod sensor;
mod set_down;
mod specimen;
mod store;
#[cfg(test)]
mod tests;
mod trial;

pub use error::RigError;
pub use sensor::{Reading, Sensor};
pub use specimen::{Specimen, State as SpecimenState};
pub use store::Stored;
pub use trial::Trial;

use serde::{Deserialize, Serialize};

/// What stands on a bed, what acts on it and what is kept of the answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    pub sleepers: Vec<Sleeper>,
    /// Sides that give way under a pressure; the one sleeper is then a plate over all of the bed.
    pub specimen: Option<Specimen>,
    /// Of a cycle, s; of a history its length.
    pub period: f64,
    pub cycles: u64,
    pub gravity: f64,
    /// Of the grains of each surface, kg/m3.
    pub densities: Vec<f64>,
    /// Cycles of which loops of force and depth and what sensors read are kept, the first is 1.
    pub kept: Vec<u64>,
    pub sensors: Vec<Sensor>,
    /// Share of the mass of the bed that may be added as inertia for the sake of a longer step; [`ADDED`] unless somebody asks what
    /// it changes.
    pub added: f64,
}

/// Of the mass of a bed, added as inertia while it is loaded.
pub const ADDED: f64 = 0.005;

/// A block on the bed, in the bed's own axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sleeper {
    /// Of its middle, along and across, m.
    pub place: [f64; 2],
    /// Along, across, height, m.
    pub size: [f64; 3],
    /// That the bed under it carries, kg.
    pub mass: f64,
    pub load: Load,
}

/// Force of an actuator, N, positive down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Load {
    None,
    Constant(f64),
    /// Between two forces, a while later than the first actuator, s.
    Cyclic {
        range: [f64; 2],
        delay: f64,
    },
    /// Time, s, and force, straight in between.
    History(Vec<[f64; 2]>),
    /// No force: it is driven down in one cycle, by this share of the height of the bed.
    Strain(f64),
}

/// A sleeper over one of its cycles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Index into [`Rig::sleepers`].
    pub sleeper: usize,
    /// The first is 1.
    pub number: u64,
    /// Below the place of rest under its own weight: at the end of the cycle, and where it was deepest, m.
    pub settlement: f64,
    pub deepest: f64,
    /// Range of force over the rebound from the deepest place to the end, N/m; 0 where nothing rebounds.
    pub stiffness: f64,
    /// Largest force of the bed on the sleeper, N.
    pub contact_force: f64,
    /// Of the actuator less what came back: the bed keeps it, J.
    pub work: f64,
    /// Time steps so far.
    pub steps: u64,
}

/// A sleeper at an instant of a cycle that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub sleeper: usize,
    pub cycle: u64,
    /// Share of the cycle that is over, 0 .. 1.
    pub phase: f64,
    /// Of the actuator, and of the bed on the sleeper, N.
    pub force: f64,
    pub contact_force: f64,
    /// m.
    pub depth: f64,
    /// Downwards, m/s.
    pub velocity: f64,
}

impl Load {
    /// From the least to the greatest force, N.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Load::None | Load::Strain(_) => [0.0; 2],
            Load::Constant(force) => [0.0, *force],
            Load::Cyclic { range, .. } => *range,
            Load::History(points) => points
                .iter()
                .map(|point| point[1])
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], force| [low.min(force), high.max(force)]),
        }
    }
}
