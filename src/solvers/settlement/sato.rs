//! Settlement by Sato (1995): `S = γ (1 − e^{−αN}) + β N`, the initial settlement of the ballast after tamping and the
//! continuing settlement.
//!
//! The published form does not depend on the force. `exponent` adds a factor (F/F₀)^m; with 0 it is the published form.

use super::hardening::{Growth, invert};
use super::peak::Peak;
use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sato {
    /// Rate of the initial settlement, 1 per cycle.
    pub alpha: f64,
    /// Continuing settlement per cycle, m.
    pub beta: f64,
    /// Total initial settlement, m.
    pub gamma: f64,
    /// m, exponent of the force.
    pub exponent: f64,
    /// F₀, N; without effect if the exponent is 0.
    pub reference_force: f64,
}

impl Default for Sato {
    /// The example of a public implementation.
    fn default() -> Self {
        Self { alpha: 1e-4, beta: 1e-8, gamma: 5e-3, exponent: 0.0, reference_force: 50e3 }
    }
}

impl Growth for Sato {
    fn amplitude(&self, peak: Peak) -> f64 {
        (peak.force / self.reference_force).powf(self.exponent)
    }

    fn shape(&self, cycles: f64) -> f64 {
        -self.gamma * (-self.alpha * cycles).exp_m1() + self.beta * cycles
    }

    fn cycles(&self, shape: f64) -> f64 {
        let Sato { alpha, beta, gamma, .. } = *self;
        if beta == 0.0 {
            return if shape < gamma { -(-shape / gamma).ln_1p() / alpha } else { f64::INFINITY };
        }
        let below = ((shape - gamma) / beta).max(0.0);
        invert(shape, below, |n| (self.shape(n), gamma * alpha * (-alpha * n).exp() + beta))
    }
}
