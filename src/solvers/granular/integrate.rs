//! Newton's law for every body: forces of its contacts in a fixed order, damping, leapfrog (methods 4.2, pass 2).

use super::body::{Body, Clump, SPHERE};
use super::force::Outcome;
use super::lanes::Real;
use super::record::Record;
use super::rotation;
use super::vector::{Vec3, add, cross, dot, scale, sub};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Bodies that one task works on. Fixed, so that threads change nothing.
const CHUNK: usize = 512;

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
    fn and(mut self, other: Tally) -> Tally {
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

/// Bodies and pebbles of one task.
struct Share<'a, R: Real> {
    at: u32,
    bodies: &'a mut [Body],
    first_pebble: u32,
    records: &'a mut [R::Record],
    clumps: &'a mut [Clump],
}

/// Moves all bodies by one step under the forces of `outcomes`.
pub(super) fn advance<R: Real>(
    bodies: &mut [Body],
    records: &mut [R::Record],
    clumps: &mut [Clump],
    arms: &[Vec3],
    contacts: (&Incidence, &[Outcome<R>]),
    drive: &Drive,
) -> Tally {
    let mut shares = split::<R>(bodies, records, clumps);
    let tallies: Vec<Tally> = shares.par_iter_mut().map(|share| share.advance(arms, contacts, drive)).collect();
    tallies.into_iter().fold(Tally::default(), Tally::and)
}

/// Cuts the bed into tasks.
fn split<'a, R: Real>(
    mut bodies: &'a mut [Body],
    mut records: &'a mut [R::Record],
    mut clumps: &'a mut [Clump],
) -> Vec<Share<'a, R>> {
    let (mut at, mut first_pebble) = (0, 0);
    let mut shares = Vec::with_capacity(bodies.len().div_ceil(CHUNK));
    while !bodies.is_empty() {
        let (here, rest) = bodies.split_at_mut(CHUNK.min(bodies.len()));
        let pebbles = here.iter().map(|b| usize::from(b.pebbles)).sum::<usize>();
        let composed = here.iter().filter(|b| b.clump != SPHERE).count();
        let (some_records, rest_records) = records.split_at_mut(pebbles);
        let (some_clumps, rest_clumps) = clumps.split_at_mut(composed);
        let count = here.len() as u32;
        shares.push(Share { at, bodies: here, first_pebble, records: some_records, clumps: some_clumps });
        (bodies, records, clumps) = (rest, rest_records, rest_clumps);
        (at, first_pebble) = (at + count, first_pebble + pebbles as u32);
    }
    shares
}

/// Force and moment about its centre on a pebble.
#[inline(always)]
fn sum<R: Real>(pebble: usize, (incidence, outcomes): (&Incidence, &[Outcome<R>])) -> (Vec3, Vec3) {
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    let range = incidence.start[pebble] as usize..incidence.start[pebble + 1] as usize;
    for &entry in &incidence.entries[range] {
        let outcome = &outcomes[(entry >> 1) as usize];
        let second = entry & 1;
        let sign = 1.0 - 2.0 * f64::from(second);
        let arm = (if second == 0 { outcome[6] } else { outcome[7] }).to_f64();
        for c in 0..3 {
            force[c] += sign * outcome[c].to_f64();
            moment[c] -= arm * outcome[3 + c].to_f64();
        }
    }
    (force, moment)
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

impl<R: Real> Share<'_, R> {
    fn advance(&mut self, arms: &[Vec3], contacts: (&Incidence, &[Outcome<R>]), drive: &Drive) -> Tally {
        let mut tally = Tally::default();
        let (mut pebble, mut composed) = (0, 0);
        for index in 0..self.bodies.len() {
            let body = &mut self.bodies[index];
            let place = self.at + index as u32;
            let speed = if body.clump == SPHERE {
                let record = &mut self.records[pebble];
                sphere(body, record, sum(self.first_pebble as usize + pebble, contacts), drive, &mut tally)
            } else {
                let records = &mut self.records[pebble..pebble + usize::from(body.pebbles)];
                let clump = &mut self.clumps[composed];
                composed += 1;
                let first = self.first_pebble as usize + pebble;
                clump_step::<R>(body, clump, records, arms, |p| sum(first + p, contacts), drive, &mut tally)
            };
            if !speed.is_finite() {
                tally.lost = tally.lost.or(Some(place));
            } else if speed > tally.fastest.0 {
                tally.fastest = (speed, place);
            }
            pebble += usize::from(body.pebbles);
        }
        tally
    }
}

