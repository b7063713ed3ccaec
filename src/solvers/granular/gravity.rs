//! Gravity, which may vary in time.

use super::vector::{Vec3, scale};
use serde::{Deserialize, Serialize};

/// Acceleration of free fall over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Gravity {
    /// \[m/s2\]
    Constant(Vec3),
    /// `mean (1 + share sin(2 pi frequency t))`: a shaken floor in the frame of the floor.
    Shaken { mean: Vec3, share: f64, frequency: f64 },
    /// Linear between times \[s\], constant beyond them; at least one time.
    Table { times: Vec<f64>, values: Vec<Vec3> },
}

impl Default for Gravity {
    fn default() -> Self {
        Gravity::Constant([0.0; 3])
    }
}

impl Gravity {
    /// Standard gravity, downwards along z.
    pub const EARTH: Gravity = Gravity::Constant([0.0, 0.0, -9.81]);

    /// Gravity at a time \[s\].
    pub fn value_at(&self, time: f64) -> Vec3 {
        match self {
            Gravity::Constant(value) => *value,
            Gravity::Shaken { mean, share, frequency } => {
                scale(*mean, 1.0 + share * (std::f64::consts::TAU * frequency * time).sin())
            }
            Gravity::Table { times, values } => {
                let right = times.partition_point(|&t| t <= time);
                if right == 0 || right == times.len() {
                    return values[right.saturating_sub(1)];
                }
                let share = (time - times[right - 1]) / (times[right] - times[right - 1]);
                [0, 1, 2].map(|c| values[right - 1][c] + share * (values[right][c] - values[right - 1][c]))
            }
        }
    }
}
