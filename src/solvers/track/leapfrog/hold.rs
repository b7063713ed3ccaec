//! Mass that keeps carried feet stable on contacts that are explicit in time.
//!
//! The underside of a pad weighs some kilograms, and the contacts of the ground on it may need more (`Limit` in the
//! module above):
//!
//! ```text
//! 4/Δt² m > k + 4 c/Δt,    so  m > ¼ k Δt² + c Δt
//! ```
//!
//! A grain on the other side moves too: of two equal masses each needs twice as much.

use super::{Leapfrog, damping, factor};
use crate::linalg::banded::SymmetricBanded;
use crate::solvers::track::ends;
use crate::solvers::track::error::TrackError;
use crate::solvers::track::mesh::Track;

/// Mass of an underside / the mass at the limit: what it must have, and what it gets, so that a few more contacts do
/// not change it again.
const MUST: f64 = 2.0;
const GETS: f64 = 3.0;

/// M with the mass added to the undersides of carried feet, kg.
pub(super) fn mass(track: &Track, added: &[f64]) -> SymmetricBanded {
    let mut mass = track.mass.clone();
    ends::add_mass(track, &mut mass);
    track.carried.iter().zip(added).for_each(|(foot, added)| mass.add(foot.underside, foot.underside, *added));
    mass
}

impl Leapfrog {
    /// Adds mass to the underside of the i-th carried foot where the contacts of the ground on it, with stiffnesses
    /// (N/m) and dampers (N s/m) that add up to these, need more at this step. Fails if the track is a mechanism.
    pub fn hold(&mut self, i: usize, stiffness: f64, dampers: f64) -> Result<(), TrackError> {
        let underside = self.track.carried[i].underside;
        let limit = self.time_step * (0.25 * self.time_step * stiffness + dampers);
        let now = self.mass.get(underside, underside);
        if now >= MUST * limit {
            return Ok(());
        }
        self.state.added[i] += GETS * limit - now;
        self.weigh()
    }

    /// Mass added to the undersides of all carried feet, kg.
    pub fn added_mass(&self) -> f64 {
        self.state.added.iter().sum()
    }

    /// Takes over the masses of the state.
    pub(super) fn weigh(&mut self) -> Result<(), TrackError> {
        let mass = mass(&self.track, &self.state.added);
        if mass != self.mass {
            self.damping = damping(&self.track, &mass, self.drag);
            self.factor = factor(&self.track, &mass, &self.stiffness, &self.damping, self.time_step)?;
            self.mass = mass;
        }
        Ok(())
    }
}