/// Adds gravity and damping to the force of a body's contacts and advances its velocity. Gives the mean velocity of
/// before and after.
#[inline(always)]
fn kick(body: &mut Body, force: Vec3, drive: &Drive, tally: &mut Tally) {
    let weight = scale(drive.gravity, body.mass);
    let mut acting = add(force, weight);
    let mut lost = [0.0; 3];
    if drive.damping > 0.0 {
        lost = damp(acting, body.velocity, body.inverse_mass, drive);
        acting = add(acting, lost);
    }
    let change = scale(acting, body.inverse_mass);
    body.velocity = add(body.velocity, scale(change, drive.kick));
    if drive.watched && body.inverse_mass > 0.0 {
        let mean = sub(body.velocity, scale(change, 0.5 * drive.dt));
        tally.translation += 0.5 / body.inverse_mass * dot(mean, mean);
        tally.gravity += dot(weight, mean) * drive.dt;
        tally.damping -= dot(lost, mean) * drive.dt;
    }
}

#[inline(always)]
fn sphere<R: Real, T: Record<R>>(
    body: &mut Body,
    record: &mut T,
    (force, moment): (Vec3, Vec3),
    drive: &Drive,
    tally: &mut Tally,
) -> f64 {
    kick(body, force, drive, tally);
    let mut acting = moment;
    let mut lost = [0.0; 3];
    if drive.damping > 0.0 {
        lost = damp(acting, body.spin, body.inverse_inertia, drive);
        acting = add(acting, lost);
    }
    let change = scale(acting, body.inverse_inertia);
    body.spin = add(body.spin, scale(change, drive.kick));
    if drive.watched && body.inverse_inertia > 0.0 {
        let mean = sub(body.spin, scale(change, 0.5 * drive.dt));
        tally.rotation += 0.5 / body.inverse_inertia * dot(mean, mean);
        tally.damping -= dot(lost, mean) * drive.dt;
    }
    record.place(add(record.position(), scale(body.velocity, drive.dt)));
    record.move_with(body.velocity.map(R::of), body.spin.map(R::of));
    dot(body.velocity, body.velocity)
}

fn clump_step<R: Real>(
    body: &mut Body,
    clump: &mut Clump,
    records: &mut [R::Record],
    arms: &[Vec3],
    sum: impl Fn(usize) -> (Vec3, Vec3),
    drive: &Drive,
    tally: &mut Tally,
) -> f64 {
    let arms = &arms[clump.arms as usize..clump.arms as usize + records.len()];
    let turned = rotation::matrix(&clump.attitude);
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (p, arm) in arms.iter().enumerate() {
        let (f, m) = sum(p);
        force = add(force, f);
        moment = add(moment, add(m, cross(rotate(&turned, *arm), f)));
    }
    kick(body, force, drive, tally);
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
    clump.centre = add(clump.centre, scale(body.velocity, drive.dt));
    clump.turning = rotation::turn(&mut clump.attitude, &body.spin, &clump.inverse_inertia, drive.dt);
    let turned = rotation::matrix(&clump.attitude);
    let mut fastest: f64 = 0.0;
    for (record, arm) in records.iter_mut().zip(arms) {
        let arm = rotate(&turned, *arm);
        let velocity = add(body.velocity, cross(clump.turning, arm));
        record.place(add(clump.centre, arm));
        record.move_with(velocity.map(R::of), clump.turning.map(R::of));
        fastest = fastest.max(dot(velocity, velocity));
    }
    // a maximum forgets what is no number
    if dot(body.velocity, body.velocity).is_finite() { fastest } else { f64::NAN }
}

#[inline(always)]
pub(super) fn rotate(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|r| dot(matrix[r], v))
}

#[inline(always)]
pub(super) fn rotate_back(matrix: &[Vec3; 3], v: Vec3) -> Vec3 {
    [0, 1, 2].map(|c| matrix[0][c] * v[0] + matrix[1][c] * v[1] + matrix[2][c] * v[2])
}
