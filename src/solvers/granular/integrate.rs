//! The equation of motion of every body: contact forces in a fixed order, damping, leapfrog (methods 4.2, pass 2).

use super::body::{Arm, Body, Clump, SPHERE};
use super::force::Outcome;
use super::incidence::{Felt, Incidence};
use super::lanes::{BLOCK, Fine, FineVector, Lanes, NOWHERE, Real, Work};
use super::prefetch::prefetch;
use super::rotation;
use super::tasks::Task;
use super::vector::{Vec3, dot};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Parameters that drive a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drive {
    /// Time over which velocities advance \[s\]: half a step in the first step.
    pub kick: f64,
    /// Time over which positions advance \[s\].
    pub dt: f64,
    pub gravity: Vec3,
    /// Local damping (Cundall).
    pub damping: f64,
    pub watched: bool,
}

/// Results of a step over its bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Tally {
    /// Largest squared speed of a pebble \[m2/s2\], and the index of its body in the bed.
    pub fastest: (f64, u32),
    /// A body whose motion is not a finite number.
    pub lost: Option<u32>,
    /// Kinetic energies at the time of the forces \[J\].
    pub translation: f64,
    pub rotation: f64,
    /// Work done in this step \[J\].
    pub gravity: f64,
    /// Energy lost to local damping in this step \[J\].
    pub damping: f64,
}

impl Tally {
    pub fn and(mut self, other: Tally) -> Tally {
        if other.fastest.0 > self.fastest.0 {
            self.fastest = other.fastest;
        }
        self.lost = self.lost.or(other.lost);
        self.translation += other.translation;
        self.rotation += other.rotation;
        self.gravity += other.gravity;
        self.damping += other.damping;
        self
    }
}

/// Data of the bodies of some tasks, from their first body on.
pub(super) struct Moving<'a, R: Real> {
    pub bodies: &'a mut [Body],
    pub records: &'a mut [R::Record],
    pub clumps: &'a mut [Clump],
    pub arms: &'a [Arm],
}

/// Bodies and pebbles of one task.
struct Share<'a, R: Real> {
    /// Number of the first body among all, for the results; the first pebble and the first clump.
    at: Task,
    moving: Moving<'a, R>,
    forces: Forces<'a, R>,
    drive: &'a Drive,
}

/// Forces on the pebbles of a task.
enum Forces<'a, R: Real> {
    /// Those of the contacts of its groups.
    OfContacts {
        acting: Acting<'a, R>,
        groups: Range<u32>,
    },
    Known(&'a [Felt]),
}

/// Contacts, and their forces on the bodies.
pub(super) struct Acting<'a, R: Real> {
    pub incidence: &'a Incidence,
    pub outcomes: &'a [Outcome<R>],
}

impl<R: Real> Clone for Acting<'_, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Real> Copy for Acting<'_, R> {}

/// What all pebbles of `tasks` feel, in their order.
pub(super) fn felt<R: Real>(tasks: &[Task], acting: Acting<R>) -> Vec<Felt> {
    let pebbles = |(task, next): (&Task, &Task)| {
        R::dispatch(Summing { acting, groups: task.group..next.group, count: (next.pebble - task.pebble) as usize })
    };
    tasks.iter().zip(&tasks[1..]).flat_map(pebbles).collect()
}

/// The sums of a task alone.
struct Summing<'a, R: Real> {
    acting: Acting<'a, R>,
    groups: Range<u32>,
    count: usize,
}

impl<R: Real> Work<R> for Summing<'_, R> {
    type Output = Vec<Felt>;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self, lanes: L) -> Vec<Felt> {
        self.acting.incidence.felt(lanes, (self.groups, self.count), self.acting.outcomes)
    }
}

/// Moves one body by one step under known forces.
pub(super) fn advance_alone<R: Real>(moving: Moving<R>, at: Task, felt: &[Felt], drive: &Drive) -> Tally {
    R::dispatch(Share { at, moving, forces: Forces::Known(felt), drive })
}

