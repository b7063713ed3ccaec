//! Newton's law for every body: forces of its contacts in a fixed order, damping, leapfrog (methods 4.2, pass 2).

use super::body::{Body, Clump, SPHERE};
use super::force::Outcome;
use super::lanes::{Lanes, Real, Work};
use super::prefetch::prefetch;
use super::record::Record;
use super::rotation;
use super::vector::{Vec3, add, cross, dot, scale, sub};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Bodies of one task. Fixed, so that threads change nothing.
pub(super) const TASK: usize = 512;

/// Where a task begins: among bodies, pebbles, clumps and blocks of contacts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Task {
    pub body: u32,
    pub pebble: u32,
    pub clump: u32,
    pub block: u32,
}

/// Contacts of each pebble, in an order that depends on who the neighbours are and on nothing else.
#[derive(Debug, Clone, Default)]
pub(super) struct Incidence {
    /// First entry of each pebble, and one more.
    pub start: Vec<u32>,
    /// Twice the place of a contact, plus one for its second pebble.
    pub entries: Vec<u32>,
}

/// What drives a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drive {
    /// Time that velocities advance by \[s\]: half a step in the first.
    pub kick: f64,
    /// Time that positions advance by \[s\].
    pub dt: f64,
    pub gravity: Vec3,
    /// Local damping (Cundall).
    pub damping: f64,
    pub watched: bool,
}

/// What a step tells of its bodies.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Tally {
    /// Largest squared speed of a pebble \[m2/s2\], and its body's place in the bed.
    pub fastest: (f64, u32),
    /// A body whose motion is no number.
    pub lost: Option<u32>,
    /// At the time of the forces \[J\].
    pub translation: f64,
    pub rotation: f64,
    /// Work done in this step \[J\].
    pub gravity: f64,
    /// Lost to local damping in this step \[J\].
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

/// What the bodies of some tasks have, from the first of them on.
pub(super) struct Moving<'a, R: Real> {
    pub bodies: &'a mut [Body],
    pub records: &'a mut [R::Record],
    pub clumps: &'a mut [Clump],
    pub arms: &'a [Vec3],
}

/// Bodies and pebbles of one task.
struct Share<'a, R: Real> {
    at: u32,
    bodies: &'a mut [Body],
    first_pebble: u32,
    records: &'a mut [R::Record],
    clumps: &'a mut [Clump],
    arms: &'a [Vec3],
    contacts: (&'a Incidence, &'a [Outcome<R>]),
    drive: &'a Drive,
}

/// Moves the bodies of `tasks` by one step under the forces of `outcomes`.
pub(super) fn advance<R: Real>(
    moving: Moving<R>,
    tasks: &[Task],
    contacts: (&Incidence, &[Outcome<R>]),
    drive: &Drive,
) -> Tally {
    let Moving { mut bodies, mut records, mut clumps, arms } = moving;
    let mut shares = Vec::with_capacity(tasks.len());
    for (task, next) in tasks.iter().zip(&tasks[1..]) {
        let (some_bodies, rest_bodies) = bodies.split_at_mut((next.body - task.body) as usize);
        let (some_records, rest_records) = records.split_at_mut((next.pebble - task.pebble) as usize);
        let (some_clumps, rest_clumps) = clumps.split_at_mut((next.clump - task.clump) as usize);
        shares.push(Share {
            at: task.body,
            bodies: some_bodies,
            first_pebble: task.pebble,
            records: some_records,
            clumps: some_clumps,
            arms,
            contacts,
            drive,
        });
        (bodies, records, clumps) = (rest_bodies, rest_records, rest_clumps);
    }
    let tallies: Vec<Tally> = shares.into_par_iter().map(R::dispatch).collect();
    tallies.into_iter().fold(Tally::default(), Tally::and)
}

/// Force and moment about its centre on a pebble: the first six of eight numbers.
#[inline(always)]
fn sum<R: Real>(pebble: usize, (incidence, outcomes): (&Incidence, &[Outcome<R>])) -> [f64; 8] {
    let mut sums = [0.0; 8];
    let range = incidence.start[pebble] as usize..incidence.start[pebble + 1] as usize;
    for &entry in &incidence.entries[range] {
        let outcome = &outcomes[(entry >> 1) as usize];
        // the second of two feels the opposite force; the moments of both have the same sign
        let (sign, arm) = if entry & 1 == 0 { (1.0, outcome[6]) } else { (-1.0, outcome[7]) };
        let arm = -arm.to_f64();
        let factors = [sign, sign, sign, arm, arm, arm, 0.0, 0.0];
        for k in 0..8 {
            sums[k] += factors[k] * outcome[k].to_f64();
        }
    }
    sums
}

