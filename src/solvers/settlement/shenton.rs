//! Settlement by Shenton (1985): `S = (F/F₀)^m (k₁ N^0.2 + k₂ N)`.
//!
//! The full form, with a lift L in mm at tamping, `S = K_s (A/20) [(0.69 + 0.028 L) N^0.2 + 2.7e-6 N]` mm for an axle
//! load A in t, is this form with m = 1, F₀ the seat force of a 20 t axle, k₁ = K_s (0.69 + 0.028 L) mm and k₂ = 2.7e-6
//! K_s mm. Strain hardening of its first term is Shenton's own rule for mixed axles: their fifth powers add up.

use super::hardening::{Growth, invert};
use super::peak::Peak;
use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Shenton {
    /// Settlement of the first cycle of the reference force, m.
    pub k1: f64,
    /// Continuing settlement per cycle of the reference force, m.
    pub k2: f64,
    /// m, exponent of the force.
    pub exponent: f64,
    /// F₀, N.
    pub reference_force: f64,
}

const ROOT: f64 = 0.2;

impl Default for Shenton {
    /// The full form without a lift, K_s = 1.1.
    fn default() -> Self {
        Self { k1: 0.759e-3, k2: 2.97e-9, exponent: 1.0, reference_force: 33e3 }
    }
}

impl Growth for Shenton {
    fn amplitude(&self, peak: Peak) -> f64 {
        (peak.force / self.reference_force).powf(self.exponent)
    }

    fn shape(&self, cycles: f64) -> f64 {
        self.k1 * cycles.powf(ROOT) + self.k2 * cycles
    }

    fn cycles(&self, shape: f64) -> f64 {
        let Shenton { k1, k2, .. } = *self;
        let by_root = (shape / k1).powf(1.0 / ROOT);
        if k2 == 0.0 || shape == 0.0 {
            return by_root;
        }
        // at a number of cycles at which each term gives half or less, both together give no more than the whole
        let below = (by_root * 0.5f64.powf(1.0 / ROOT)).min(0.5 * shape / k2);
        invert(shape, below, |n| (self.shape(n), ROOT * k1 * n.powf(ROOT - 1.0) + k2))
    }
}
