//! Cost of the steps of a bed of grains: speed, time of each part, and memory traffic compared with the bandwidth of
//! the machine.
//!
//! The case is one that other programs can run too: a bed under shaken gravity with a law that all of them have, see
//! [`law`] and `benches/grains/peers.sh`.

mod machine;
mod pile;

pub use machine::{peak_memory, triad};
pub use pile::{MOST, Pile, PileError};

use crate::solvers::granular::{
    Bed, ContactLaw, ContactLaws, Dashpot, DashpotMode, Failure, FrictionLimit, Gravity, Linear, Real, Snapshot,
    Timings,
};
use serde::Serialize;
use std::time::{Duration, Instant};

/// \[s\]
pub const TIME_STEP: f64 = 1e-5;
/// \[kg/m3\]
pub const DENSITY: f64 = 2700.0;

/// Springs of 13 MN/m, friction 0.7 with history, a normal dashpot of 829 N s/m that may pull, none in shear.
pub fn law() -> ContactLaw {
    ContactLaw::Linear(Linear {
        normal_stiffness: 1.3e7,
        shear_stiffness: 1.3e7,
        friction: 0.7,
        dashpot: Dashpot::Constant { normal: 829.0, shear: 0.0 },
        mode: DashpotMode::Full,
        limit: FrictionLimit::Total,
    })
}

/// A bed on a floor that shakes at 20 Hz by 0.3 of its weight, seen from the floor.
pub fn gravity() -> Gravity {
    Gravity::Shaken { mean: [0.0, 0.0, -9.81], share: 0.3, frequency: 20.0 }
}

/// The bed of a pile as it stands before the first step.
pub fn bed<R: Real>(pile: &Pile, copies: [u32; 2], skin: Option<f64>) -> Bed<R> {
    let mut bed = pile.bed(copies, ContactLaws::single(law()), DENSITY);
    bed.set_time_step(TIME_STEP);
    bed.set_gravity(gravity());
    bed.set_skin(skin);
    bed
}

/// Settings of the measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Copies of the bed along x and y.
    pub copies: [u32; 2],
    /// Reach of the neighbour lists \[m\]; the bed chooses where it is none.
    pub skin: Option<f64>,
    /// Steps before those that are timed.
    pub warm: u64,
    pub steps: u64,
    /// Number of repetitions from the file's state; at least one. The run with the median time is reported.
    pub repeat: u32,
}

/// Results of a measurement. A pebble is one sphere; a body of one sphere is a pebble and a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    pub bodies: u64,
    pub pebbles: u64,
    pub steps: u64,
    pub warm_steps: u64,
    pub repeats: u32,
    pub threads: u64,
    pub precision: &'static str,
    pub sphere_steps_per_second: f64,
    /// None where no body has several pebbles.
    pub clump_steps_per_second: Option<f64>,
    /// Twice the contacts between pebbles over pebbles, and over bodies.
    pub contacts_per_sphere: f64,
    pub contacts_per_body: f64,
    /// Contacts that touch at the end, with walls too, and pairs that a step computes.
    pub contacts: u64,
    pub listed_contacts: u64,
    /// Updates of contacts that touch.
    pub contact_updates_per_second: f64,
    /// Kinetic energy of translation and rotation, at the time of the last positions \[J\].
    pub kinetic_energy: f64,
    pub rotational_energy: f64,
    pub lists_made: u64,
    pub skin_m: f64,
    /// Peak memory of the whole program up to the last step, before anything was looked at.
    pub peak_memory_bytes: Option<u64>,
    pub bytes_per_sphere: Option<f64>,
    /// Seconds of the timed steps; those of every repetition in the order of doing.
    pub seconds: f64,
    pub all_seconds: Vec<f64>,
    /// Seconds of reading into a bed and making the first lists.
    pub setup_seconds: f64,
    pub time: Shares,
    /// None until the machine has been measured.
    pub bandwidth: Option<Bandwidth>,
}

/// Time of each part of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shares {
    pub search: Share,
    pub forces: Share,
    pub walls: Share,
    pub motion: Share,
    pub other: Share,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    pub share: f64,
    pub ns_per_body_step: f64,
}

/// Memory traffic of the steps, compared with the bandwidth of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bandwidth {
    /// By a triad on the same threads.
    pub measured_bytes_per_second: f64,
    /// See [`Bed::bytes_per_step`].
    pub bytes_per_step: u64,
    pub used_bytes_per_second: f64,
    /// Above 1 if the caches hold data that the next pass needs.
    pub share: f64,
}

/// A measurement with the bed at its end.
pub struct Finished<R: Real> {
    pub measured: Measured,
    pub bed: Bed<R>,
    pub snapshot: Snapshot,
}

/// One repetition.
struct Round {
    seconds: f64,
    setup: f64,
    timings: Timings,
}

