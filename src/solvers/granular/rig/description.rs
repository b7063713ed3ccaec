//! The description of a test: the sleepers, their loads and the recorded results.

use super::filling::Filling;
use super::glued::Glued;
use super::sensor::Sensor;
use super::specimen::Specimen;
use serde::{Deserialize, Serialize};

/// The sleepers on a bed, their loads and the recorded results.
#[derive(Debug, Clone, PartialEq)]
pub struct Rig {
    pub sleepers: Vec<Sleeper>,
    /// Sides that move under a pressure; the single sleeper is then a plate over the whole bed.
    pub specimen: Option<Specimen>,
    /// Grains between and beside the sleepers; with `None` this space is empty.
    pub filling: Option<Filling>,
    /// Parts that are glued after the whole bed is at rest.
    pub glued: Vec<Glued>,
    /// Duration of a cycle, s; for a history, its length.
    pub period: f64,
    pub cycles: u64,
    pub gravity: f64,
    /// Density of the grains of each surface, kg/m3.
    pub densities: Vec<f64>,
    /// Cycles with recorded loops of force and depth and recorded sensor readings, counted from 1.
    pub kept: Vec<u64>,
    pub sensors: Vec<Sensor>,
    /// Limit of the additional inertia for a longer time step, as a share of the mass of the bed; [`ADDED`] except in
    /// studies of its effect.
    pub added: f64,
}

/// Share of the mass of a bed that is added as inertia during loading.
pub const ADDED: f64 = 0.005;

/// A block on the bed, in the axes of the bed.
#[derive(Debug, Clone, PartialEq)]
pub struct Sleeper {
    /// Position of its middle, along and across, m.
    pub place: [f64; 2],
    /// Along, across, height, m.
    pub size: [f64; 3],
    /// Mass of the sleeper carried by this bed, kg.
    pub mass: f64,
    pub load: Load,
}

/// Force of an actuator, N, positive down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Load {
    None,
    Constant(f64),
    /// Between two forces; `delay` is the time after the start of the first actuator, s.
    Cyclic {
        range: [f64; 2],
        delay: f64,
    },
    /// Time, s, and force, linear in between.
    History(Vec<[f64; 2]>),
    /// No force: the sleeper is driven down in one cycle, by this share of the height of the bed.
    Strain(f64),
}

impl Load {
    /// Smallest and largest force, N.
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
