//! The state of a riding train, as data.

use super::rider::{BodyState, WheelState};
use serde::{Deserialize, Serialize};

/// The motion of a train. Lists run over vehicles or wheels.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct RideState {
    /// When it began, s.
    pub began: f64,
    /// Levels of the ground before the left and behind the right end, m, if the rail has no continuation there.
    pub ground: [f64; 2],
    pub bodies: Vec<BodyState>,
    pub wheels: Vec<WheelState>,
}

impl RideState {
    /// Numbers of vehicles and wheels.
    pub fn shape(&self) -> [usize; 2] {
        [self.bodies.len(), self.wheels.len()]
    }

    /// Per wheel, N.
    pub fn forces(&self) -> impl Iterator<Item = f64> + '_ {
        self.wheels.iter().map(|wheel| wheel.force)
    }
}
