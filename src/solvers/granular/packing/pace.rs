//! The step while grains look for their places: that of a mean grain. Lighter ones are given more inertia, and no more weight;
//! forces at rest do not know inertia.

use super::super::bed::{Bed, BodyState};
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::recipe::Recipe;

/// The step over sqrt(m / k) of a mean grain.
const PACE: f64 = 0.6;
/// Times sqrt(m / k) of itself, a body in a dense bed bears such a step: without friction, and with springs in shear that turn it.
const BEARABLE: f64 = 0.75;
const WITH_FRICTION: f64 = 0.3;
/// By how much a pace that was too fast bears less, and what is no pace any more.
const TIGHTER: f64 = 0.7;
const LEAST_BEARABLE: f64 = 0.1;
/// Share of the stable step that is taken.
pub(super) const SAFE: f64 = 0.8;

pub(super) struct Pace {
    /// s.
    step: f64,
    /// What a body bears, over sqrt(m / k).
    bearable: f64,
    /// Stiffness of contacts between grains of each layer, N/m.
    stiffness: Vec<f64>,
}

impl Pace {
    pub fn without_friction(recipe: &Recipe) -> Pace {
        Pace { step: PACE * recipe.mean_step(), bearable: BEARABLE, stiffness: recipe.stiffness() }
    }

    /// For beds with friction, and without dashpots between grains.
    pub fn with_friction(recipe: &Recipe) -> Pace {
        Pace { bearable: WITH_FRICTION, ..Pace::without_friction(recipe) }
    }

    /// Some steps at this pace. Contacts that form on the way may be more than a light body bears: then these steps are taken again
    /// with more inertia, as are all that follow.
    pub fn run<R: Real>(&mut self, bed: &mut Bed<R>, steps: u64) -> Result<(), Failure> {
        let before = bed.clone();
        loop {
            self.hold(bed)?;
            match bed.run(steps) {
                Ok(()) => return Ok(()),
                Err(failure) if self.bearable * TIGHTER < LEAST_BEARABLE => return Err(failure),
                Err(_) => self.bearable *= TIGHTER,
            }
            bed.clone_from(&before);
        }
    }

    /// Prepares a bed for some steps at this pace.
    pub fn hold<R: Real>(&self, bed: &mut Bed<R>) -> Result<(), Failure> {
        let root = self.bearable / self.step;
        let least = |body: &BodyState| self.stiffness[usize::from(body.surface)] / (root * root * body.mass);
        bed.hold_time_step(self.step / SAFE, least)?;
        bed.set_time_step(self.step);
        Ok(())
    }
}
