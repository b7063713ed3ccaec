//! Inertia for a time step; each contact is shared between its two bodies by their need.
//!
//! For a spring between two bodies and any p1, p2 > 0, |u1 - u2|^2 <= (1 + p2/p1) |u1|^2 + (1 + p1/p2) |u2|^2. So a
//! step is stable for the whole network if it is stable for every body alone, with fixed neighbours and each contact
//! counted 1 + p2/p1 times. Here p is the utilisation of a body: the demand of its contacts divided by its limit. So a
//! light grain among heavy grains counts its contacts little more than once, and the heavy grains, which have a
//! reserve, count them more often. Counting twice for both bodies (`Bed::hold_time_step`) adds two to three times as
//! much mass for the same step.
//!
//! Sums run over the contacts of a body in the order of [`Incidence`](super::super::integrate::Incidence), which
//! depends only on the neighbours: the result is the same bits for any lists.

use super::super::bed::Bed;
use super::super::body::SPHERE;
use super::super::critical::{Link, Roots, reduced};
use super::super::entry::Entry;
use super::super::failure::Failure;
use super::super::force::Tangent;
use super::super::lanes::{BLOCK, Real};
use super::super::record::Record;
use super::super::vector::{Vec3, add, cross, dot, scale, sub};
use super::{CHUNK, Scaling, TOLERANCE};
use nalgebra::{Matrix3, Matrix6};
use rayon::prelude::*;

/// Limits of the utilisation p: at least the first share, at most the second, so that a weak body leaves a part to its
/// neighbours.
const SHARES: [f64; 2] = [1e-3, 0.7];
/// A bound below this is surely below 1, for any rounding.
const SURELY: f64 = 0.999;

/// Contributions of contacts to one body in a step of dt: sums of `a = dt^2 k + 2 dt c`, along the normal n and across,
/// at arms r. Symmetric tensors hold xx, yy, zz, xy, yz, zx.
#[derive(Default)]
struct Sums {
    /// a across.
    across: f64,
    /// n n', along minus across.
    along: Symmetric,
    /// r, across.
    arm: Vec3,
    /// (r x n) n', along minus across.
    mixed: [Vec3; 3],
    /// (r x d) (r x d)' over all directions d.
    turning: Symmetric,
}

type Symmetric = [f64; 6];

/// Contribution of a contact between two pebbles in a step of dt; 0 if they do not touch.
#[derive(Debug, Clone, Copy, Default)]
struct Spot {
    /// From the second pebble to the first.
    normal: [f32; 3],
    /// a along and across.
    along: f32,
    across: f32,
}

/// v v'.
#[inline(always)]
fn square([x, y, z]: Vec3) -> Symmetric {
    [x * x, y * y, z * z, x * y, y * z, z * x]
}

impl Sums {
    /// Adds a contact with these values along and across, at an arm.
    #[inline(always)]
    fn add(&mut self, normal: Vec3, arm: Vec3, along: f64, across: f64) {
        let along = along - across;
        let turn = cross(arm, normal);
        let (normals, arms, turns) = (square(normal), square(arm), square(turn));
        self.across += across;
        let length = arms[0] + arms[1] + arms[2];
        for c in 0..6 {
            let whole = if c < 3 { length } else { 0.0 };
            self.along[c] += along * normals[c];
            self.turning[c] += along * turns[c] + across * (whole - arms[c]);
        }
        for r in 0..3 {
            self.arm[r] += across * arm[r];
            for (mixed, part) in self.mixed[r].iter_mut().zip(normal) {
                *mixed += along * turn[r] * part;
            }
        }
    }

    /// Matrix on the six motions of the body, inertia scaled to one: a step is stable if no eigenvalue is above 4.
    fn matrix(&self, root: &Roots) -> Matrix6<f64> {
        let [xx, yy, zz, xy, yz, zx] = self.along;
        let [x, y, z] = self.arm;
        let m = &self.mixed;
        let moved = Matrix3::new(self.across + xx, xy, zx, xy, self.across + yy, yz, zx, yz, self.across + zz);
        let both = Matrix3::new(
            m[0][0],
            m[0][1] - z,
            m[0][2] + y,
            m[1][0] + z,
            m[1][1],
            m[1][2] - x,
            m[2][0] - y,
            m[2][1] + x,
            m[2][2],
        );
        let [xx, yy, zz, xy, yz, zx] = self.turning;
        let turned = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz);
        let (go, turn) = (root.translation, &root.rotation);
        let (moved, both, turned) = (moved * (go * go), turn * both * go, turn * turned * turn);
        Matrix6::from_fn(|r, c| match (r < 3, c < 3) {
            (true, true) => moved[(r, c)],
            (false, true) => both[(r - 3, c)],
            (true, false) => both[(c - 3, r)],
            (false, false) => turned[(r - 3, c - 3)],
        })
    }
}

