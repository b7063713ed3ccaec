//! The equation of motion of every body: contact forces in a fixed order, damping, leapfrog (methods 4.2, pass 2).

use super::body::{Body, Clump, SPHERE};
use super::force::Outcome;
use super::lanes::{BLOCK, Fine, FineVector, Lanes, Real, Vector, Work};
use super::prefetch::prefetch;
use super::record::Record;
use super::rotation;
use super::vector::{Vec3, dot};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Bodies of one task. The number is fixed, so that the number of threads does not change the results.
pub(super) const TASK: usize = 512;

/// First indices of a task: bodies, pebbles, clumps and blocks of contacts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Task {
    pub body: u32,
    pub pebble: u32,
    pub clump: u32,
    pub block: u32,
}

/// Contacts of each pebble, in an order that depends only on which bodies are its neighbours.
#[derive(Debug, Clone, Default)]
pub(super) struct Incidence {
    /// First entry of each pebble, and one final value.
    pub start: Vec<u32>,
    /// Twice the index of a contact, plus one for its second pebble.
    pub entries: Vec<u32>,
}

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
    pub arms: &'a [Vec3],
}

/// Bodies and pebbles of one task.
struct Share<'a, R: Real> {
    /// Number of the first body among all, for the results; the first pebble and the first clump.
    at: Task,
    moving: Moving<'a, R>,
    forces: Forces<'a, R>,
    drive: &'a Drive,
}

/// Contacts, and their forces on the bodies.
pub(super) struct Forces<'a, R: Real> {
    pub incidence: &'a Incidence,
    pub outcomes: &'a [Outcome<R>],
}

impl<R: Real> Clone for Forces<'_, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R: Real> Copy for Forces<'_, R> {}

/// Moves the bodies of `tasks` by one step under the forces of their contacts.
pub(super) fn advance<R: Real>(moving: Moving<R>, tasks: &[Task], forces: Forces<R>, drive: &Drive) -> Tally {
    let Moving { mut bodies, mut records, mut clumps, arms } = moving;
    let mut shares = Vec::with_capacity(tasks.len());
    for (task, next) in tasks.iter().zip(&tasks[1..]) {
        let (some_bodies, rest_bodies) = bodies.split_at_mut((next.body - task.body) as usize);
        let (some_records, rest_records) = records.split_at_mut((next.pebble - task.pebble) as usize);
        let (some_clumps, rest_clumps) = clumps.split_at_mut((next.clump - task.clump) as usize);
        let moving = Moving { bodies: some_bodies, records: some_records, clumps: some_clumps, arms };
        shares.push(Share { at: *task, moving, forces, drive });
        (bodies, records, clumps) = (rest_bodies, rest_records, rest_clumps);
    }
    let tallies: Vec<Tally> = shares.into_par_iter().map(R::dispatch).collect();
    tallies.into_iter().fold(Tally::default(), Tally::and)
}

/// Number of entries between the prefetched entry and the summed entry.
const ASKED: usize = 16;

/// Force on a pebble, and moment about its centre: the first six of eight numbers.
#[inline(always)]
fn sum<L: Lanes>(lanes: L, pebble: usize, forces: Forces<L::Real>) -> [f64; 8] {
    let mut sums = [0.0; 8];
    let Forces { incidence, outcomes } = forces;
    let range = incidence.start[pebble] as usize..incidence.start[pebble + 1] as usize;
    for at in range {
        if let Some(&later) = incidence.entries.get(at + ASKED) {
            prefetch(&outcomes[(later >> 1) as usize]);
        }
        let entry = incidence.entries[at];
        let outcome = &outcomes[(entry >> 1) as usize];
        // the force on the second body is opposite; the moments of both have the same sign
        let second = u64::from(entry & 1);
        let sign = f64::from_bits(1f64.to_bits() | second << 63);
        let arm = -outcome[6 + second as usize].to_f64();
        sums = lanes.add_row(outcome, [sign, sign, sign, arm, arm, arm, arm, arm], sums);
    }
    sums
}

