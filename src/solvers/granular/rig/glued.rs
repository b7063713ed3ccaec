//! Parts of a bed that are glued, as binders are sprayed on ballast: what touches there, once everything is at rest.

use super::super::bed::Bed;
use super::super::bonds::Glue;
use super::super::failure::Failure;
use super::super::lanes::Real;
use super::super::snapshot::{ContactState, Party};
use serde::{Deserialize, Serialize};

/// Grains of one layer that are glued where they touch each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Glued {
    /// Surface of the grains: the number of their layer from the floor upwards.
    pub surface: u16,
    /// Between which places along the bed, m; `None` glues all of it.
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

/// Glues parts of a bed, and gives how many bonds that makes.
pub fn glue<R: Real>(bed: &mut Bed<R>, parts: &[Glued]) -> Result<usize, Failure> {
    if parts.is_empty() {
        return Ok(0);
    }
    let surfaces: Vec<u16> = bed.states().map(|state| state.surface).collect();
    let glues = parts.iter().map(|part| part.glue).collect();
    let which = |contact: &ContactState| parts.iter().position(|part| part.holds(contact, &surfaces));
    bed.glue(glues, |contact| which(contact).map(|part| part as u16))
}
