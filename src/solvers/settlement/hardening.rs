//! Varying load under laws that are stated for a constant one.
//!
//! A law S = s(F) f(N) says nothing about a load that changes. Strain hardening fills the gap: what has settled counts, not
//! how. Under a new load the support goes on from the number of cycles of that load which would have settled as much,
//!
//! ```text
//! f(N_eq) = S / s(F),   S' = s(F) f(N_eq + n).
//! ```
//!
//! Equal loads give the closed form again, and n cycles are n times one. For f = N^b this is a damage that adds up, whatever the
//! order: S^(1/b) grows by s^(1/b) a cycle.

use serde::{Deserialize, Serialize};

/// A law S = s(F) f(N), f rising from f(0) = 0 and never steeper than before.
pub(super) trait Growth {
    /// s(F); the product with f is in m.
    fn amplitude(&self, force: f64) -> f64;
    /// f(N).
    fn shape(&self, cycles: f64) -> f64;
    /// N where f(N) is `shape`; infinite where f never gets there.
    fn cycles(&self, shape: f64) -> f64;
    /// Whether cycles of unequal loads may change places.
    fn order_is_free(&self) -> bool {
        false
    }
}

/// What a support remembers under such a law.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HardeningState {
    /// m.
    settlement: f64,
    /// The last load, N, and the cycles of it that would have settled as much: equal loads stay on the closed form.
    force: f64,
    equivalent: f64,
    /// Cycles carried in all.
    carried: u64,
}

/// Trains of unequal wheels are taken wheel by wheel in groups of at most this share of what has been carried. The order
/// within a group is wrong; `unequal_wheels_agree_with_their_cycles` measures by how much.
const GROUP: u64 = 16;

impl HardeningState {
    /// m, positive down.
    pub(super) fn settlement(&self) -> f64 {
        self.settlement
    }

    /// Lets `trains` trains pass, `forces` (N) being the cycles of one.
    pub(super) fn load(&mut self, law: &dyn Growth, forces: &[f64], trains: u64) {
        let Some(first) = forces.first() else { return };
        if forces.iter().all(|force| force == first) {
            self.advance(law, *first, trains * forces.len() as u64);
            return;
        }
        let mut left = trains;
        while left > 0 {
            let group = if law.order_is_free() { left } else { self.carried / (GROUP * forces.len() as u64) };
            let group = group.clamp(1, left);
            forces.iter().for_each(|force| self.advance(law, *force, group));
            left -= group;
        }
    }

    fn advance(&mut self, law: &dyn Growth, force: f64, count: u64) {
        self.carried += count;
        let amplitude = law.amplitude(force);
        if amplitude.is_nan() || amplitude <= 0.0 {
            return;
        }
        let before = if force == self.force { self.equivalent } else { law.cycles(self.settlement / amplitude) };
        let after = before + count as f64;
        // so weak a load adds nothing to what stronger ones have settled
        if !after.is_finite() {
            return;
        }
        (self.force, self.equivalent) = (force, after);
        self.settlement = self.settlement.max(amplitude * law.shape(after));
    }
}

/// Solves f(N) = `shape` by Newton's method from a point at or below the root: a concave f is approached from that side only.
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