impl<R: Real> Work<R> for Share<'_, R> {
    type Output = Tally;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(mut self, lanes: L) -> Tally {
        let count = self.moving.bodies.len();
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
                    self.spheres(lanes, &spheres, &mut told);
                    spheres.count = 0;
                }
            } else {
                composed.put(Member { body, pebble, pebbles, clump });
                clump += 1;
                if composed.count == L::WIDTH {
                    self.composed(lanes, &composed, &mut told);
                    composed.count = 0;
                }
            }
        }
        if spheres.count > 0 {
            self.spheres(lanes, &spheres, &mut told);
        }
        if composed.count > 0 {
            self.composed(lanes, &composed, &mut told);
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

/// Three numbers per lane.
#[inline(always)]
fn columns<L: Lanes>(value: FineVector<L>) -> [[f64; BLOCK]; 3] {
    let [x, y, z] = value.0;
    [column(x), column(y), column(z)]
}

/// Rows, one per lane, as columns.
#[derive(Clone, Copy)]
struct Table<const N: usize>([[f64; BLOCK]; N]);

impl<const N: usize> Table<N> {
    #[inline(always)]
    fn new() -> Self {
        Table([[0.0; BLOCK]; N])
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, row: [f64; N]) {
        let columns = &mut self.0;
        for c in 0..N {
            columns[c][lane] = row[c];
        }
    }

    #[inline(always)]
    fn one<L: Lanes>(&self, lanes: L, column: usize) -> Fine<L> {
        Fine::load(lanes, &self.0[column])
    }

    #[inline(always)]
    fn three<L: Lanes>(&self, lanes: L, first: usize) -> FineVector<L> {
        FineVector::load(lanes, [&self.0[first], &self.0[first + 1], &self.0[first + 2]])
    }
}

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
    #[inline(always)]
    fn spheres<L: Lanes<Real = R>>(&mut self, lanes: L, batch: &Batch, told: &mut Told) {
        let Share { moving, drive, .. } = self;
        // state is kept in values until all is known: reading back values just written costs more than the arithmetic
        let (mut states, mut sums, mut places) = (Table::<9>::new(), Table::<8>::new(), Table::<3>::new());
        for (l, member) in batch.members().iter().enumerate() {
            let body = &moving.bodies[member.body];
            let ([u, v, w], [p, q, r]) = (body.velocity, body.spin);
            states.put(l, [u, v, w, p, q, r, body.inverse_mass, body.inverse_inertia, body.mass]);
            sums.put(l, sum(lanes, self.at.pebble as usize + member.pebble, self.forces));
            places.put(l, moving.records[member.pebble].position());
        }
        let (inverse, per_inertia) = (states.one(lanes, 6), states.one(lanes, 7));
        let before = (states.three(lanes, 0), inverse, states.one(lanes, 8));
        let Kick { velocity, spent: [translation, gravity, damping] } = kick(before, sums.three(lanes, 0), drive);
        let mut acting = sums.three(lanes, 3);
        let zero = inverse.alike(0.0);
        let mut lost = FineVector([zero; 3]);
        let spin = states.three(lanes, 3);
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
        let place = columns(places.three(lanes, 0) + velocity.scale(zero.alike(drive.dt)));
        let (narrow, turning) = (velocity.narrow(), spin.narrow());
        told.speeds(batch, velocity.dot(velocity));
        let (velocity, spin) = (columns(velocity), columns(spin));
        let motion = Motion::of(narrow, turning);
        for (l, member) in batch.members().iter().enumerate() {
            let record = &mut moving.records[member.pebble];
            record.place(row(&place, l));
            motion.give(l, record);
            let body = &mut moving.bodies[member.body];
            (body.velocity, body.spin) = (row(&velocity, l), row(&spin, l));
        }
    }

    #[inline(always)]
    fn composed<L: Lanes<Real = R>>(&mut self, lanes: L, batch: &Batch, told: &mut Told) {
        let Share { moving, drive, .. } = self;
        let (mut states, mut shapes) = (Table::<8>::new(), Table::<13>::new());
        let (mut most, mut counts) = (0, [0.0; BLOCK]);
        for (l, member) in batch.members().iter().enumerate() {
            let (body, clump) = (&moving.bodies[member.body], &moving.clumps[member.clump]);
            let ([u, v, w], [p, q, r]) = (body.velocity, body.spin);
            states.put(l, [u, v, w, p, q, r, body.inverse_mass, body.mass]);
            let ([x, y, z], [a, b, c, d], [f, g, h]) = (clump.centre, clump.attitude, clump.turning);
            let [i, j, k] = clump.inverse_inertia;
            shapes.put(l, [x, y, z, a, b, c, d, f, g, h, i, j, k]);
            counts[l] = member.pebbles as f64;
            most = most.max(member.pebbles);
        }
        let attitude = [shapes.one(lanes, 3), shapes.one(lanes, 4), shapes.one(lanes, 5), shapes.one(lanes, 6)];
        let turned = rotation::matrix_in_lanes(&attitude);
        let (inverse, mass) = (states.one(lanes, 6), states.one(lanes, 7));
        let zero = mass.alike(0.0);
        let (mut force, mut moment) = (FineVector([zero; 3]), FineVector([zero; 3]));
        for k in 0..most {
            // a lane without such a pebble adds 0
            let (mut sums, mut arms) = (Table::<8>::new(), Table::<3>::new());
            for (l, member) in batch.members().iter().enumerate() {
                if k < member.pebbles {
                    sums.put(l, sum(lanes, self.at.pebble as usize + member.pebble + k, self.forces));
                    arms.put(l, moving.arms[moving.clumps[member.clump].arms as usize + k]);
                }
            }
            let (push, turn) = (sums.three(lanes, 0), sums.three(lanes, 3));
            force = force + push;
            moment = moment + (turn + turned.apply(arms.three(lanes, 0)).cross(push));
        }
        let before = (states.three(lanes, 0), inverse, mass);
        let Kick { velocity, spent: [translation, gravity, damping] } = kick(before, force, drive);
        let (turning, own) = (shapes.three(lanes, 7), shapes.three(lanes, 10));
        let mut lost = FineVector([zero; 3]);
        if drive.damping > 0.0 {
            // the sign of the spin decides; the acceleration over half a step changes it only a little
            lost = damp(moment, turning, zero, drive);
            moment = moment + lost;
        }
        let spin = states.three(lanes, 3) + moment.scale(mass.alike(drive.kick));
        if drive.watched {
            let local = turned.apply_back(spin - moment.scale(mass.alike(0.5 * drive.dt)));
            let turning = local.times(own);
            let rotation = mass.alike(0.5) * local.dot(turning);
            let turned = lost.dot(turned.apply(turning)) * mass.alike(drive.dt);
            told.spent(batch, inverse, [translation, rotation, gravity, damping, turned]);
        }
        let centre = shapes.three(lanes, 0) + velocity.scale(mass.alike(drive.dt));
        // a clump that keeps its spin rotates like a sphere of unit inertia
        let free = own.0[0] + own.0[1] + own.0[2];
        let momentum = spin.where_less(zero, free, turning);
        let own = own.where_less(zero, free, FineVector([mass.alike(1.0); 3]));
        let (attitude, turning) = rotation::turn_in_lanes(&attitude, &turned, momentum, own, drive.dt);
        let turned = rotation::matrix_in_lanes(&attitude);
        let narrow = turning.narrow();
        let mut fastest = zero;
        let counts = Fine::load(lanes, &counts);
        for k in 0..most {
            let mut arms = Table::<3>::new();
            for (l, member) in batch.members().iter().enumerate() {
                if k < member.pebbles {
                    arms.put(l, moving.arms[moving.clumps[member.clump].arms as usize + k]);
                }
            }
            let arm = turned.apply(arms.three(lanes, 0));
            let own = velocity + turning.cross(arm);
            let (place, motion) = (columns(centre + arm), Motion::of(own.narrow(), narrow));
            for (l, member) in batch.members().iter().enumerate() {
                if k < member.pebbles {
                    let record = &mut moving.records[member.pebble + k];
                    record.place(row(&place, l));
                    motion.give(l, record);
                }
            }
            let speed = own.dot(own).where_less(mass.alike(k as f64), counts, zero);
            fastest = speed.where_less(fastest, speed, fastest);
        }
        // a maximum ignores values that are not numbers
        let of_centre = velocity.dot(velocity);
        told.speeds(batch, fastest + of_centre * zero);
        let (velocity, spin, centre, turning) = (columns(velocity), columns(spin), columns(centre), columns(turning));
        let [a, b, c, d] = attitude;
        let attitude = [column(a), column(b), column(c), column(d)];
        for (l, member) in batch.members().iter().enumerate() {
            let (body, clump) = (&mut moving.bodies[member.body], &mut moving.clumps[member.clump]);
            (body.velocity, body.spin) = (row(&velocity, l), row(&spin, l));
            (clump.centre, clump.turning) = (row(&centre, l), row(&turning, l));
            clump.attitude = [attitude[0][l], attitude[1][l], attitude[2][l], attitude[3][l]];
        }
    }
}

