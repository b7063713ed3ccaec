//! Beds of grains under a track, as they lie at the recorded counts: a section along the rail seats, or all of them.
//!
//! Places are chainage, the distance from the centre line and the height above the undersides of the sleepers as built.
//! All numbers are those of single precision, as in the files.

use super::grains::norm;
use super::{Grain, Link, grains, links, places};
use crate::nodes::BedUnderTrack;
use serde::{Deserialize, Serialize};

/// Thickness of the section, in mean diameters of a pebble.
const THICK: f64 = 3.0;
/// Share of the mean force below which a contact of the section is left out.
const WEAK: f64 = 0.1;

/// The beds of grains under a track at an axle count.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BedsAtCount {
    pub axles: u64,
    /// Whether the leading bogie of the next train stands on the bed; otherwise without a train.
    pub under_train: bool,
    /// Displacements count from the first recorded count.
    pub grains: Vec<Grain>,
    pub links: Vec<Link>,
}

/// The part of the beds that is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Part {
    All,
    /// About a line so far from the centre line, m.
    AlongSeats(f64),
}

/// Places of all pebbles of all beds, m: what displacements count from.
pub(super) type Reference = Vec<Vec<[f64; 3]>>;

pub(super) fn reference(beds: &[BedUnderTrack<'_>]) -> Reference {
    beds.iter().map(|bed| places(bed.bed)).collect()
}

/// The beds as they lie now. Bodies are numbered through all beds.
pub(super) fn beds_at_count(
    (axles, under_train): (u64, bool),
    beds: &[BedUnderTrack<'_>],
    reference: &Reference,
    part: Part,
) -> BedsAtCount {
    let mut all = BedsAtCount { axles, under_train, ..BedsAtCount::default() };
    let mut first = 0;
    for (bed, from) in beds.iter().zip(reference) {
        let moved = |place: [f64; 3]| [place[0] + bed.start, place[1], place[2] - bed.top];
        all.grains.extend(grains(bed.bed, &bed.snapshot, Some(from)).into_iter().map(|grain| Grain {
            place: moved(grain.place),
            body: grain.body + first,
            ..grain
        }));
        all.links.extend(links(bed.bed, &bed.snapshot).into_iter().map(|link| Link {
            from: moved(link.from),
            to: moved(link.to),
            bodies: (link.bodies.0 + first, link.bodies.1.map(|body| body + first)),
            ..link
        }));
        first += bed.bed.len() as u32;
    }
    let mut kept = match part {
        Part::All => all,
        Part::AlongSeats(y) => all.along_seats(y),
    };
    kept.round();
    kept
}

impl BedsAtCount {
    /// The section about a line at this distance from the centre line (m), without the weakest contacts.
    pub fn along_seats(mut self, y: f64) -> BedsAtCount {
        let mean = self.grains.iter().map(|grain| grain.radius).sum::<f64>() / self.grains.len().max(1) as f64;
        let half = THICK * mean;
        let inside = |across: f64| (across - y).abs() <= half;
        self.grains.retain(|grain| inside(grain.place[1]));
        self.links.retain(|link| inside(0.5 * (link.from[1] + link.to[1])));
        let weakest = WEAK * self.mean_force();
        self.links.retain(|link| link.size() >= weakest);
        self
    }

    /// To single precision.
    fn round(&mut self) {
        let short = |value: &mut f64| *value = f64::from(*value as f32);
        for grain in &mut self.grains {
            let moved = grain.displacement.iter_mut().flatten();
            grain.place.iter_mut().chain(&mut grain.velocity).chain(moved).for_each(short);
            [&mut grain.radius, &mut grain.largest_force].into_iter().for_each(short);
        }
        for link in &mut self.links {
            let Link { from, to, force, normal, overlap, .. } = link;
            [from, to, force, normal].into_iter().flatten().for_each(short);
            short(overlap);
        }
    }

    /// Mean of the forces of its contacts, N.
    fn mean_force(&self) -> f64 {
        self.links.iter().map(|link| norm(link.force)).sum::<f64>() / self.links.len().max(1) as f64
    }
}