/// Runs the bed and returns the cost. `progress` gets the steps done and their total.
pub fn measure<R: Real>(
    pile: &Pile,
    request: &Request,
    mut progress: impl FnMut(u64, u64),
) -> Result<Finished<R>, Failure> {
    let all = u64::from(request.repeat) * (request.warm + request.steps);
    let mut done = 0;
    let mut rounds = Vec::new();
    let mut last = None;
    for _ in 0..request.repeat.max(1) {
        // two beds at once would count twice as memory
        drop(last.take());
        let start = Instant::now();
        let mut bed: Bed<R> = bed(pile, request.copies, request.skin);
        bed.make_lists()?;
        let setup = start.elapsed().as_secs_f64();
        let mut run = |bed: &mut Bed<R>, count: u64| -> Result<(), Failure> {
            (0..count).try_for_each(|_| {
                bed.step()?;
                done += 1;
                progress(done, all);
                Ok(())
            })
        };
        run(&mut bed, request.warm)?;
        let (start, before) = (Instant::now(), bed.timings());
        run(&mut bed, request.steps)?;
        let seconds = start.elapsed().as_secs_f64();
        rounds.push(Round { seconds, setup, timings: between(before, bed.timings()) });
        last = Some(bed);
    }
    let peak = peak_memory();
    let Some(mut bed) = last else { return Err(Failure::NoTimeStep) };
    let snapshot = bed.snapshot()?;
    let measured = sum_up(pile, request, &bed, &snapshot, rounds, peak);
    Ok(Finished { measured, bed, snapshot })
}

fn between(before: Timings, after: Timings) -> Timings {
    Timings {
        search: after.search - before.search,
        forces: after.forces - before.forces,
        walls: after.walls - before.walls,
        motion: after.motion - before.motion,
    }
}

fn sum_up<R: Real>(
    pile: &Pile,
    request: &Request,
    bed: &Bed<R>,
    snapshot: &Snapshot,
    mut rounds: Vec<Round>,
    peak: Option<u64>,
) -> Measured {
    let all_seconds: Vec<f64> = rounds.iter().map(|r| r.seconds).collect();
    rounds.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let middle = &rounds[(rounds.len() - 1) / 2];
    let copies: u64 = request.copies.iter().map(|&n| u64::from(n)).product();
    let (bodies, pebbles) = (bed.len() as u64, pile.pebbles() * copies);
    let per_second = |count: u64| (count * request.steps) as f64 / middle.seconds;
    let coordination = snapshot.coordination(bed.len());
    let contacts = snapshot.contacts.len() as u64;
    Measured {
        bodies,
        pebbles,
        steps: request.steps,
        warm_steps: request.warm,
        repeats: request.repeat,
        threads: rayon::current_num_threads() as u64,
        precision: precision::<R>(),
        sphere_steps_per_second: per_second(pebbles),
        clump_steps_per_second: (pile.clumps() > 0).then(|| per_second(bodies)),
        contacts_per_sphere: coordination * bodies as f64 / pebbles as f64,
        contacts_per_body: coordination,
        contacts,
        listed_contacts: bed.listed_contacts() as u64,
        contact_updates_per_second: per_second(contacts),
        kinetic_energy: snapshot.translation,
        rotational_energy: snapshot.rotation,
        lists_made: bed.lists_made(),
        skin_m: bed.skin(),
        peak_memory_bytes: peak,
        bytes_per_sphere: peak.map(|bytes| bytes as f64 / pebbles as f64),
        seconds: middle.seconds,
        all_seconds,
        setup_seconds: middle.setup,
        time: shares(middle, (bodies * request.steps) as f64),
        bandwidth: None,
    }
}

/// The precision as the command line calls it.
fn precision<R: Real>() -> &'static str {
    if size_of::<R>() == size_of::<f32>() { "mixed" } else { "f64" }
}

fn shares(round: &Round, body_steps: f64) -> Shares {
    let Timings { search, forces, walls, motion } = round.timings;
    let share = |seconds: f64| Share { share: seconds / round.seconds, ns_per_body_step: 1e9 * seconds / body_steps };
    let of = |time: Duration| share(time.as_secs_f64());
    Shares {
        search: of(search),
        forces: of(forces),
        walls: of(walls),
        motion: of(motion),
        other: share((round.seconds - (search + forces + walls + motion).as_secs_f64()).max(0.0)),
    }
}

impl Measured {
    /// Sets what the steps of `bytes_per_step` moved against a `triad` (bytes/s) of the same threads.
    pub fn set_against(&mut self, triad: f64, bytes_per_step: u64) {
        let used = (bytes_per_step * self.steps) as f64 / self.seconds;
        self.bandwidth = Some(Bandwidth {
            measured_bytes_per_second: triad,
            bytes_per_step,
            used_bytes_per_second: used,
            share: used / triad,
        });
    }
}
