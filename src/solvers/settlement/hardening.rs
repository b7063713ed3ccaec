//! Varying load under laws that are defined for a constant load.
//!
//! A law S = s(F) f(N) does not define the settlement under a load that changes. Strain hardening is used: only the
//! settlement counts, not its history. Under a new load the support continues from the number of cycles of that load
//! that would have caused the same settlement,
//!
//! ```text
//! f(N_eq) = S / s(F),   S' = s(F) f(N_eq + n).
//! ```
//!
//! Equal loads give the closed form again, and n cycles together are the same as n single cycles. For f = N^b this is a
//! damage that adds up independent of the order: S^(1/b) grows by s^(1/b) per cycle.

use super::peak::Peak;
use serde::{Deserialize, Serialize};

/// A law S = s(F) f(N), with f increasing from f(0) = 0 and concave.
pub(super) trait Growth {
    /// s(F); the product with f is in m.
    fn amplitude(&self, peak: Peak) -> f64;
    /// f(N).
    fn shape(&self, cycles: f64) -> f64;
    /// N at which f(N) is `shape`; infinite if f never reaches it.
    fn cycles(&self, shape: f64) -> f64;
    /// Whether the order of cycles with unequal loads does not matter.
    fn order_is_free(&self) -> bool {
        false
    }
}

/// The state of a support under such a law.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HardeningState {
    /// m.
    settlement: f64,
    /// s(F) of the last load, and the number of its cycles that would have caused the same settlement: equal loads stay
    /// on the closed form.
    amplitude: f64,
    equivalent: f64,
    /// Number of cycles carried so far.
    carried: u64,
}

/// Trains with unequal wheels are applied wheel by wheel in groups of at most this share of the cycles carried so far.
/// The order within a group is not exact; `unequal_wheels_agree_with_their_cycles` measures the error.
const GROUP: u64 = 16;

impl HardeningState {
    /// m, positive down.
    pub(super) fn settlement(&self) -> f64 {
        self.settlement
    }

    /// Applies `trains` trains; `cycles` are the peaks of the cycles of one train.
    pub(super) fn load(&mut self, law: &dyn Growth, cycles: &[Peak], trains: u64) {
        let amplitudes: Vec<f64> = cycles.iter().map(|peak| law.amplitude(*peak)).collect();
        let Some(first) = amplitudes.first() else { return };
        if amplitudes.iter().all(|amplitude| amplitude == first) {
            self.advance(law, *first, trains * amplitudes.len() as u64);
            return;
        }
        let mut left = trains;
        while left > 0 {
            let group = if law.order_is_free() { left } else { self.carried / (GROUP * amplitudes.len() as u64) };
            let group = group.clamp(1, left);
            amplitudes.iter().for_each(|amplitude| self.advance(law, *amplitude, group));
            left -= group;
        }
    }

    fn advance(&mut self, law: &dyn Growth, amplitude: f64, count: u64) {
        self.carried += count;
        if amplitude.is_nan() || amplitude <= 0.0 {
            return;
        }
        let before =
            if amplitude == self.amplitude { self.equivalent } else { law.cycles(self.settlement / amplitude) };
        let after = before + count as f64;
        // a load this small adds nothing to the settlement by larger loads
        if !after.is_finite() {
            return;
        }
        (self.amplitude, self.equivalent) = (amplitude, after);
        self.settlement = self.settlement.max(amplitude * law.shape(after));
    }
}

/// Solves f(N) = `shape` by Newton's method from a point at or below the root: a concave f is approached from that side
/// only.
pub(super) fn invert(shape: f64, from: f64, value_and_slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut cycles = from;
    for _ in 0..200 {
        let (value, slope) = value_and_slope(cycles);
        let next = cycles + (shape - value) / slope;
        if !(next.is_finite() && next > cycles * (1.0 + 1e-15)) {
            break;
        }
        cycles = next;
    }
    cycles
}