/// A vector of one lane.
#[inline(always)]
fn row<T: Copy>(columns: &[[T; BLOCK]; 3], lane: usize) -> [T; 3] {
    [columns[0][lane], columns[1][lane], columns[2][lane]]
}

/// Velocity and spin of pebbles, as their contacts read them.
struct Motion<R> {
    velocity: [[R; BLOCK]; 3],
    spin: [[R; BLOCK]; 3],
}

impl<R: Real> Motion<R> {
    #[inline(always)]
    fn of<L: Lanes<Real = R>>(velocity: Vector<L>, spin: Vector<L>) -> Self {
        let mut motion = Motion { velocity: [[R::default(); BLOCK]; 3], spin: [[R::default(); BLOCK]; 3] };
        velocity.store(&mut motion.velocity, 0);
        spin.store(&mut motion.spin, 0);
        motion
    }

    #[inline(always)]
    fn give(&self, lane: usize, record: &mut R::Record) {
        record.move_with(row(&self.velocity, lane), row(&self.spin, lane));
    }
}

#[inline(always)]
pub(super) fn rotate(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|r| dot(matrix[r], v))
}

#[inline(always)]
pub(super) fn rotate_back(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|c| matrix[0][c] * v[0] + matrix[1][c] * v[1] + matrix[2][c] * v[2])
}
