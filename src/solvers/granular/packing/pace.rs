//! The time step while grains are rearranged: the stable step of a mean grain. Lighter grains get additional inertia,
//! but no additional weight; forces at rest do not depend on inertia.

use super::super::bed::{Bed, BodyState};
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::recipe::Recipe;

/// The step divided by sqrt(m / k) of a mean grain.
const PACE: f64 = 0.6;
/// Stable step of a body in a dense bed, divided by its sqrt(m / k): without friction, and with shear springs that
/// rotate it.
const BEARABLE: f64 = 0.75;
const WITH_FRICTION: f64 = 0.3;
/// Factor on the stable step after a pace that was too fast, and the limit at which packing fails.
const TIGHTER: f64 = 0.7;
const LEAST_BEARABLE: f64 = 0.1;
/// Share of the stable step that is taken.
pub(super) const SAFE: f64 = 0.8;

pub(super) struct Pace {
    /// s.
    step: f64,
    /// Stable step of a body divided by sqrt(m / k).
    bearable: f64,
    /// Stiffness of contacts between grains of each layer, N/m.
    stiffness: Vec<f64>,
}

impl Pace {
    pub fn without_friction(recipe: &Recipe) -> Pace {
        Pace { step: PACE * recipe.mean_step(), bearable: BEARABLE, stiffness: recipe.stiffness() }
    }

    /// For beds with friction and without dashpots between grains.
    pub fn with_friction(recipe: &Recipe) -> Pace {
        Pace { bearable: WITH_FRICTION, ..Pace::without_friction(recipe) }
    }

    /// Runs some steps at this pace. New contacts may make the step unstable for a light body; then these steps are
    /// repeated with more inertia, and all following steps use it, too.
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
