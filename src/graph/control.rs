//! Length of the next block: step control as in an ODE solver, with the settlement of a block as the step.
//!
//! Forces change because the track settles, and settlement slows down with the number of axles. The control therefore
//! chooses the largest settlement of a block at any seat, the `aim`, and the number of axles follows from the law. The
//! error of a block with the forces of its start grows with the square of this settlement, which gives the next aim
//! from the last error.

use serde::{Deserialize, Serialize};

/// State of the control between two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Control {
    /// Adaptive: settlement that the next block aims at, m; `None` before the first block, which is one train.
    pub aim: Option<f64>,
    /// Fixed and geometric: largest number of trains in the next block, after a block that had to be shortened.
    pub limit: Option<u64>,
}

/// Next aim / largest aim that the last error allows.
const SAFETY: f64 = 0.9;
/// Largest factors by which the aim grows and falls from block to block.
const GROWTH: f64 = 3.0;
const FALL: f64 = 0.2;

impl Control {
    /// Sets the next aim from the error of a block with settlement `settled`; both m.
    pub fn learn(&mut self, error: f64, settled: f64, tolerance: f64, cap: Option<f64>) {
        let aim = self.aim.unwrap_or(settled);
        let allowed = if error > 0.0 { SAFETY * settled * (tolerance / error).sqrt() } else { f64::INFINITY };
        self.aim = Some(allowed.clamp(FALL * aim, GROWTH * aim).min(cap.unwrap_or(f64::INFINITY)));
    }

    /// Number of trains in the next block of an adaptive policy, at most `most`: the number that settles the aim, and
    /// at least two if two are `left` until the next stop. If two blocks are needed for the trains that are left, the
    /// blocks are equal.
    pub fn choose(&self, most: u64, left: u64, mut settled: impl FnMut(u64) -> f64) -> u64 {
        let Some(aim) = self.aim else { return left.min(2) };
        let trains = largest_within(aim, most, &mut settled).max(left.min(2));
        if trains == left {
            trains
        } else if left < 2 * trains {
            left.div_ceil(2)
        } else {
            trains / 2 * 2 // an even number has a middle
        }
    }

    /// Largest number of trains in a block of a fixed or geometric policy.
    pub fn bounded(&self, wanted: u64) -> u64 {
        self.limit.map_or(wanted, |limit| wanted.min(limit))
    }

    /// A block of `trains` trains must be repeated in halves.
    pub fn shorten(&mut self, trains: u64) {
        self.limit = Some(trains.div_ceil(2));
    }

    /// A block of `trains` trains was accepted, and `wanted` trains were asked for: the next block may be twice as
    /// long.
    pub fn lengthen(&mut self, trains: u64, wanted: u64) {
        self.limit = self.limit.map(|_| 2 * trains).filter(|_| trains < wanted);
    }
}

/// The largest count from 1 to `most` for which `value` is at most `bound`; 1 if there is none. `value` must not fall
/// with the count.
fn largest_within(bound: f64, most: u64, mut value: impl FnMut(u64) -> f64) -> u64 {
    if most <= 1 || value(most) <= bound {
        return most.max(1);
    }
    let (mut within, mut beyond) = (1, most);
    while beyond - within > 1 {
        let middle = within + (beyond - within) / 2;
        if value(middle) <= bound { within = middle } else { beyond = middle }
    }
    within
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_found() {
        for most in [1, 2, 7, 1000] {
            for bound in [0.0, 1.0, 3.5, 999.0, 1e9] {
                let expected = (1..=most).rev().find(|n| *n as f64 <= bound).unwrap_or(1);
                assert_eq!(largest_within(bound, most, |n| n as f64), expected);
            }
        }
    }

    #[test]
    fn the_aim_follows_the_error() {
        let mut control = Control::default();
        control.learn(0.0, 1e-4, 1e-5, None);
        assert!((control.aim.unwrap() - 3e-4).abs() < 1e-12, "an exact block grows");
        control.learn(4e-5, 3e-4, 1e-5, None);
        assert!((control.aim.unwrap() - 0.9 * 1.5e-4).abs() < 1e-12, "a quarter of the error at half the step");
        control.learn(1.0, 1e-4, 1e-5, None);
        assert!((control.aim.unwrap() - 0.2 * 1.35e-4).abs() < 1e-12);
        control.learn(0.0, 1e-4, 1e-5, Some(5e-5));
        assert_eq!(control.aim, Some(5e-5), "the cap");
    }

    #[test]
    fn a_shortened_block_grows_again() {
        let mut control = Control::default();
        assert_eq!(control.bounded(50), 50);
        control.shorten(50);
        assert_eq!(control.bounded(50), 25);
        control.lengthen(25, 50);
        assert_eq!(control.bounded(50), 50);
        control.lengthen(50, 50);
        assert_eq!(control.limit, None);
        control.shorten(3);
        assert_eq!(control.bounded(50), 2);
    }
}
