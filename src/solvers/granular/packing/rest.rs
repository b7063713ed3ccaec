//! When a bed is at rest: by the forces that are out of balance, not by a count of steps.

use super::super::bed::Bed;
use super::super::lanes::Real;
use super::super::snapshot::Snapshot;
use super::super::vector::{Vec3, add, norm, scale};

/// Mean of what is out of balance on a body over the mean of the sum of what acts on it, contacts and weight: PFC's average
/// ratio. 0 in perfect rest, about 1 in free fall.
pub(in super::super) fn unbalance<R: Real>(bed: &Bed<R>, snapshot: &Snapshot) -> f64 {
    let gravity = bed.gravity.at(bed.time);
    let mut net: Vec<Vec3> = Vec::with_capacity(bed.len());
    let mut acting: Vec<f64> = Vec::with_capacity(bed.len());
    for state in bed.states() {
        let weight = scale(gravity, state.mass);
        net.push(weight);
        acting.push(norm(weight));
    }
    for contact in &snapshot.contacts {
        for (party, side) in [(contact.first, 1.0), (contact.second, -1.0)] {
            let Some(body) = party.body() else { continue };
            let body = body.0 as usize;
            net[body] = add(net[body], scale(contact.force, side));
            acting[body] += norm(contact.force);
        }
    }
    let (out, all) = (net.iter().map(|force| norm(*force)).sum::<f64>(), acting.iter().sum::<f64>());
    if all > 0.0 { out / all } else { 0.0 }
}
