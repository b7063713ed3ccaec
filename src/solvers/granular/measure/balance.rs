//! What acts on each body, from contacts and weight: the paper's Eq. 2, and how far a bed is from rest.

use crate::solvers::granular::bed::Bed;
use crate::solvers::granular::lanes::Real;
use crate::solvers::granular::snapshot::Snapshot;
use crate::solvers::granular::vector::{Vec3, add, norm, scale};

/// Forces on a body at an instant. Local damping is no force of a contact and is not in them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceBalance {
    /// Sum of contact forces and weight, N.
    pub net: Vec3,
    /// Sum of their magnitudes, N.
    pub acting: f64,
}

/// Forces on all bodies in the order of making. The snapshot is one of this bed, of now.
pub fn balance<R: Real>(bed: &Bed<R>, snapshot: &Snapshot) -> Vec<ForceBalance> {
    let gravity = bed.gravity.value_at(bed.time);
    let at_weight = |mass| ForceBalance { net: scale(gravity, mass), acting: norm(scale(gravity, mass)) };
    let mut all: Vec<ForceBalance> = bed.states().map(|state| at_weight(state.mass)).collect();
    for contact in &snapshot.contacts {
        for (party, side) in [(contact.first, 1.0), (contact.second, -1.0)] {
            let Some(body) = party.body() else { continue };
            let body = &mut all[body.0 as usize];
            body.net = add(body.net, scale(contact.force, side));
            body.acting += norm(contact.force);
        }
    }
    all
}

/// Mean of what is out of balance on a body over the mean of the sum of what acts on it: PFC's average ratio. 0 in perfect
/// rest, 1 in free fall. Bodies that are held do not count.
pub fn unbalance<R: Real>(bed: &Bed<R>, snapshot: &Snapshot) -> f64 {
    let mut forces = balance(bed, snapshot);
    let mut moves = bed.index.iter().map(|&place| bed.bodies[place as usize].inverse_mass > 0.0);
    forces.retain(|_| moves.next() == Some(true));
    let out: f64 = forces.iter().map(|force| norm(force.net)).sum();
    let all: f64 = forces.iter().map(|force| force.acting).sum();
    if all > 0.0 { out / all } else { 0.0 }
}
