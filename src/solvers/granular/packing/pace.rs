//! The step while grains look for their places: that of a mean grain. Lighter ones are given more inertia, and no more weight;
//! forces at rest do not know inertia.

use super::super::bed::{Bed, BodyState};
use super::super::lanes::Real;
use super::super::watch::Failure;
use super::Recipe;

/// The step over sqrt(m / k) of a mean grain.
const PACE: f64 = 0.6;
/// Times sqrt(m / k) of itself, a body in a dense bed bears such a step.
const BEARABLE: f64 = 0.75;
/// Share of the stable step that is taken.
pub(super) const SAFE: f64 = 0.8;

pub(super) struct Pace {
    /// s.
    step: f64,
    /// Of contacts between grains of each layer, N/m.
    stiffness: Vec<f64>,
}

impl Pace {
    pub fn of(recipe: &Recipe) -> Pace {
        Pace { step: PACE * recipe.mean_step(), stiffness: recipe.stiffness() }
    }

    /// Prepares a bed for some steps at this pace.
    pub fn hold<R: Real>(&self, bed: &mut Bed<R>) -> Result<(), Failure> {
        let root = BEARABLE / self.step;
        let least = |body: &BodyState| self.stiffness[usize::from(body.surface)] / (root * root * body.mass);
        bed.hold_time_step(self.step / SAFE, least)?;
        bed.set_time_step(self.step);
        Ok(())
    }
}
