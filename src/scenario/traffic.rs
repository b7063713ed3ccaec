//! Loads on the track: vehicles, trains and test loads.

use super::{Given, Order, Profile, Sequence, Share};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// A vehicle with two bogies of two axles each, for **one rail**: half of every mass, inertia and stiffness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Vehicle {
    pub name: String,
    /// kg.
    pub car_body_mass: Given,
    /// kg m^2.
    pub car_body_pitch_inertia: Given,
    /// Mass of each bogie, kg.
    pub bogie_mass: Given,
    /// Pitch inertia of each bogie, kg m^2.
    pub bogie_pitch_inertia: Given,
    /// Distance between the bogie centres, m.
    pub bogie_spacing: Given,
    /// Mass of each wheel with half the axle, kg.
    pub wheel_mass: Given,
    /// Distance between the axles of a bogie, m.
    pub wheelset_spacing: Given,
    /// m, for the drawing.
    pub wheel_radius: f64,
    /// Stiffness (N/m) and damping (N s/m) for each wheel.
    pub primary_stiffness: Given,
    pub primary_damping: Given,
    /// Stiffness (N/m) and damping (N s/m) for each bogie.
    pub secondary_stiffness: Given,
    pub secondary_damping: Given,
    /// Hertz constant of wheel on rail, N/m^1.5.
    pub hertz: Given,
    /// Length over couplers, m; given if a train needs it.
    pub length: Option<Given>,
}

impl Vehicle {
    /// Number of axles.
    pub const AXLES: u64 = 4;

    /// Mass for one rail, kg.
    pub fn mass(&self) -> f64 {
        *self.car_body_mass + 2.0 * *self.bogie_mass + 4.0 * *self.wheel_mass
    }

    /// Distances of the four wheels behind the leading one, m.
    pub fn wheel_offsets(&self) -> [f64; 4] {
        let (bogies, wheels) = (*self.bogie_spacing, *self.wheelset_spacing);
        [0.0, wheels, bogies, bogies + wheels]
    }
}

/// Coupled vehicles with one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Train {
    pub name: String,
    /// Vehicles in the order of the train, the leading vehicle first.
    pub vehicles: Vec<Vehicle>,
    /// Speed, m/s; the largest value if it varies.
    pub speed: Given,
    /// Speed by the chainage of the leading wheel, m/s, over the whole track; `None` if it is `speed` everywhere.
    pub speed_profile: Option<Profile>,
    pub direction: Direction,
}

impl Train {
    pub fn axles(&self) -> u64 {
        Vehicle::AXLES * self.vehicles.len() as u64
    }

    /// Mass on both rails, kg.
    pub fn mass(&self) -> f64 {
        self.vehicles.iter().map(|vehicle| 2.0 * vehicle.mass()).sum()
    }

    /// Mean mass per wheel, kg.
    pub fn mean_wheel_mass(&self) -> f64 {
        self.vehicles.iter().map(Vehicle::mass).sum::<f64>() / self.axles() as f64
    }

    /// Distance from the leading wheel of the train to the leading wheel of each vehicle, m. Vehicles are centred
    /// between their couplers.
    pub fn vehicle_offsets(&self) -> Vec<f64> {
        let mut offsets = Vec::with_capacity(self.vehicles.len());
        let mut front = 0.0; // distance from the front coupler of the train to that of the vehicle
        for vehicle in &self.vehicles {
            let wheels = vehicle.wheel_offsets()[3];
            let length = vehicle.length.map_or(wheels, |l| *l);
            offsets.push(front + (length - wheels) / 2.0);
            front += length;
        }
        let first = offsets.first().copied().unwrap_or(0.0);
        offsets.iter().map(|o| o - first).collect()
    }

