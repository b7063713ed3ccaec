//! A power law defined by the user, or fitted to grains: `S = a (F/F₀)^m e^(-g v) N^b`, v the void under the sleeper.
//!
//! Under varying load S^(1/b) adds up (see `hardening`): the order of the cycles has no effect.

use super::hardening::Growth;
use super::peak::Peak;
use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Power {
    /// Settlement of the first cycle of the reference force, m.
    pub a: f64,
    /// Exponent of the force; with a larger exponent large forces cause more of the settlement.
    pub m: f64,
    /// Exponent of the number of cycles, above 0 and at most 1; with a larger exponent settlement continues longer.
    pub b: f64,
    /// F₀, N.
    pub reference_force: f64,
    /// Decrease of settlement with the void, 1/m; 0 for a law of forces alone.
    pub g: f64,
}

impl Default for Power {
    /// Not from a publication: the shape of the box tests of Selig and Waters (1994), N^0.17, 4.318 mm in the first
    /// cycle.
    fn default() -> Self {
        Self { a: 4.318e-3, m: 1.0, b: 0.17, reference_force: 50e3, g: 0.0 }
    }
}

impl Growth for Power {
    fn amplitude(&self, peak: Peak) -> f64 {
        self.a * (peak.force / self.reference_force).powf(self.m) * (-self.g * peak.void).exp()
    }

    fn shape(&self, cycles: f64) -> f64 {
        cycles.powf(self.b)
    }

    fn cycles(&self, shape: f64) -> f64 {
        shape.powf(1.0 / self.b)
    }

    fn order_is_free(&self) -> bool {
        true
    }
}
