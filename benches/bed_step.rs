//! Time per step of a track's bed: the cell of a scene packed once, laid so many times, with a row of sleepers on it.
//!
//! ```text
//! cargo bench --bench bed_step -- --cells DIR [--scene FILE] [--bays 40] [--steps 40] [--rounds 5] [--threads 1,2]
//!     [--warm 60] [--step 7] [--shear RATIO] [--limits] [--no-sleepers]
//! ```
//!
//! `DIR` keeps the packed cell, which takes minutes to make. Rounds of so many steps go from one number of threads to
//! the next in turn; told are the least and the median of each part, in ms a step, as JSON. `--step` is in us.
//! `--shear` is the ratio of the shear dashpots, that of the scene where it is not given. `--limits` adds how long a
//! step may be, as it is and with inertia added, which takes minutes.

use serde_json::{Value, json};
use std::time::{Duration, Instant};
use trackbed::lower::{BedUse, beds};
use trackbed::solvers::granular::motion::Push;
use trackbed::solvers::granular::packing::{Order, lay};
use trackbed::solvers::granular::{Bed, ContactLaw, Dashpot, Pose, Shape, Timings, WallMotion};
use trackbed::store::Beds;
use trackbed::trials::grains::peak_memory;

/// Length, width and height of half a sleeper, m, its mass with what stands on it, kg, and how far its load goes up and
/// down, N.
const SLEEPER: [f64; 3] = [0.3, 1.2, 0.2];
const MASS: f64 = 150.0;
const LOAD: f64 = 40e3;
const FREQUENCY: f64 = 20.0;
/// Shares of the mass that may be added as inertia where limits are told.
const SHARES: [f64; 3] = [0.001, 0.005, 0.02];

fn main() {
    let options = Options::read();
    let scene = trackbed::Scene::open(&options.scene).expect("a scene").check();
    let scenario = scene.scenario.as_ref().expect("a scene without errors");
    let plans = beds(scenario, BedUse::Track).expect("beds");
    let recipe = plans[0].ready(plans[0].seed()).expect("clumps").recipe;
    let cell = Beds::kept_in(&options.cells)
        .bed(&recipe, |progress| eprint!("\r{:5.1} % {}          ", 100.0 * progress.share, progress.stage))
        .expect("a bed")
        .packed;
    let start = Instant::now();
    let mut bed = lay(&[cell], &Order::of_one(options.bays), &recipe, |_| ()).expect("a bed of a track").bed;
    let laid = start.elapsed();
    if let Some(shear) = options.shear {
        bed.change_laws(|law| set_shear(law, shear));
    }
    let limits = options.limits.then(|| limits(&mut bed));
    bed.set_time_step(options.step);
    if options.sleepers {
        stand(&mut bed, options.bays, recipe.plan[0]);
    }
    let rounds = rounds(&mut bed, &options);
    let parts = |threads: usize| {
        let of = |part: fn(&Round) -> f64| {
            let mut all: Vec<f64> = rounds.iter().filter(|round| round.threads == threads).map(part).collect();
            all.sort_by(f64::total_cmp);
            json!({ "least": all[0], "median": all[all.len() / 2] })
        };
        json!({
            "threads": threads,
            "ms_per_step": of(|round| round.all),
            "search": of(|round| round.parts[0]),
            "forces": of(|round| round.parts[1]),
            "walls": of(|round| round.parts[2]),
            "motion": of(|round| round.parts[3]),
        })
    };
    let told = json!({
        "bays": options.bays,
        "bodies": bed.len(),
        "pebbles": bed.pebbles().count(),
        "lists_made": bed.lists_made(), "listed_contacts": bed.listed_contacts(),
        "skin_mm": 1e3 * bed.skin(),
        "time_step_us": 1e6 * options.step,
        "laid_seconds": laid.as_secs_f64(),
        "peak_memory_bytes": peak_memory(),
        "bytes_per_step": bed.bytes_per_step(),
        "limits": limits,
        "speed": options.threads.iter().map(|&threads| parts(threads)).collect::<Vec<Value>>(),
    });
    println!("{told:#}");
}

/// Some steps on so many threads: ms a step, in all and by part.
struct Round {
    threads: usize,
    all: f64,
    parts: [f64; 4],
}

fn rounds(bed: &mut Bed, options: &Options) -> Vec<Round> {
    let pool = |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let pools: Vec<_> = options.threads.iter().map(|&threads| (threads, pool(threads))).collect();
    pools[pools.len() - 1].1.install(|| bed.run(options.warm)).expect("steps");
    let mut rounds = Vec::new();
    for _ in 0..options.rounds {
        for (threads, pool) in &pools {
            let (start, before) = (Instant::now(), bed.timings());
            pool.install(|| bed.run(options.steps)).expect("steps");
            let (all, after) = (start.elapsed(), bed.timings());
            let of = |part: fn(&Timings) -> Duration| ms(part(&after) - part(&before), options.steps);
            let parts = [of(|t| t.search), of(|t| t.forces), of(|t| t.walls), of(|t| t.motion)];
            rounds.push(Round { threads: *threads, all: ms(all, options.steps), parts });
        }
    }
    rounds
}