/// Cundall's local damping: each component is smaller where it drives the motion and larger where it brakes.
#[inline(always)]
fn damp(acting: Vec3, velocity: Vec3, per_inertia: f64, drive: &Drive) -> Vec3 {
    // the velocity of the time of the force, by its own acceleration
    [0, 1, 2].map(|c| {
        let mid = velocity[c] + 0.5 * drive.kick * per_inertia * acting[c];
        if mid == 0.0 { 0.0 } else { -drive.damping * acting[c].abs() * mid.signum() }
    })
}

impl<R: Real> Work<R> for Share<'_, R> {
    type Output = Tally;

    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self, _: L) -> Tally {
        let Share { arms, contacts, drive, mut bodies, mut records, mut clumps, .. } = self;
        let (mut place, mut pebble) = (self.at, self.first_pebble as usize);
        let mut tally = Tally::default();
        let mut sums = Vec::with_capacity(GROUP);
        ask_for(bodies, 0..2 * GROUP);
        while !bodies.is_empty() {
            // first the sums of some bodies, then their motion: what follows does not wait for what goes before
            let count = group(bodies);
            let (some, rest) = bodies.split_at_mut(count);
            ask_for(rest, GROUP..GROUP + count);
            let pebbles = some.iter().map(|body| usize::from(body.pebbles)).sum();
            sums.clear();
            // a closure here would be left outside the function that has the wide instructions
            for p in pebble..pebble + pebbles {
                sums.push(sum(p, contacts));
            }
            let (mine, others) = records.split_at_mut(pebbles);
            let composed = some.iter().filter(|body| body.clump != SPHERE).count();
            let (here, beyond) = clumps.split_at_mut(composed);
            move_group::<R>(some, mine, here, (arms, &sums), (place, drive), &mut tally);
            (bodies, records, clumps) = (rest, others, beyond);
            (place, pebble) = (place + count as u32, pebble + pebbles);
        }
        tally
    }
}

/// Asks for bodies that will move soon; each lies in two lines of the cache.
#[inline(always)]
fn ask_for(bodies: &[Body], range: Range<usize>) {
    for body in bodies.iter().take(range.end).skip(range.start) {
        prefetch(&body.velocity);
        prefetch(&body.id);
    }
}

/// Pebbles whose forces are summed before their bodies move.
const GROUP: usize = 24;

/// Bodies of the next group.
#[inline(always)]
fn group(bodies: &[Body]) -> usize {
    let mut pebbles = 0;
    let fits = |body: &&Body| {
        pebbles += usize::from(body.pebbles);
        pebbles <= GROUP
    };
    bodies.iter().take_while(fits).count().max(1)
}

#[inline(always)]
fn move_group<R: Real>(
    bodies: &mut [Body],
    records: &mut [R::Record],
    clumps: &mut [Clump],
    (arms, sums): (&[Vec3], &[[f64; 8]]),
    (first, drive): (u32, &Drive),
    tally: &mut Tally,
) {
    let (mut pebble, mut composed) = (0, 0);
    for (index, body) in bodies.iter_mut().enumerate() {
        let range = pebble..pebble + usize::from(body.pebbles);
        pebble = range.end;
        let speed = if body.clump == SPHERE {
            sphere(body, &mut records[range.start], &sums[range.start], drive, tally)
        } else {
            let clump = &mut clumps[composed];
            composed += 1;
            clump_step::<R>(body, clump, &mut records[range.clone()], arms, &sums[range], drive, tally)
        };
        let place = first + index as u32;
        if !speed.is_finite() {
            tally.lost = tally.lost.or(Some(place));
        } else if speed > tally.fastest.0 {
            tally.fastest = (speed, place);
        }
    }
}

/// The velocity that gravity, damping and the force of its contacts give a body. State is kept in values until all is known:
/// to read back what was just written costs more than the arithmetic.
#[inline(always)]
fn kick(body: &Body, force: Vec3, drive: &Drive, tally: &mut Tally) -> Vec3 {
    let weight = scale(drive.gravity, body.mass);
    let mut acting = add(force, weight);
    let mut lost = [0.0; 3];
    if drive.damping > 0.0 {
        lost = damp(acting, body.velocity, body.inverse_mass, drive);
        acting = add(acting, lost);
    }
    let change = scale(acting, body.inverse_mass);
    let velocity = add(body.velocity, scale(change, drive.kick));
    if drive.watched && body.inverse_mass > 0.0 {
        let mean = sub(velocity, scale(change, 0.5 * drive.dt));
        tally.translation += 0.5 / body.inverse_mass * dot(mean, mean);
        tally.gravity += dot(weight, mean) * drive.dt;
        tally.damping -= dot(lost, mean) * drive.dt;
    }
    velocity
}

