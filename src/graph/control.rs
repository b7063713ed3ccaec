//! Length of the next block: step control as in an ODE solver, with the settlement of a block as the step.
//!
//! Forces change because the track settles, and settlement slows down with the number of axles. The control therefore
//! chooses the largest settlement of a block at any seat, the `aim`, and the number of axles follows from the law. The
//! error of a block with the forces of its start grows with the square of this settlement, which gives the next aim
//! from the last error.

use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// State of the control between two blocks.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Control {
    /// Adaptive: settlement that the next block aims at, m; `None` before the first block, which is one train.
    pub aim: Option<f64>,
    /// Fixed and geometric: largest number of trains in the next block, after a block that had to be shortened.
    pub limit: Option<u64>,
    /// Fixed and geometric, on grains: largest number of trains in the next block, so that its sleepers settle evenly
    /// enough for constant forces; `None` before the first block and after one that settled evenly.
    #[serde(default)]
    pub even: Option<u64>,
}

/// Unevenness above which forces change within a block by more than about half: a sleeper settles beside its neighbours
/// by half of the displacement of the rail under a train.
pub const UNEVEN: f64 = 0.5;
/// Unevenness that the next block aims at. The rate of a sleeper can double until then.
const LEVEL: f64 = 0.25;

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
        [self.limit, self.even].into_iter().flatten().fold(wanted, u64::min)
    }

    /// A block of `trains` trains must be repeated in halves.
    pub fn shorten(&mut self, trains: u64) {
        self.limit = Some(trains.div_ceil(2));
    }

    /// A block of `trains` trains settled the sleepers with this unevenness. In the next one they are expected to
    /// settle at the same rates.
    pub fn level(&mut self, trains: u64, unevenness: f64) {
        self.even = (unevenness > 0.0).then(|| ((trains as f64 * LEVEL / unevenness) as u64).max(1));
    }

    /// A block of `trains` trains was accepted, and `wanted` trains were asked for: the next block may be twice as
    /// long.
    pub fn lengthen(&mut self, trains: u64, wanted: u64) {
        self.limit = self.limit.map(|_| 2 * trains).filter(|_| trains < wanted);
    }
}

/// Values that `largest_within` asks for before it halves its interval only.
const QUICK: u32 = 16;

/// The largest count from 1 to `most` for which `value` is at most `bound`; 1 if there is none. `value` must not fall
/// with the count. A settlement grows about as a power of the count, so the search goes along chords between
/// logarithms (regula falsi, with the weights of the Illinois algorithm, so that both ends move).
fn largest_within(bound: f64, most: u64, mut value: impl FnMut(u64) -> f64) -> u64 {
    let beyond_by = |value: f64| (value / bound).ln();
    if most <= 1 {
        return 1;
    }
    let last = value(most);
    if last <= bound {
        return most;
    }
    let first = value(1);
    if first > bound {
        return 1;
    }
    let (mut within, mut beyond) = ((1, beyond_by(first)), (most, beyond_by(last)));
    let mut moved = Ordering::Equal;
    for asked in 0.. {
        if beyond.0 - within.0 <= 1 {
            break;
        }
        let share = within.1 / (within.1 - beyond.1);
        let at = if asked < QUICK && (0.0..=1.0).contains(&share) {
            let guess = within.0 as f64 * (beyond.0 as f64 / within.0 as f64).powf(share);
            (guess as u64).clamp(within.0 + 1, beyond.0 - 1)
        } else {
            within.0 + (beyond.0 - within.0) / 2
        };
        let there = value(at);
        let side = if there <= bound { Ordering::Less } else { Ordering::Greater };
        let (end, other) = if side.is_lt() { (&mut within, &mut beyond) } else { (&mut beyond, &mut within) };
        *end = (at, beyond_by(there));
        other.1 *= if side == moved { 0.5 } else { 1.0 };
        moved = side;
    }
    within.0
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
    fn a_power_of_the_count_is_found_in_few_steps() {
        for exponent in [0.1, 0.2, 0.5, 1.0] {
            for expected in [2, 3, 17, 1_000, 123_456, 499_998] {
                let (mut asked, grown) = (0, |n: u64| 1e-3 + 2e-3 * (n as f64).powf(exponent));
                let found = largest_within(grown(expected), 500_000, |n| {
                    asked += 1;
                    grown(n)
                });
                assert_eq!(found, expected);
                assert!(asked <= 14, "{expected} to the power of {exponent}: {asked} values");
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

    #[test]
    fn blocks_are_shorter_while_sleepers_settle_unevenly() {
        let mut control = Control::default();
        control.level(5, 0.0);
        assert_eq!(control.bounded(50), 50, "even");
        control.level(20, 2.0);
        assert_eq!(control.bounded(50), 2, "an eighth of the block");
        control.level(2, 0.05);
        assert_eq!(control.bounded(50), 10, "longer again");
        control.level(1, 40.0);
        assert_eq!(control.bounded(50), 1, "one train at least");
    }
}