    /// Distance from the first to the last wheel, m.
    pub fn wheel_base(&self) -> f64 {
        match (self.vehicle_offsets().last(), self.vehicles.last()) {
            (Some(offset), Some(vehicle)) => offset + vehicle.wheel_offsets()[3],
            _ => 0.0,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// The train runs towards larger x.
    Forward,
    Backward,
    /// The direction alternates from train to train.
    Both,
}

/// The trains of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Traffic {
    /// The train that the scene names first. Results for a single train are for this train.
    pub train: Train,
    /// Trains of other kinds.
    pub others: Vec<Train>,
    /// Number of trains of each kind, in the order of the scene; for a single kind it follows from `total`.
    pub counts: Vec<u64>,
    pub order: Order,
    /// Axles of the whole run.
    pub total: Given<u64>,
}

impl Traffic {
    /// Every kind of train, in the order of the scene.
    pub fn trains(&self) -> impl Iterator<Item = &Train> {
        std::iter::once(&self.train).chain(&self.others)
    }

    /// Speed of the fastest train, m/s, which determines the limits of the track level.
    pub fn line_speed(&self) -> f64 {
        self.trains().map(|train| *train.speed).fold(0.0, f64::max)
    }

    /// Whether trains of several kinds run.
    pub fn is_mixed(&self) -> bool {
        !self.others.is_empty()
    }

    /// The order of the trains.
    pub fn sequence(&self) -> Sequence {
        let alone = [*self.total / self.train.axles()];
        let counts = if self.is_mixed() { self.counts.as_slice() } else { alone.as_slice() };
        let share =
            |(train, trains): (&Train, &u64)| Share { trains: *trains, axles: train.axles(), mass: train.mass() };
        Sequence { order: self.order, shares: self.trains().zip(counts).map(share).collect() }
    }
}

/// A constant force on a track at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StaticLoad {
    pub name: String,
    /// Place of the load in the text.
    pub span: Span,
    pub on: Target,
    /// Chainage, m.
    pub x: f64,
    /// Force for one rail, N, positive downwards.
    pub force: Given,
}

/// A force on a sleeper or the rail that changes or moves: a load of a test rig, or a load that needs grains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RigLoad {
    pub name: String,
    /// Place of the load in the text.
    pub span: Span,
    pub on: Target,
    /// Chainage at the start, m.
    pub x: f64,
    pub force: Force,
    /// Pressure on the sides of a specimen under a plate, Pa.
    pub confinement: Option<Given>,
    /// Speed along the rail, m/s; 0 for a load at a fixed place.
    pub speed: Given,
    /// Number of cycles of a cyclic force.
    pub cycles: u64,
    /// Place of the text that makes it more than a constant force at one place; `None` otherwise.
    pub changes: Option<Span>,
}

/// Force for one rail, N, positive downwards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Force {
    Constant(Given),
    /// Changes from the smaller to the greater force and back.
    Cyclic {
        range: [Given; 2],
        /// Hz.
        frequency: Given,
        wave: Wave,
    },
    /// Times, s, and forces, linear in between; constant beyond the ends.
    History(Vec<[f64; 2]>),
    /// Shortening / height of the bed under a driven plate, instead of a force.
    Strain(Given),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wave {
    Sine,
}

impl Force {
    /// Force, N; 0 if a strain is given instead of a force.
    pub fn largest(&self) -> f64 {
        match self {
            Force::Constant(force) => **force,
            Force::Cyclic { range, .. } => *range[1],
            Force::History(points) => points.iter().map(|point| point[1]).fold(0.0, f64::max),
            Force::Strain(_) => 0.0,
        }
    }
}

impl RigLoad {
    /// The constant load, if the load is constant and does not move.
    pub fn at_rest(&self) -> Option<StaticLoad> {
        match self.force {
            Force::Constant(force) if *self.speed == 0.0 && self.confinement.is_none() => {
                Some(StaticLoad { name: self.name.clone(), span: self.span, on: self.on, x: self.x, force })
            }
            _ => None,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Target {
    Rail,
    Sleepers,
    /// A plate over the whole bed, instead of sleepers.
    Bed,
}
