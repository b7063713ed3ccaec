//! Vehicles that run together.

use super::error::{TrackError, TrackParameter};
use super::multibody::Multibody;
use serde::{Deserialize, Serialize};

/// The direction of a train.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Direction {
    /// Towards larger x.
    Forward,
    Backward,
}

/// Vehicles that run together.
#[derive(Debug, Clone, PartialEq)]
pub struct Train {
    /// Leading vehicle first, each with the distance of its first wheel behind the first wheel of the train, m.
    pub vehicles: Vec<(Multibody, f64)>,
    pub direction: Direction,
}

impl Direction {
    /// +1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Direction::Forward => 1.0,
            Direction::Backward => -1.0,
        }
    }
}

impl Train {
    /// One vehicle.
    pub fn single(vehicle: impl Into<Multibody>, direction: Direction) -> Self {
        Self { vehicles: vec![(vehicle.into(), 0.0)], direction }
    }

    /// Number of wheels.
    pub fn wheels(&self) -> usize {
        self.vehicles.iter().map(|(vehicle, _)| vehicle.wheels.len()).sum()
    }

    /// Distance of every wheel behind the first one, m, vehicle by vehicle.
    pub(super) fn wheel_offsets(&self) -> impl Iterator<Item = f64> + '_ {
        self.vehicles.iter().flat_map(|(vehicle, offset)| vehicle.wheels.iter().map(move |w| offset + w.offset))
    }

    /// Chainage of every wheel while the leading one is at `leading` (m), vehicle by vehicle.
    pub fn wheel_positions(&self, leading: f64) -> impl Iterator<Item = f64> + '_ {
        let sign = self.direction.sign();
        self.wheel_offsets().map(move |offset| leading - sign * offset)
    }

    /// Distance from the leading to the last wheel, m.
    pub fn wheel_base(&self) -> f64 {
        self.wheel_offsets().fold(0.0, f64::max)
    }

    pub(super) fn check(&self) -> Result<(), TrackError> {
        for (vehicle, offset) in &self.vehicles {
            vehicle.check()?;
            if !(*offset >= 0.0 && offset.is_finite()) {
                return Err(TrackError::Parameter {
                    name: TrackParameter::Train("offset of a vehicle"),
                    value: *offset,
                    expected: "of 0 or more",
                });
            }
        }
        Ok(())
    }
}
