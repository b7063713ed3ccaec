//! Forces on each body from contacts and weight (Eq. 2 of the paper), and the force out of balance of a bed.

use crate::solvers::granular::bed::Bed;
use crate::solvers::granular::lanes::Real;
use crate::solvers::granular::snapshot::Snapshot;
use crate::solvers::granular::vector::{Vec3, add, norm, scale};

/// Forces on a body at an instant. Local damping is not a contact force and is not included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceBalance {
    /// Sum of contact forces and weight, N.
    pub net: Vec3,
    /// Sum of their magnitudes, N.
    pub acting: f64,
}

/// Forces on all bodies in the order of creation. `snapshot` must be a snapshot of the present state of this bed.
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

/// Mean force out of balance on a body divided by the mean sum of the acting forces: PFC's average ratio. 0 at perfect
/// rest, 1 in free fall. Held bodies do not count.
pub fn unbalance<R: Real>(bed: &Bed<R>, snapshot: &Snapshot) -> f64 {
    let mut forces = balance(bed, snapshot);
    let mut moves = bed.index.iter().map(|&place| bed.bodies[place as usize].inverse_mass > 0.0);
    forces.retain(|_| moves.next() == Some(true));
    let out: f64 = forces.iter().map(|force| norm(force.net)).sum();
    let all: f64 = forces.iter().map(|force| force.acting).sum();
    if all > 0.0 { out / all } else { 0.0 }
}
