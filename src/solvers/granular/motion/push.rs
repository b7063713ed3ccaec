//! A force applied by an actuator, as a function of time.

use super::error::{MotionError, require};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// An applied force, N.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Push {
    Constant(f64),
    /// `low` at `start`, then `low + (high - low) (1 - cos 2 pi f (t - start)) / 2`. Before `start` the force grows
    /// linearly from 0 over the time `ramp`.
    Cyclic {
        low: f64,
        high: f64,
        /// Hz.
        frequency: f64,
        /// s.
        start: f64,
        /// s.
        ramp: f64,
    },
    /// Force (N) linear between times (s, increasing); the first value holds before, the last value after.
    Table {
        times: Vec<f64>,
        forces: Vec<f64>,
    },
}

impl Push {
    /// At a time, s.
    pub fn force_at(&self, time: f64) -> f64 {
        match self {
            Push::Constant(force) => *force,
            Push::Cyclic { low, high, frequency, start, ramp } if time >= *start || *ramp == 0.0 => {
                let since = (time - start).max(0.0);
                low + (high - low) * (1.0 - (TAU * frequency * since).cos()) / 2.0
            }
            Push::Cyclic { low, start, ramp, .. } => low * (1.0 - (start - time) / ramp).max(0.0),
            Push::Table { times, forces } => {
                let right = times.partition_point(|t| *t <= time);
                match right {
                    0 => forces[0],
                    n if n == times.len() => forces[n - 1],
                    n => {
                        let share = (time - times[n - 1]) / (times[n] - times[n - 1]);
                        forces[n - 1] + share * (forces[n] - forces[n - 1])
                    }
                }
            }
        }
    }

    /// The first number that is out of its range.
    pub fn check(&self) -> Result<(), MotionError> {
        let finite = |name, value: f64| require(value.is_finite(), name, value, "a finite number");
        let positive =
            |name, value: f64| require(value.is_finite() && value >= 0.0, name, value, "a number of 0 or more");
        match self {
            Push::Constant(force) => finite("applied force", *force),
            Push::Cyclic { low, high, frequency, start, ramp } => {
                finite("lower applied force", *low)?;
                finite("upper applied force", *high)?;
                positive("frequency of an applied force", *frequency)?;
                finite("start of an applied force", *start)?;
                positive("ramp of an applied force", *ramp)
            }
            Push::Table { times, forces } => {
                let name = "times of an applied force";
                require(!times.is_empty(), name, 0.0, "of 1 or more")?;
                let same = times.len() == forces.len();
                require(same, "number of applied forces", forces.len() as f64, "as many as there are times")?;
                times.iter().try_for_each(|t| finite(name, *t))?;
                times
                    .windows(2)
                    .try_for_each(|pair| require(pair[1] > pair[0], name, pair[1], "each above the time before it"))?;
                forces.iter().try_for_each(|force| finite("applied force", *force))
            }
        }
    }
}
