//! Glued parts of a bed, for example with a binder sprayed on ballast: contacts are glued after the bed is at rest.

use super::super::bed::Bed;
use super::super::bonds::Glue;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::snapshot::{ContactState, Party};
use serde::{Deserialize, Serialize};

/// Grains of one layer that are glued at their contacts with each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Glued {
    /// Surface of the grains: the number of their layer from the floor upwards.
    pub surface: u16,
    /// Start and end along the bed, m; `None` glues the whole length.
    pub along: Option<[f64; 2]>,
    pub glue: Glue,
}

impl Glued {
    fn holds(&self, contact: &ContactState, surfaces: &[u16]) -> bool {
        let of = |party: Party| party.body().is_some_and(|body| surfaces[body.0 as usize] == self.surface);
        let inside = self.along.is_none_or(|[from, to]| (from..to).contains(&contact.point[0]));
        inside && of(contact.first) && of(contact.second)
    }
}

/// Glues parts of a bed, and returns the number of bonds.
pub fn glue<R: Real>(bed: &mut Bed<R>, parts: &[Glued]) -> Result<usize, Failure> {
    if parts.is_empty() {
        return Ok(0);
    }
    let surfaces: Vec<u16> = bed.states().map(|state| state.surface).collect();
    let glues = parts.iter().map(|part| part.glue).collect();
    let which = |contact: &ContactState| parts.iter().position(|part| part.holds(contact, &surfaces));
    bed.glue(glues, |contact| which(contact).map(|part| part as u16))
}