/// Moves the bodies of `tasks` by one step under the forces of their contacts; one result per task.
pub(super) fn advance<R: Real>(moving: Moving<R>, tasks: &[Task], acting: Acting<R>, drive: &Drive) -> Vec<Tally> {
    let Moving { mut bodies, mut records, mut clumps, arms } = moving;
    let mut shares = Vec::with_capacity(tasks.len());
    for (task, next) in tasks.iter().zip(&tasks[1..]) {
        let (some_bodies, rest_bodies) = bodies.split_at_mut((next.body - task.body) as usize);
        let (some_records, rest_records) = records.split_at_mut((next.pebble - task.pebble) as usize);
        let (some_clumps, rest_clumps) = clumps.split_at_mut((next.clump - task.clump) as usize);
        let moving = Moving { bodies: some_bodies, records: some_records, clumps: some_clumps, arms };
        let forces = Forces::OfContacts { acting, groups: task.group..next.group };
        shares.push(Share { at: *task, moving, forces, drive });
        (bodies, records, clumps) = (rest_bodies, rest_records, rest_clumps);
    }
    shares.into_par_iter().map(R::dispatch).collect()
}

impl<R: Real> Work<R> for Share<'_, R> {
    type Output = Tally;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self, lanes: L) -> Tally {
        let count = self.moving.bodies.len();
        let summed;
        let felt = match &self.forces {
            Forces::Known(felt) => *felt,
            Forces::OfContacts { acting: Acting { incidence, outcomes }, groups } => {
                summed = incidence.felt(lanes, (groups.clone(), self.moving.records.len()), outcomes);
                &summed
            }
        };
        let mut told = Told { speeds: vec![0.0; count], spent: Vec::new() };
        if self.drive.watched {
            told.spent = vec![[0.0; SPENT]; count];
        }
        // bodies of a kind move together, as many as there are lanes; the remaining bodies at the end move last
        let (mut spheres, mut composed) = (Batch::default(), Batch::default());
        let mut clump = 0;
        for body in 0..count {
            let kind = &self.moving.bodies[body];
            let pebble = (kind.first - self.at.pebble) as usize;
            let pebbles = usize::from(kind.pebbles);
            ask_for(self.moving.bodies, body + AHEAD);
            if kind.clump == SPHERE {
                spheres.put(Member { body, pebble, pebbles, clump: 0 });
                if spheres.count == L::WIDTH {
                    self.spheres(lanes, &spheres, felt, &mut told);
                    spheres.count = 0;
                }
            } else {
                composed.put(Member { body, pebble, pebbles, clump });
                clump += 1;
                if composed.count == L::WIDTH {
                    self.composed(lanes, &composed, felt, &mut told);
                    composed.count = 0;
                }
            }
        }
        if spheres.count > 0 {
            self.spheres(lanes, &spheres, felt, &mut told);
        }
        if composed.count > 0 {
            self.composed(lanes, &composed, felt, &mut told);
        }
        told.sum_up(self.at.body)
    }
}

/// Number of bodies between the prefetched body and the body in work.
const AHEAD: usize = 32;

/// Prefetches a body that will move soon; each body lies in two cache lines.
#[inline(always)]
fn ask_for(bodies: &[Body], place: usize) {
    if let Some(body) = bodies.get(place) {
        prefetch(&body.velocity);
        prefetch(&body.id);
    }
}

/// A body of a task.
#[derive(Debug, Clone, Copy, Default)]
struct Member {
    body: usize,
    pebble: usize,
    pebbles: usize,
    clump: usize,
}

/// Bodies that move together, one per lane.
#[derive(Default)]
struct Batch {
    members: [Member; BLOCK],
    count: usize,
}

impl Batch {
    #[inline(always)]
    fn put(&mut self, member: Member) {
        self.members[self.count] = member;
        self.count += 1;
    }

    #[inline(always)]
    fn members(&self) -> &[Member] {
        &self.members[..self.count]
    }
}

/// Energies of a body in a step: translation, rotation, work of gravity, losses to damping of translation and of
/// rotation.
const SPENT: usize = 5;

/// Results of the bodies of a task, in their order, so that sums do not depend on the lanes.
struct Told {
    /// Largest squared speed of a pebble.
    speeds: Vec<f64>,
    spent: Vec<[f64; SPENT]>,
}

impl Told {
    #[inline(always)]
    fn speeds<L: Lanes>(&mut self, batch: &Batch, speeds: Fine<L>) {
        let column = column(speeds);
        for (l, member) in batch.members().iter().enumerate() {
            self.speeds[member.body] = column[l];
        }
    }

