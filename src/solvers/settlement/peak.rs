//! The loading of a support by one wheel.

use serde::{Deserialize, Serialize};

/// The largest loading of a support while one wheel passes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Peak {
    /// Contact force of the half sleeper on its support, N.
    pub force: f64,
    /// Largest displacement of the support under the sleeper below its unloaded level, m.
    pub deflection: f64,
    /// Gap between the sleeper and its support before the wheel came, m.
    pub void: f64,
}

impl Peak {
    /// The larger force, the larger deflection and the larger void of both.
    pub fn max(self, other: Peak) -> Peak {
        Peak {
            force: self.force.max(other.force),
            deflection: self.deflection.max(other.deflection),
            void: self.void.max(other.void),
        }
    }

    /// A peak between this one (0) and another one (1).
    pub fn towards(self, end: Peak, share: f64) -> Peak {
        let between = |a: f64, b: f64| a + share * (b - a);
        Peak {
            force: between(self.force, end.force),
            deflection: between(self.deflection, end.deflection),
            void: between(self.void, end.void),
        }
    }

    /// The same peak with the change of another one added, never below 0.
    pub fn followed(self, from: Peak, to: Peak) -> Peak {
        Peak {
            force: (self.force + (to.force - from.force)).max(0.0),
            deflection: (self.deflection + (to.deflection - from.deflection)).max(0.0),
            void: (self.void + (to.void - from.void)).max(0.0),
        }
    }

    /// The same peak multiplied by a factor, for a linear support.
    pub fn scaled(self, factor: f64) -> Peak {
        Peak { force: self.force * factor, deflection: self.deflection * factor, ..self }
    }
}
