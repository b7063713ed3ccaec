//! Settlement by Hettler (1984): `S = s (F/F₀)^1.6 (1 + C log N)`.
//!
//! Publications that quote the law differ in the base of the logarithm, natural or decimal, which is a factor of 2.3 in
//! C: the base is a parameter. Between 0 and 1 cycles the law is not defined; settlement is assumed to grow linearly.

use super::hardening::Growth;
use super::peak::Peak;
use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Hettler {
    /// Settlement of the first cycle of the reference force, m.
    pub s: f64,
    /// C: settlement added by each e-fold or decade of cycles, as a share of the first cycle. Above 0.
    pub c: f64,
    /// Exponent of the force.
    pub exponent: f64,
    /// F₀, N.
    pub reference_force: f64,
    pub logarithm: Logarithm,
}

/// The base of the logarithm of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Logarithm {
    Natural,
    Decimal,
}

impl Default for Hettler {
    /// Constants as commonly quoted: 0.00095 mm at 1 kN.
    fn default() -> Self {
        Self { s: 0.95e-6, c: 0.43, exponent: 1.6, reference_force: 1e3, logarithm: Logarithm::Natural }
    }
}

impl Hettler {
    /// C for the natural logarithm.
    fn per_e_fold(&self) -> f64 {
        match self.logarithm {
            Logarithm::Natural => self.c,
            Logarithm::Decimal => self.c / std::f64::consts::LN_10,
        }
    }
}

impl Growth for Hettler {
    fn amplitude(&self, peak: Peak) -> f64 {
        self.s * (peak.force / self.reference_force).powf(self.exponent)
    }

    fn shape(&self, cycles: f64) -> f64 {
        if cycles < 1.0 { cycles } else { 1.0 + self.per_e_fold() * cycles.ln() }
    }

    fn cycles(&self, shape: f64) -> f64 {
        if shape < 1.0 { shape } else { ((shape - 1.0) / self.per_e_fold()).exp() }
    }
}