/// An upper bound of the largest eigenvalue of a positive matrix: fourth root of the sum of the fourth powers of all
/// eigenvalues, at most 1.6 times as large.
pub(super) fn largest(whole: &Matrix6<f64>) -> f64 {
    let mut sum = 0.0;
    for r in 0..6 {
        for c in 0..=r {
            let product: f64 = (0..6).map(|k| whole[(k, r)] * whole[(k, c)]).sum();
            sum += if r == c { product * product } else { 2.0 * product * product };
        }
    }
    sum.sqrt().sqrt()
}

/// `dt^2 k + 2 dt c`, along and across.
fn in_step(tangent: &Tangent, step: f64) -> [f64; 2] {
    let of = |stiffness: f64, dashpot: f64| step * (step * stiffness + 2.0 * dashpot);
    [of(tangent.normal, tangent.normal_dashpot), of(tangent.shear, tangent.shear_dashpot)]
}

impl<R: Real> Bed<R> {
    /// Adds inertia until `target` \[s\] is a stable step for the present contacts, each shared between its bodies by
    /// their need. A body of a surface and a mass has at least `least` times that mass, independent of its contacts, so
    /// that it is prepared for contacts that form later. Inertia added before is removed.
    pub fn hold_time_step_by_need(
        &mut self,
        target: f64,
        least: impl Fn(u16, f64) -> f64 + Sync,
    ) -> Result<Scaling, Failure> {
        assert!(target.is_finite() && target > 0.0, "a time step is a positive time");
        self.unscale_masses();
        self.reach(0.0)?;
        // slightly more, so that rounding is on the safe side
        let acting = Acting::new(self, target * (1.0 + TOLERANCE));
        let places = (0..self.bodies.len()).into_par_iter().with_min_len(CHUNK);
        let loads: Vec<f64> = places.map(|place| largest(&acting.matrix(place, |_| 1.0)) / 4.0).collect();
        let share = |place: usize| loads[place].clamp(SHARES[0], SHARES[1]);
        let needed = |place: usize| {
            let own = share(place);
            let count = |other: u32| 1.0 + share(other as usize) / own;
            if acting.neighbours(place).map(count).fold(1.0, f64::max) * loads[place] < SURELY {
                return 1.0;
            }
            let whole = acting.matrix(place, count);
            if largest(&whole) < 4.0 * SURELY { 1.0 } else { whole.symmetric_eigenvalues().max() / 4.0 }
        };
        // in the order of memory, then by number: neighbours are in the cache
        let factor = |place: usize| {
            let body = &self.bodies[place];
            needed(place).max(least(body.surface, body.mass))
        };
        let places = (0..self.bodies.len()).into_par_iter().with_min_len(CHUNK);
        let found: Vec<f64> = places.map(factor).collect();
        let factors: Vec<f64> = self.index.iter().map(|place| found[*place as usize]).collect();
        Ok(self.weigh_down(&factors, target, target))
    }
}

/// The contributions of all contacts of a bed in a step.
pub(super) struct Acting<'a, R: Real> {
    bed: &'a Bed<R>,
    step: f64,
    /// By the index of contacts between pebbles.
    spots: Vec<Spot>,
}

impl<'a, R: Real> Acting<'a, R> {
    pub(super) fn new(bed: &'a Bed<R>, step: f64) -> Self {
        let places = (0..bed.contacts.len()).into_par_iter().with_min_len(CHUNK);
        Acting { bed, step, spots: places.map(|place| bed.spot(place, step)).collect() }
    }

