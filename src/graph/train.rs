//! Trains as data: vehicles in their order, how fast they run and which way.

use crate::solvers::track::{self, Direction, Motion, Vehicle};
use serde::{Deserialize, Serialize};

/// Vehicles that run together, over one rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Train {
    pub name: String,
    /// In the order of the train, the leading one first, each with the distance of its first wheel behind that of the train, m.
    pub vehicles: Vec<(Vehicle, f64)>,
    /// The largest speed, m/s.
    pub speed: f64,
    pub motion: Motion,
    pub runs: Runs,
}

/// Which way the trains of a kind run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Runs {
    /// The train runs towards larger x.
    Forward,
    Backward,
    /// Every second train the other way, the first one forward.
    BothWays,
}

/// Axles of a vehicle.
const AXLES: u64 = 4;

impl Train {
    pub fn axles(&self) -> u64 {
        AXLES * self.vehicles.len() as u64
    }

    /// Mass over one rail, kg.
    pub fn mass(&self) -> f64 {
        self.vehicles.iter().map(|(vehicle, _)| vehicle.mass()).sum()
    }

    /// Mass that a wheel carries on average, kg.
    pub fn mean_wheel_mass(&self) -> f64 {
        self.mass() / self.axles() as f64
    }

    /// Static force of every wheel, N, the leading one first: those of a vehicle carry alike.
    pub fn static_wheel_loads(&self, gravity: f64) -> impl Iterator<Item = f64> + '_ {
        let load = move |vehicle: &Vehicle| vehicle.mass() * gravity / AXLES as f64;
        self.vehicles.iter().flat_map(move |(vehicle, _)| std::iter::repeat_n(load(vehicle), AXLES as usize))
    }

    /// Distance from the first to the last wheel, m.
    pub fn wheel_base(&self) -> f64 {
        self.vehicles.last().map_or(0.0, |(vehicle, offset)| offset + vehicle.wheel_offsets()[3])
    }

    /// The direction of the passage that shows a state of the track.
    pub fn leading_direction(&self) -> Direction {
        if self.runs == Runs::Backward { Direction::Backward } else { Direction::Forward }
    }

    /// The train of the solver, in a direction.
    pub fn model(&self, direction: Direction) -> track::Train {
        track::Train { vehicles: self.vehicles.iter().map(|(v, offset)| ((*v).into(), *offset)).collect(), direction }
    }
}