#[inline(always)]
fn sphere<R: Real, T: Record<R>>(
    body: &mut Body,
    record: &mut T,
    &[x, y, z, u, v, w, ..]: &[f64; 8],
    drive: &Drive,
    tally: &mut Tally,
) -> f64 {
    let velocity = kick(body, [x, y, z], drive, tally);
    let mut acting = [u, v, w];
    let mut lost = [0.0; 3];
    if drive.damping > 0.0 {
        lost = damp(acting, body.spin, body.inverse_inertia, drive);
        acting = add(acting, lost);
    }
    let change = scale(acting, body.inverse_inertia);
    let spin = add(body.spin, scale(change, drive.kick));
    if drive.watched && body.inverse_inertia > 0.0 {
        let mean = sub(spin, scale(change, 0.5 * drive.dt));
        tally.rotation += 0.5 / body.inverse_inertia * dot(mean, mean);
        tally.damping -= dot(lost, mean) * drive.dt;
    }
    record.place(add(record.position(), scale(velocity, drive.dt)));
    record.move_with(velocity.map(R::from_f64), spin.map(R::from_f64));
    (body.velocity, body.spin) = (velocity, spin);
    dot(velocity, velocity)
}

#[inline(always)]
fn clump_step<R: Real>(
    body: &mut Body,
    clump: &mut Clump,
    records: &mut [R::Record],
    arms: &[Vec3],
    sums: &[[f64; 8]],
    drive: &Drive,
    tally: &mut Tally,
) -> f64 {
    let arms = &arms[clump.arms as usize..clump.arms as usize + records.len()];
    let turned = rotation::matrix(&clump.attitude);
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (arm, &[x, y, z, u, v, w, ..]) in arms.iter().zip(sums) {
        force = add(force, [x, y, z]);
        moment = add(moment, add([u, v, w], cross(rotate(&turned, *arm), [x, y, z])));
    }
    let velocity = kick(body, force, drive, tally);
    body.velocity = velocity;
    let mut lost = [0.0; 3];
    if drive.damping > 0.0 {
        // the sign of the spin decides; the acceleration of half a step moves it by little
        lost = damp(moment, clump.turning, 0.0, drive);
        moment = add(moment, lost);
    }
    body.spin = add(body.spin, scale(moment, drive.kick));
    if drive.watched && body.inverse_mass > 0.0 {
        let mean = sub(body.spin, scale(moment, 0.5 * drive.dt));
        let local = rotate_back(&turned, mean);
        let turning = [0, 1, 2].map(|c| local[c] * clump.inverse_inertia[c]);
        tally.rotation += 0.5 * dot(local, turning);
        tally.damping -= dot(lost, rotate(&turned, turning)) * drive.dt;
    }
    clump.centre = add(clump.centre, scale(velocity, drive.dt));
    // a clump that keeps its spin turns like a sphere of unit inertia
    let held = clump.inverse_inertia == [0.0; 3];
    let (momentum, inverse) = if held { (clump.turning, [1.0; 3]) } else { (body.spin, clump.inverse_inertia) };
    clump.turning = rotation::turn(&mut clump.attitude, &momentum, &inverse, drive.dt);
    let turned = rotation::matrix(&clump.attitude);
    let mut fastest: f64 = 0.0;
    for (record, arm) in records.iter_mut().zip(arms) {
        let arm = rotate(&turned, *arm);
        let velocity = add(velocity, cross(clump.turning, arm));
        record.place(add(clump.centre, arm));
        record.move_with(velocity.map(R::from_f64), clump.turning.map(R::from_f64));
        fastest = fastest.max(dot(velocity, velocity));
    }
    // a maximum forgets what is no number
    if dot(velocity, velocity).is_finite() { fastest } else { f64::NAN }
}

#[inline(always)]
pub(super) fn rotate(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|r| dot(matrix[r], v))
}

#[inline(always)]
pub(super) fn rotate_back(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|c| matrix[0][c] * v[0] + matrix[1][c] * v[1] + matrix[2][c] * v[2])
}