    /// Bodies with inverse mass 0 keep their velocity and are not in the energy account.
    #[inline(always)]
    fn spent<L: Lanes>(&mut self, batch: &Batch, inverse: Fine<L>, spent: [Fine<L>; SPENT]) {
        let inverse = column(inverse);
        for (kind, energies) in spent.into_iter().enumerate() {
            let energies = column(energies);
            for (l, member) in batch.members().iter().enumerate() {
                if inverse[l] > 0.0 {
                    self.spent[member.body][kind] = energies[l];
                }
            }
        }
    }

    #[inline(always)]
    fn sum_up(self, first: u32) -> Tally {
        let mut tally = Tally::default();
        for (place, &speed) in (first..).zip(&self.speeds) {
            if !speed.is_finite() {
                tally.lost = tally.lost.or(Some(place));
            } else if speed > tally.fastest.0 {
                tally.fastest = (speed, place);
            }
        }
        for &[translation, rotation, gravity, damping, turning] in &self.spent {
            tally.translation += translation;
            tally.rotation += rotation;
            tally.gravity += gravity;
            tally.damping -= damping;
            tally.damping -= turning;
        }
        tally
    }
}

/// One number per lane.
#[inline(always)]
fn column<L: Lanes>(value: Fine<L>) -> [f64; BLOCK] {
    let mut column = [0.0; BLOCK];
    value.store(&mut column[..L::WIDTH]);
    column
}

/// A row of a lane without a body or a pebble.
const NONE: &[f64; 8] = &[0.0; 8];

/// Cundall's local damping: each force component is reduced if it drives the motion and increased if it brakes it.
#[inline(always)]
fn damp<L: Lanes>(
    acting: FineVector<L>,
    velocity: FineVector<L>,
    per_inertia: Fine<L>,
    drive: &Drive,
) -> FineVector<L> {
    let zero = per_inertia.alike(0.0);
    // velocity at the time of the force, by the acceleration of the force itself
    let half = per_inertia.alike(0.5 * drive.kick) * per_inertia;
    let (velocity, acting, mut lost) = (velocity.0, acting.0, [zero; 3]);
    for c in 0..3 {
        let mid = velocity[c] + half * acting[c];
        let most = zero.alike(drive.damping) * acting[c].abs();
        lost[c] = (-most).where_less(zero, mid, most.where_less(mid, zero, zero));
    }
    FineVector(lost)
}

/// Effect of contacts, gravity and damping on the velocity of bodies.
struct Kick<L: Lanes> {
    velocity: FineVector<L>,
    /// Energy of translation, work of gravity, loss; not computed unless energy is watched.
    spent: [Fine<L>; 3],
}

/// The velocity of a body after gravity, damping and its contact forces.
#[inline(always)]
fn kick<L: Lanes>(
    (before, inverse, mass): (FineVector<L>, Fine<L>, Fine<L>),
    force: FineVector<L>,
    drive: &Drive,
) -> Kick<L> {
    let lanes = mass.lanes;
    let weight = FineVector::splat(lanes, drive.gravity).scale(mass);
    let mut acting = force + weight;
    let zero = mass.alike(0.0);
    let mut lost = FineVector([zero; 3]);
    if drive.damping > 0.0 {
        lost = damp(acting, before, inverse, drive);
        acting = acting + lost;
    }
    let change = acting.scale(inverse);
    let velocity = before + change.scale(mass.alike(drive.kick));
    let mut spent = [zero; 3];
    if drive.watched {
        let (mean, dt) = (velocity - change.scale(mass.alike(0.5 * drive.dt)), mass.alike(drive.dt));
        spent = [mass.alike(0.5) / inverse * mean.dot(mean), weight.dot(mean) * dt, lost.dot(mean) * dt];
    }
    Kick { velocity, spent }
}

