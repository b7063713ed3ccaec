//! What acts on the track: vehicles, trains and test loads.

use super::{Given, Order, Profile, Sequence, Share};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// A vehicle on two bogies of two axles each, as carried by **one rail**: half of every mass, inertia and stiffness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Vehicle {
    pub name: String,
    /// kg.
    pub car_body_mass: Given,
    /// kg m^2.
    pub car_body_pitch_inertia: Given,
    /// kg, of each bogie.
    pub bogie_mass: Given,
    /// kg m^2, of each bogie.
    pub bogie_pitch_inertia: Given,
    /// Distance of the bogie centres, m.
    pub bogie_spacing: Given,
    /// kg, of each wheel with its half axle.
    pub wheel_mass: Given,
    /// Distance of the axles of a bogie, m.
    pub wheelset_spacing: Given,
    /// m, for the drawing.
    pub wheel_radius: f64,
    /// N/m and N s/m, of each wheel.
    pub primary_stiffness: Given,
    pub primary_damping: Given,
    /// N/m and N s/m, of each bogie.
    pub secondary_stiffness: Given,
    pub secondary_damping: Given,
    /// Hertz constant of wheel on rail, N/m^1.5.
    pub hertz: Given,
    /// Over the couplers, m; given where a train needs it.
    pub length: Option<Given>,
}

impl Vehicle {
    /// Number of axles.
    pub const AXLES: u64 = 4;

    /// Mass over one rail, kg.
    pub fn mass(&self) -> f64 {
        *self.car_body_mass + 2.0 * *self.bogie_mass + 4.0 * *self.wheel_mass
    }

    /// Distances of the four wheels behind the leading one, m.
    pub fn wheel_offsets(&self) -> [f64; 4] {
        let (bogies, wheels) = (*self.bogie_spacing, *self.wheelset_spacing);
        [0.0, wheels, bogies, bogies + wheels]
    }
}

/// Vehicles that run together at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Train {
    pub name: String,
    /// In the order of the train, the leading one first.
    pub vehicles: Vec<Vehicle>,
    /// m/s; the largest where it varies.
    pub speed: Given,
    /// m/s by the chainage of the leading wheel, over the whole track; `None` is `speed` everywhere.
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

    /// Mass that a wheel carries on average, kg.
    pub fn mean_wheel_mass(&self) -> f64 {
        self.vehicles.iter().map(Vehicle::mass).sum::<f64>() / self.axles() as f64
    }

    /// Distance of each vehicle's leading wheel behind the train's leading wheel, m. Vehicles of a train are centred
    /// between their couplers.
    pub fn vehicle_offsets(&self) -> Vec<f64> {
        let mut offsets = Vec::with_capacity(self.vehicles.len());
        let mut front = 0.0; // of the vehicle's coupler, behind that of the train
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
    /// Every second train the other way.
    Both,
}

/// The trains of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Traffic {
    /// The train that the scene names first. What is shown of one train only is of it.
    pub train: Train,
    /// Trains of other kinds that share the track with it.
    pub others: Vec<Train>,
    /// How many trains of each kind run, in the order of the scene; of one kind alone it follows from `total`.
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

    /// Speed of the fastest train, m/s: limits of the level of a line go by it.
    pub fn line_speed(&self) -> f64 {
        self.trains().map(|train| *train.speed).fold(0.0, f64::max)
    }

    /// Whether trains of several kinds run.
    pub fn is_mixed(&self) -> bool {
        !self.others.is_empty()
    }

    /// Which train runs when.
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
    /// Where it stands.
    pub span: Span,
    pub on: Target,
    /// Chainage, m.
    pub x: f64,
    /// N over one rail, positive down.
    pub force: Given,
}

/// A force on a sleeper or the rail that changes or moves: a test rig, or a load that only grains can follow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RigLoad {
    pub name: String,
    /// Where it stands.
    pub span: Span,
    pub on: Target,
    /// Chainage at the start, m.
    pub x: f64,
    pub force: Force,
    /// On the sides of a specimen under a plate, Pa.
    pub confinement: Option<Given>,
    /// Along the rail, m/s; 0 stays.
    pub speed: Given,
    /// Times that a cyclic force comes back.
    pub cycles: u64,
    /// What of it is more than a constant force at one place, where the scene says that.
    pub changes: Option<Span>,
}

/// N over one rail, positive down.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Force {
    Constant(Given),
    /// From the smaller to the greater force and back.
    Cyclic {
        range: [Given; 2],
        /// Hz.
        frequency: Given,
        wave: Wave,
    },
    /// Time, s, and force, straight in between; held beyond the ends.
    History(Vec<[f64; 2]>),
    /// Shortening of the bed under a plate that is driven down, over its height; no force.
    Strain(Given),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wave {
    Sine,
}

impl Force {
    /// N; 0 where the way is given and not the force.
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
    /// A load that stays as it is, where this is one.
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
    /// A plate over the whole bed, in the place of sleepers.
    Bed,
}
