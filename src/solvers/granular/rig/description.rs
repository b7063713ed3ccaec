//! What a test is: the sleepers, what acts on them and what is kept.

use super::filling::Filling;
use super::glued::Glued;
use super::sensor::Sensor;
use super::specimen::Specimen;
use serde::{Deserialize, Serialize};

/// What stands on a bed, what acts on it and what is kept of the answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    pub sleepers: Vec<Sleeper>,
    /// Sides that give way under a pressure; the one sleeper is then a plate over all of the bed.
    pub specimen: Option<Specimen>,
    /// Grains between and beside the sleepers; `None` leaves that space empty.
    pub filling: Option<Filling>,
    /// Glued once all of it is at rest.
    pub glued: Vec<Glued>,
    /// Time of a cycle, s; of a history its length.
    pub period: f64,
    pub cycles: u64,
    pub gravity: f64,
    /// Density of the grains of each surface, kg/m3.
    pub densities: Vec<f64>,
    /// Cycles of which loops of force and depth and what sensors read are kept, the first is 1.
    pub kept: Vec<u64>,
    pub sensors: Vec<Sensor>,
    /// Share of the mass of the bed that may be added as inertia for the sake of a longer step; [`ADDED`] unless somebody asks what
    /// it changes.
    pub added: f64,
}

/// Share of the mass of a bed that is added as inertia while it is loaded.
pub const ADDED: f64 = 0.005;

/// A block on the bed, in the bed's own axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Sleeper {
    /// Place of its middle, along and across, m.
    pub place: [f64; 2],
    /// Along, across, height, m.
    pub size: [f64; 3],
    /// Mass that the bed under it carries, kg.
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