impl<R: Real> Share<'_, R> {
    // Rows are loaded from where they stand and transposed in registers: a row of numbers that were just stored one by
    // one would have to wait for all of them.
    #[inline(always)]
    fn spheres<L: Lanes<Real = R>>(&mut self, lanes: L, batch: &Batch, felt: &[Felt], told: &mut Told) {
        let Share { moving, drive, .. } = self;
        let (mut states, mut sums, mut masses) = ([NONE; BLOCK], [NONE; BLOCK], [0.0; BLOCK]);
        // a lane without a body reads that of the first lane
        let mut index = [batch.members[0].pebble as u32; BLOCK];
        for (l, member) in batch.members().iter().enumerate() {
            let body = &moving.bodies[member.body];
            (states[l], masses[l]) = (body.row(), body.mass);
            (sums[l], index[l]) = (&felt[member.pebble].0, member.pebble as u32);
        }
        let place = FineVector(lanes.gather(moving.records, &index[..L::WIDTH]).position);
        let [u, v, w, p, q, r, inverse, per_inertia] = lanes.columns(states);
        let [x, y, z, a, b, c, ..] = lanes.columns(sums);
        let before = (FineVector([u, v, w]), inverse, Fine::load(lanes, &masses));
        let Kick { velocity, spent: [translation, gravity, damping] } = kick(before, FineVector([x, y, z]), drive);
        let (spin, mut acting) = (FineVector([p, q, r]), FineVector([a, b, c]));
        let zero = inverse.alike(0.0);
        let mut lost = FineVector([zero; 3]);
        if drive.damping > 0.0 {
            lost = damp(acting, spin, per_inertia, drive);
            acting = acting + lost;
        }
        let change = acting.scale(per_inertia);
        let spin = spin + change.scale(zero.alike(drive.kick));
        if drive.watched {
            let mean = spin - change.scale(zero.alike(0.5 * drive.dt));
            let none = zero;
            // a body that does not rotate has no rotational energy
            let rotation = (zero.alike(0.5) / per_inertia * mean.dot(mean)).where_less(zero, per_inertia, none);
            let turning = (lost.dot(mean) * zero.alike(drive.dt)).where_less(zero, per_inertia, none);
            told.spent(batch, inverse, [translation, rotation, gravity, damping, turning]);
        }
        told.speeds(batch, velocity.dot(velocity));
        index[batch.count..].fill(NOWHERE);
        let place = place + velocity.scale(zero.alike(drive.dt));
        lanes.move_records(moving.records, &index, place, velocity.narrow(), spin.narrow());
        let ([u, v, w], [p, q, r]) = (velocity.0, spin.0);
        let rows = lanes.rows([u, v, w, p, q, r, inverse, per_inertia]);
        for (l, member) in batch.members().iter().enumerate() {
            *moving.bodies[member.body].row_mut() = rows[l];
        }
    }

    #[inline(always)]
    fn composed<L: Lanes<Real = R>>(&mut self, lanes: L, batch: &Batch, felt: &[Felt], told: &mut Told) {
        let Share { moving, drive, .. } = self;
        let (mut states, mut fronts, mut backs) = ([NONE; BLOCK], [NONE; BLOCK], [NONE; BLOCK]);
        let (mut most, mut counts, mut masses) = (0, [0.0; BLOCK], [0.0; BLOCK]);
        for (l, member) in batch.members().iter().enumerate() {
            let (body, clump) = (&moving.bodies[member.body], &moving.clumps[member.clump]);
            (states[l], masses[l]) = (body.row(), body.mass);
            (fronts[l], backs[l]) = (clump.front(), clump.back());
            counts[l] = member.pebbles as f64;
            most = most.max(member.pebbles);
        }
        let [u, v, w, p, q, r, inverse, per_inertia] = lanes.columns(states);
        let [x, y, z, a, b, c, d, f] = lanes.columns(fronts);
        let [.., g, h, i, j, k] = lanes.columns(backs);
        let (attitude, mass) = ([a, b, c, d], Fine::load(lanes, &masses));
        let turned = rotation::matrix_in_lanes(&attitude);
        let zero = mass.alike(0.0);
        let (mut force, mut moment) = (FineVector([zero; 3]), FineVector([zero; 3]));
        for k in 0..most {
            // a lane without such a pebble adds 0
            let (mut sums, arms) = ([NONE; BLOCK], arms_of(lanes, moving, batch, k));
            for (l, member) in batch.members().iter().enumerate() {
                if k < member.pebbles {
                    sums[l] = &felt[member.pebble + k].0;
                }
            }
            let [x, y, z, a, b, c, ..] = lanes.columns(sums);
            let (push, turn) = (FineVector([x, y, z]), FineVector([a, b, c]));
            force = force + push;
            moment = moment + (turn + turned.apply(arms).cross(push));
        }
        let before = (FineVector([u, v, w]), inverse, mass);
        let Kick { velocity, spent: [translation, gravity, damping] } = kick(before, force, drive);
        let (turning, own) = (FineVector([f, g, h]), FineVector([i, j, k]));
        let mut lost = FineVector([zero; 3]);
        if drive.damping > 0.0 {
            // the sign of the spin decides; the acceleration over half a step changes it only a little
            lost = damp(moment, turning, zero, drive);
            moment = moment + lost;
        }
        let spin = FineVector([p, q, r]) + moment.scale(mass.alike(drive.kick));
        if drive.watched {
            let local = turned.apply_back(spin - moment.scale(mass.alike(0.5 * drive.dt)));
            let turning = local.times(own);
            let rotation = mass.alike(0.5) * local.dot(turning);
            let turned = lost.dot(turned.apply(turning)) * mass.alike(drive.dt);
            told.spent(batch, inverse, [translation, rotation, gravity, damping, turned]);
        }
        let centre = FineVector([x, y, z]) + velocity.scale(mass.alike(drive.dt));
        // a clump that keeps its spin rotates like a sphere of unit inertia
        let free = i + j + k;
        let momentum = spin.where_less(zero, free, turning);
        let inertia = own.where_less(zero, free, FineVector([mass.alike(1.0); 3]));
        let (attitude, turning) = rotation::turn_in_lanes(&attitude, &turned, momentum, inertia, drive.dt);
        let turned = rotation::matrix_in_lanes(&attitude);
        let narrow = turning.narrow();
        let mut fastest = zero;
        let counts = Fine::load(lanes, &counts);
        for k in 0..most {
            let arm = turned.apply(arms_of(lanes, moving, batch, k));
            let own = velocity + turning.cross(arm);
            let mut index = [NOWHERE; BLOCK];
            for (l, member) in batch.members().iter().enumerate() {
                if k < member.pebbles {
                    index[l] = (member.pebble + k) as u32;
                }
            }
            lanes.move_records(moving.records, &index, centre + arm, own.narrow(), narrow);
            let speed = own.dot(own).where_less(mass.alike(k as f64), counts, zero);
            fastest = speed.where_less(fastest, speed, fastest);
        }
        // a maximum ignores values that are not numbers
        let of_centre = velocity.dot(velocity);
        told.speeds(batch, fastest + of_centre * zero);
        let ([u, v, w], [p, q, r]) = (velocity.0, spin.0);
        let ([x, y, z], [a, b, c, d], [f, g, h]) = (centre.0, attitude, turning.0);
        let states = lanes.rows([u, v, w, p, q, r, inverse, per_inertia]);
        let (fronts, backs) = (lanes.rows([x, y, z, a, b, c, d, f]), lanes.rows([c, d, f, g, h, i, j, k]));
        for (l, member) in batch.members().iter().enumerate() {
            *moving.bodies[member.body].row_mut() = states[l];
            moving.clumps[member.clump].set_rows(&fronts[l], &backs[l]);
        }
    }
}

/// Positions of the `k`th pebbles in the frames of their bodies; 0 for a body without such a pebble.
#[inline(always)]
fn arms_of<L: Lanes>(lanes: L, moving: &Moving<'_, L::Real>, batch: &Batch, k: usize) -> FineVector<L> {
    let mut arms = [&[0.0; 4]; BLOCK];
    for (l, member) in batch.members().iter().enumerate() {
        if k < member.pebbles {
            arms[l] = &moving.arms[moving.clumps[member.clump].arms as usize + k];
        }
    }
    let [x, y, z, _] = lanes.short_columns(arms);
    FineVector([x, y, z])
}

#[inline(always)]
pub(super) fn rotate(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|r| dot(matrix[r], v))
}

#[inline(always)]
pub(super) fn rotate_back(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|c| matrix[0][c] * v[0] + matrix[1][c] * v[1] + matrix[2][c] * v[2])
}
