//! Settlement by Nasrollahi et al. (2023): a power of the force above a threshold, which rises with settlement.
//!
//! ```text
//! dδ/dN = (α/N₀) Σ ( ⟨F − F_th(δ)⟩ / F₀ )^β,   F_th(δ) = F_∞ − (F_∞ − F_th0) e^{−γδ}
//! ```
//!
//! over the cycles of one train, ⟨x⟩ = max(x, 0). Under a force below F_∞ the settlement ends at
//! `δ_∞ = ln((F_∞ − F_th0)/(F_∞ − F)) / γ`. The right side depends on δ alone, so that a block of trains is one
//! integration, by the pair of Dormand and Prince, with the error [`TOLERANCE`] per step.

use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Nasrollahi {
    /// Settlement of the reference cycles at the reference force above the threshold, m.
    pub alpha: f64,
    /// Exponent of the force above the threshold, 1 or more.
    pub beta: f64,
    /// Rate at which the threshold rises with settlement, 1/m.
    pub gamma: f64,
    /// F_th0, threshold of a fresh support, N.
    pub initial_threshold: f64,
    /// F_∞, threshold of a support after long settlement, N; not below the initial threshold.
    pub final_threshold: f64,
    /// F₀, N.
    pub reference_force: f64,
    /// N₀.
    pub reference_cycles: f64,
}

/// Error of one step, as a share of the settlement.
const TOLERANCE: f64 = 1e-11;
/// Largest number of steps; 1e9 cycles need a few hundred.
const MOST_STEPS: usize = 100_000;

impl Default for Nasrollahi {
    /// The constants of a public implementation, calibrated for axles of 30 t.
    fn default() -> Self {
        Self {
            alpha: 0.02e-3,
            beta: 2.8,
            gamma: 0.11e3,
            initial_threshold: 35e3,
            final_threshold: 90e3,
            reference_force: 1e3,
            reference_cycles: 1e5,
        }
    }
}

impl Nasrollahi {
    /// Force below which a support that has settled by `settlement` (m) settles no further, N.
    pub fn threshold(&self, settlement: f64) -> f64 {
        self.final_threshold - (self.final_threshold - self.initial_threshold) * (-self.gamma * settlement).exp()
    }

    /// dδ/dN, m per train with cycles of peak `forces` (N).
    fn rate(&self, settlement: f64, forces: &[f64]) -> f64 {
        let threshold = self.threshold(settlement);
        let above = forces.iter().map(|force| (force - threshold) / self.reference_force).filter(|above| *above > 0.0);
        self.alpha / self.reference_cycles * above.map(|above| above.powf(self.beta)).sum::<f64>()
    }

    /// Settlement (m) of a support at `settlement` after `trains` further trains, each with cycles of peak `forces`
    /// (N).
    pub(super) fn after(&self, settlement: f64, forces: &[f64], trains: f64) -> f64 {
        let (mut now, mut left, mut step) = (settlement, trains, trains);
        let mut slope = self.rate(now, forces);
        for _ in 0..MOST_STEPS {
            if slope == 0.0 || left <= 0.0 {
                break;
            }
            step = step.min(left);
            let (next, error) = dormand_prince(now, slope, step, |s| self.rate(s, forces));
            let share = error / (TOLERANCE * next.max(now + step * slope));
            if share <= 1.0 {
                now = next.max(now);
                left -= step;
                slope = self.rate(now, forces);
            }
            step *= (0.9 * share.powf(-0.2)).clamp(0.1, 5.0);
        }
        now
    }
}

/// One step of order 5 from `y` with slope `k1` there, and its difference from the embedded step of order 4.
fn dormand_prince(y: f64, k1: f64, h: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let k2 = f(y + h * k1 / 5.0);
    let k3 = f(y + h * (3.0 / 40.0 * k1 + 9.0 / 40.0 * k2));
    let k4 = f(y + h * (44.0 / 45.0 * k1 - 56.0 / 15.0 * k2 + 32.0 / 9.0 * k3));
    let k5 = f(y + h * (19372.0 / 6561.0 * k1 - 25360.0 / 2187.0 * k2 + 64448.0 / 6561.0 * k3 - 212.0 / 729.0 * k4));
    let k6 = f(y + h
        * (9017.0 / 3168.0 * k1 - 355.0 / 33.0 * k2 + 46732.0 / 5247.0 * k3 + 49.0 / 176.0 * k4
            - 5103.0 / 18656.0 * k5));
    let next = y + h
        * (35.0 / 384.0 * k1 + 500.0 / 1113.0 * k3 + 125.0 / 192.0 * k4 - 2187.0 / 6784.0 * k5 + 11.0 / 84.0 * k6);
    let k7 = f(next);
    let error = h
        * (71.0 / 57600.0 * k1 - 71.0 / 16695.0 * k3 + 71.0 / 1920.0 * k4 - 17253.0 / 339200.0 * k5
            + 22.0 / 525.0 * k6
            - k7 / 40.0);
    (next, error.abs())
}