fn ms(time: Duration, steps: u64) -> f64 {
    1e3 * time.as_secs_f64() / steps as f64
}

/// A sleeper in every bay, where it touches its first grain, under a load that goes up and down.
fn stand(bed: &mut Bed, bays: usize, length: f64) {
    let surface = bed.laws().surfaces() as u16 - 1;
    let half = nalgebra::Vector3::from(SLEEPER) / 2.0;
    let mut tops = vec![0.0f64; bays];
    for pebble in bed.pebbles().filter(|pebble| (0.0..length * bays as f64).contains(&pebble.place[0])) {
        let (bay, along) = ((pebble.place[0] / length) as usize, pebble.place[0] % length - 0.5 * length);
        if along.abs() < half.x + pebble.radius {
            tops[bay] = tops[bay].max(pebble.place[2] + pebble.radius);
        }
    }
    for (bay, top) in tops.into_iter().enumerate() {
        let position = nalgebra::Vector3::new((bay as f64 + 0.5) * length, half.y, top + half.z);
        let push = Push::Cyclic { low: 0.0, high: LOAD, frequency: FREQUENCY, start: 0.0, ramp: 0.0 };
        let motion =
            WallMotion::Loaded { axis: -nalgebra::Vector3::z(), mass: MASS, weight: 9.81 * MASS, damping: 0.2, push };
        bed.add_wall(Shape::Block { half }, Pose { position, ..Pose::default() }, surface, motion);
    }
}

fn set_shear(law: &mut ContactLaw, ratio: f64) {
    if let ContactLaw::Linear(law) = law
        && let Dashpot::Ratio { normal, .. } = law.dashpot
    {
        law.dashpot = Dashpot::Ratio { normal, shear: ratio };
    }
}

/// Largest steps by rule, us.
fn limits(bed: &mut Bed) -> Value {
    let found = bed.critical_step(0.0).expect("limits");
    let us = |limit: f64| 1e6 * limit;
    let held: Vec<Value> = SHARES.iter().map(|share| held(bed, *share)).collect();
    json!({
        "held": held,
        "estimate_us": us(found.estimate.step),
        "bound_us": us(found.bound.step),
        "network_us": us(found.network.step),
        "contacts": found.contacts,
    })
}

/// The longest step for a share of the mass added as inertia.
fn held(bed: &mut Bed, share: f64) -> Value {
    let start = Instant::now();
    let held = bed.hold_longest_step(share, 0.0).expect("inertia");
    bed.unscale_masses();
    json!({
        "share": share,
        "network_us": 1e6 * held.limit,
        "added_share": held.added_share,
        "bodies": held.bodies,
        "largest_factor": held.largest.map(|(_, factor)| factor),
        "seconds": start.elapsed().as_secs_f64(),
    })
}

struct Options {
    scene: String,
    cells: String,
    bays: usize,
    warm: u64,
    steps: u64,
    rounds: usize,
    threads: Vec<usize>,
    step: f64,
    shear: Option<f64>,
    limits: bool,
    sleepers: bool,
}

impl Options {
    fn read() -> Options {
        let words: Vec<String> = std::env::args().skip(1).collect();
        let value = |name: &str| {
            let place = words.iter().position(|word| word == name)?;
            Some(words.get(place + 1).unwrap_or_else(|| panic!("{name} wants a value")).clone())
        };
        let number = |name: &str, otherwise: f64| value(name).map_or(otherwise, |word| word.parse().expect("a number"));
        let threads = value("--threads").unwrap_or_else(|| "1,2".into());
        Options {
            scene: value("--scene").unwrap_or_else(|| "scenarios/transition_full.track".into()),
            cells: value("--cells").expect("--cells DIR: where the packed cell is kept"),
            bays: number("--bays", 40.0) as usize,
            warm: number("--warm", 60.0) as u64,
            steps: number("--steps", 40.0) as u64,
            rounds: number("--rounds", 5.0) as usize,
            threads: threads.split(',').map(|word| word.parse().expect("numbers of threads")).collect(),
            step: 1e-6 * number("--step", 7.0),
            shear: value("--shear").map(|word| word.parse().expect("a ratio")),
            limits: words.iter().any(|word| word == "--limits"),
            sleepers: !words.iter().any(|word| word == "--no-sleepers"),
        }
    }
}