    /// The contributions of the contacts of a body with fixed neighbours; `count` is the weight of a contact with
    /// another body.
    pub(super) fn matrix(&self, place: usize, count: impl Fn(u32) -> f64) -> Matrix6<f64> {
        let bed = self.bed;
        let body = &bed.bodies[place];
        let centre = (body.clump != SPHERE).then(|| bed.clumps[body.clump as usize].centre);
        let mut sums = Sums::default();
        let mut last = None;
        for pebble in body.first as usize..body.first as usize + usize::from(body.pebbles) {
            let radius = bed.records[pebble].radius();
            let offset = centre.map_or([0.0; 3], |centre| sub(bed.records[pebble].position(), centre));
            for &entry in bed.incidence.contacts_of(pebble) {
                let at = entry.place();
                let Some(&Spot { normal, along, across }) = self.spots.get(at) else {
                    let slot = at - self.spots.len();
                    if let Some(bond) = slot.checked_sub(bed.wall_contacts.slots.len()) {
                        self.add_bond(bond, body.id, &count, &mut sums);
                        continue;
                    }
                    // an entry has room for several contacts
                    let walled = bed.wall_contacts.entries.partition_point(|e| e.slots.1 as usize <= slot);
                    if last.replace(walled) != Some(walled) {
                        self.add_walled(walled, &mut sums);
                    }
                    continue;
                };
                if along == 0.0 && across == 0.0 {
                    continue;
                }
                let sign = if entry.is_second() { -1.0 } else { 1.0 };
                let normal = normal.map(|c| sign * f64::from(c));
                let share = count(bed.other(entry));
                // an overlap is a hundred thousandth of a radius
                let arm = sub(offset, scale(normal, radius));
                sums.add(normal, arm, share * f64::from(along), share * f64::from(across));
            }
        }
        sums.matrix(&bed.root(body))
    }

    fn add_walled(&self, entry: usize, sums: &mut Sums) {
        let mut links: Vec<Link> = Vec::new();
        self.bed.walled(entry, 0.0, &mut links);
        for Link { normal, arms, tangent, .. } in links {
            let [along, across] = in_step(&tangent, self.step);
            sums.add(normal, arms[0], along, across);
        }
    }

    fn add_bond(&self, place: usize, body: u32, count: &impl Fn(u32) -> f64, sums: &mut Sums) {
        let Some(Link { bodies, normal, arms, tangent, .. }) = self.bed.bond_link(place) else { return };
        let end = usize::from(bodies[0] != body);
        let share = count(self.bed.index[bodies[1 - end] as usize]);
        let [along, across] = in_step(&tangent, self.step);
        sums.add(normal, arms[end], share * along, share * across);
    }

    /// Indices of the bodies listed near a body.
    fn neighbours(&self, place: usize) -> impl Iterator<Item = u32> {
        let body = &self.bed.bodies[place];
        let pebbles = body.first as usize..body.first as usize + usize::from(body.pebbles);
        let entries = pebbles.flat_map(|pebble| self.bed.incidence.contacts_of(pebble));
        entries.filter(|entry| entry.place() < self.spots.len()).map(|entry| self.bed.other(*entry))
    }
}

impl<R: Real> Bed<R> {
    /// Index of the other body of a contact between two bodies.
    fn other(&self, entry: Entry) -> u32 {
        let pebbles = if entry.is_second() { &self.contacts.first } else { &self.contacts.second };
        self.owner[pebbles[entry.place()] as usize]
    }

    #[inline(always)]
    fn spot(&self, place: usize, step: f64) -> Spot {
        let (a, b) = (self.contacts.first[place] as usize, self.contacts.second[place] as usize);
        let (one, other) = (&self.records[a], &self.records[b]);
        let apart = add(sub(one.position(), other.position()), self.domain.shift(self.contacts.image[place]));
        let reach = one.radius() + other.radius();
        let square = dot(apart, apart);
        if square >= reach * reach {
            return Spot::default();
        }
        let distance = square.sqrt();
        let law = &self.laws.all()[usize::from(self.contacts.law[place / BLOCK])];
        let mass = reduced(one.mass().to_f64(), other.mass().to_f64());
        let radius = reduced(one.radius(), other.radius());
        let tangent = Tangent::from_law(law, reach - distance, mass, radius);
        let [along, across] = in_step(&tangent, step).map(|a| a as f32);
        Spot { normal: scale(apart, 1.0 / distance).map(|c| c as f32), along, across }
    }
}
