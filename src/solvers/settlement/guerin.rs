//! Settlement by Guérin (1996): every cycle adds `α (d/d₀)^β` for the elastic deflection d of the support, without
//! limit.

use serde::{Deserialize, Serialize};

/// The parameters of the law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Guerin {
    /// Settlement per cycle at the reference deflection, m.
    pub alpha: f64,
    /// Exponent of the deflection.
    pub beta: f64,
    /// d₀, m.
    pub reference_deflection: f64,
}

impl Default for Guerin {
    /// Constants as commonly quoted, for deflections in mm.
    fn default() -> Self {
        Self { alpha: 1.44e-9, beta: 2.51, reference_deflection: 1e-3 }
    }
}

impl Guerin {
    /// Settlement of one cycle of elastic deflection `deflection` (m), m.
    pub(super) fn of_cycle(&self, deflection: f64) -> f64 {
        if deflection > 0.0 { self.alpha * (deflection / self.reference_deflection).powf(self.beta) } else { 0.0 }
    }
}
