//! Trains as data: vehicles in their order, speed and direction.

use crate::solvers::track::{self, Direction, Motion, Vehicle};
use serde::{Deserialize, Serialize};

/// Vehicles that run coupled, for one rail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Train {
    pub name: String,
    /// In the order of the train, the leading vehicle first, each with the distance from the first wheel of the train
    /// to its first wheel, m.
    pub vehicles: Vec<(Vehicle, f64)>,
    /// The largest speed, m/s.
    pub speed: f64,
    pub motion: Motion,
    pub runs: Runs,
}

/// Direction of the trains of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Runs {
    /// The train runs towards larger x.
    Forward,
    Backward,
    /// The direction alternates; the first train runs forward.
    BothWays,
}

/// Two wheels of a bogie at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Bogie {
    /// Force of a wheel, N, and distance of the two wheels, m.
    pub wheels: [f64; 2],
    /// The wheels of the train that have this bogie, the leading wheel 0.
    pub wheels_of_train: Vec<usize>,
}

/// Axles of a vehicle.
const AXLES: u64 = 4;

impl Train {
    pub fn axles(&self) -> u64 {
        AXLES * self.vehicles.len() as u64
    }

    /// Mass for one rail, kg.
    pub fn mass(&self) -> f64 {
        self.vehicles.iter().map(|(vehicle, _)| vehicle.mass()).sum()
    }

    /// Mean mass per wheel, kg.
    pub fn mean_wheel_mass(&self) -> f64 {
        self.mass() / self.axles() as f64
    }

    /// Static force of every wheel, N, the leading wheel first; the wheels of a vehicle have equal forces.
    pub fn static_wheel_loads(&self, gravity: f64) -> impl Iterator<Item = f64> + '_ {
        let load = move |vehicle: &Vehicle| vehicle.mass() * gravity / AXLES as f64;
        self.vehicles.iter().flat_map(move |(vehicle, _)| std::iter::repeat_n(load(vehicle), AXLES as usize))
    }

    /// The different bogies of the train; all bogies of equal wheels are one.
    pub fn bogies(&self, gravity: f64) -> Vec<Bogie> {
        let mut bogies: Vec<Bogie> = Vec::new();
        for (number, (vehicle, _)) in self.vehicles.iter().enumerate() {
            let wheels = [vehicle.mass() / AXLES as f64 * gravity, vehicle.wheelset_spacing];
            let first = number * AXLES as usize;
            let of_vehicle = first..first + AXLES as usize;
            match bogies.iter_mut().find(|bogie| bogie.wheels == wheels) {
                Some(bogie) => bogie.wheels_of_train.extend(of_vehicle),
                None => bogies.push(Bogie { wheels, wheels_of_train: of_vehicle.collect() }),
            }
        }
        bogies
    }

    /// Distance from the first to the last wheel, m.
    pub fn wheel_base(&self) -> f64 {
        self.vehicles.last().map_or(0.0, |(vehicle, offset)| offset + vehicle.wheel_offsets()[3])
    }

    /// The direction of the passage that is recorded for a state of the track.
    pub fn leading_direction(&self) -> Direction {
        if self.runs == Runs::Backward { Direction::Backward } else { Direction::Forward }
    }

    /// The train for the solver, in a direction.
    pub fn model(&self, direction: Direction) -> track::Train {
        track::Train { vehicles: self.vehicles.iter().map(|(v, offset)| ((*v).into(), *offset)).collect(), direction }
    }
}
