//! A bed of grains as tables: one row for each pebble and one for each contact, with places inside the period.

use crate::solvers::granular::{Bed, ContactState, Domain, Party, Real, Snapshot};
use serde::{Deserialize, Serialize};

/// A pebble with what its body does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Grain {
    /// With the body's centroid in the period \[m\].
    pub place: [f64; 3],
    pub radius: f64,
    /// In the order of making.
    pub body: u32,
    /// Velocity of the pebble's centre, half a step ago \[m/s\].
    pub velocity: [f64; 3],
    /// Since the reference \[m\]; none without one.
    pub displacement: Option<[f64; 3]>,
    /// Number of other bodies that its body touches.
    pub coordination: u32,
    /// At any contact of its body, walls too \[N\].
    pub largest_force: f64,
}

/// A contact as a line from centroid to centroid, or from a centroid to a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Link {
    /// \[m\]
    pub from: [f64; 3],
    pub to: [f64; 3],
    /// Body of the first and, where it is not a wall, of the second.
    pub bodies: (u32, Option<u32>),
    /// On the first \[N\].
    pub force: [f64; 3],
    /// Unit vector from the second to the first.
    pub normal: [f64; 3],
    /// \[m\]
    pub overlap: f64,
}

impl Link {
    /// \[N\]
    pub fn size(&self) -> f64 {
        norm(self.force)
    }

    /// Above 0 if it pushes \[N\].
    pub fn normal_force(&self) -> f64 {
        (0..3).map(|c| self.force[c] * self.normal[c]).sum()
    }
}

pub(super) fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Places of all pebbles \[m\], to measure displacements from.
pub fn places<R: Real>(bed: &Bed<R>) -> Vec<[f64; 3]> {
    bed.pebbles().map(|pebble| pebble.place).collect()
}

/// Every pebble, body by body in the order of making. `snapshot` is of the same instant; `reference` holds the
/// [`places`] of an earlier one, and no displacement is given where it is none.
pub fn grains<R: Real>(bed: &Bed<R>, snapshot: &Snapshot, reference: Option<&[[f64; 3]]>) -> Vec<Grain> {
    let (coordination, largest) = (coordination(bed.len(), snapshot), largest_forces(bed.len(), snapshot));
    let states: Vec<_> = bed.states().collect();
    bed.pebbles()
        .enumerate()
        .map(|(number, pebble)| {
            let body = pebble.body.0 as usize;
            let state = &states[body];
            let shift = into_period(bed.domain(), state.place);
            let arm = [0, 1, 2].map(|c| pebble.place[c] - state.place[c]);
            let [a, b, c] = state.spin;
            let turning = [b * arm[2] - c * arm[1], c * arm[0] - a * arm[2], a * arm[1] - b * arm[0]];
            let from = reference.and_then(|places| places.get(number));
            Grain {
                place: [0, 1, 2].map(|c| pebble.place[c] + shift[c]),
                radius: pebble.radius,
                body: pebble.body.0,
                velocity: [0, 1, 2].map(|c| state.velocity[c] + turning[c]),
                displacement: from.map(|from| [0, 1, 2].map(|c| pebble.place[c] - from[c])),
                coordination: coordination[body],
                largest_force: largest[body],
            }
        })
        .collect()
}

/// Every contact of the snapshot, in its order; a line may leave the period on its far side.
pub fn links<R: Real>(bed: &Bed<R>, snapshot: &Snapshot) -> Vec<Link> {
    let link = |contact: &ContactState| {
        let Party::Body(first, _) = contact.first else { return None };
        let centre = bed.body_state(first).place;
        let shift = into_period(bed.domain(), centre);
        let from = [0, 1, 2].map(|c| centre[c] + shift[c]);
        Some(Link {
            from,
            to: [0, 1, 2].map(|c| from[c] - contact.branch[c]),
            bodies: (first.0, contact.second.body().map(|b| b.0)),
            force: contact.force,
            normal: contact.normal,
            overlap: contact.overlap,
        })
    };
    snapshot.contacts.iter().filter_map(link).collect()
}

/// Shift that brings a place back into the period \[m\].
fn into_period(domain: &Domain, place: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| domain.period(axis).map_or(0.0, |period| -period * (place[axis] / period).floor()))
}

fn coordination(bodies: usize, snapshot: &Snapshot) -> Vec<u32> {
    let pair = |c: &ContactState| Some((c.first.body()?.0, c.second.body()?.0));
    let mut pairs: Vec<(u32, u32)> =
        snapshot.contacts.iter().filter_map(pair).map(|(a, b)| (a.min(b), a.max(b))).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut counts = vec![0; bodies];
    for (a, b) in pairs {
        counts[a as usize] += 1;
        counts[b as usize] += 1;
    }
    counts
}

fn largest_forces(bodies: usize, snapshot: &Snapshot) -> Vec<f64> {
    let mut largest = vec![0.0f64; bodies];
    for contact in &snapshot.contacts {
        let force = norm(contact.force);
        for body in [contact.first, contact.second].iter().filter_map(Party::body) {
            let most = &mut largest[body.0 as usize];
            *most = most.max(force);
        }
    }
    largest
}
