//! Compresses a bed of spheres under a plate and unloads it again, cycle by cycle: an experiment that has been run with
//! YADE from the same particle file, and whose parameters are YADE's by default.
//!
//! ```text
//! cargo run --release --example oedometer -- examples/oedometer/particles.xyzr --out out/oedometer
//! ```
//!
//! Five seeds are run, one a thread: the first from the file as it is, the others from places moved by up to a
//! micrometre, after which two runs part within a few hundred slips. `--seeds 1` is the quick way, and
//! `--reference docs/charts/oedometer/yade_10` compares with YADE's run at the same speed of the plate.
//!
//! The folder then holds `compress.csv` (rest to the upper pressure), `cycles_path.csv` (everything after),
//! `cycles.csv` (a line a cycle), `scatter.csv` (mean and scatter over the seeds), `summary.json` and `oedometer.svg`.
//! Tables of the second seed and those after it are in `seed_1`, `seed_2` and so on.
//!
//! A first loading with the plate at 20 mm/s, as YADE's second run: `--speed 0.02`.

mod cycles;
mod experiment;
mod files;
mod particles;
mod picture;
mod scatter;
#[allow(dead_code)]
#[path = "../../src/report/svg.rs"]
mod svg;

use clap::{Parser, ValueEnum};
use cycles::{Outcome, run};
use experiment::{Parameters, Trouble};
use files::Reference;
use indicatif::{ProgressBar, ProgressStyle};
use particles::Particles;
use scatter::{Scatter, observables, scatter};
use std::error::Error;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Compresses a bed of spheres under a plate, load cycle by load cycle.
#[derive(Parser)]
#[command(allow_negative_numbers = true)]
struct Arguments {
    /// Spheres: a line `x y z r` each, in m
    particles: PathBuf,
    /// Folder for tables and picture
    #[arg(long)]
    out: PathBuf,
    /// Folder with `compress.csv` and `cycles.csv` to compare with
    #[arg(long)]
    reference: Option<PathBuf>,
    /// Period in x and y, m; that of the file where absent
    #[arg(long, num_args = 2, value_names = ["X", "Y"])]
    period: Option<Vec<f64>>,
    /// kg/m3
    #[arg(long, default_value_t = 2700.0)]
    density: f64,
    /// Normal stiffness of a contact, N/m
    #[arg(long, default_value_t = 1.3e7)]
    kn: f64,
    /// Shear stiffness of a contact, N/m
    #[arg(long, default_value_t = 1.3e7)]
    kt: f64,
    #[arg(long, default_value_t = 0.7)]
    friction: f64,
    /// Cundall's local damping, from 0 to below 1
    #[arg(long, default_value_t = 0.7)]
    damping: f64,
    /// Time step, s
    #[arg(long, default_value_t = 1e-5)]
    dt: f64,
    /// m/s2
    #[arg(long, default_value_t = 9.81)]
    gravity: f64,
    /// Speed of the plate once it is seated, m/s
    #[arg(long, default_value_t = 0.01)]
    speed: f64,
    /// Speed of the plate while it is being seated, m/s
    #[arg(long, default_value_t = 0.02)]
    seat_speed: f64,
    /// Pressure that seats the plate and ends unloading, kPa
    #[arg(long, default_value_t = 20.0)]
    low: f64,
    /// Pressure that ends loading, kPa
    #[arg(long, default_value_t = 100.0)]
    high: f64,
    /// Load cycles after the first unloading
    #[arg(long, default_value_t = 10)]
    cycles: usize,
    /// Steps under gravity before the plate moves
    #[arg(long, default_value_t = 10_000)]
    settle: u64,
    /// Plate above the highest sphere at the start, m
    #[arg(long, default_value_t = 0.2e-3)]
    gap: f64,
    /// Steps between rows
    #[arg(long, default_value_t = 200)]
    interval: u64,
    /// First seed; 0 leaves the file as it is
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Number of seeds
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: u64,
    /// Farthest that a seed moves a coordinate of a sphere, m
    #[arg(long, default_value_t = 1e-6)]
    shake: f64,
    /// Threads; those of the machine where absent
    #[arg(long)]
    threads: Option<usize>,
    /// Of forces, velocities and histories; places are double in both
    #[arg(long, default_value = "single")]
    precision: Precision,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Precision {
    Single,
    Double,
}

fn main() -> std::process::ExitCode {
    match work(&Arguments::parse()) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            std::process::ExitCode::FAILURE
        }
    }
}

fn work(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let shown = arguments.particles.display();
    let text = std::fs::read_to_string(&arguments.particles).map_err(|cause| format!("{shown}: {cause}"))?;
    let particles = Particles::read(&text).map_err(|cause| format!("{shown}: {cause}"))?;
    let parameters = parameters(arguments, &particles)?;
    if !(arguments.shake.is_finite() && arguments.shake >= 0.0) {
        return Err(format!("shake is {}, expected a number from 0", arguments.shake).into());
    }
    let reference = arguments.reference.as_deref().map(Reference::read).transpose()?;
    // whatever cannot be written should show before the work, not after
    std::fs::create_dir_all(&arguments.out).map_err(|cause| format!("{}: {cause}", arguments.out.display()))?;
    let runs = run_seeds(arguments, &particles, &parameters)?;
    write(arguments, &particles, &parameters, reference.as_ref(), &runs)
}

fn parameters(arguments: &Arguments, particles: &Particles) -> Result<Parameters, Box<dyn Error>> {
    let given = arguments.period.as_ref().map(|period| [period[0], period[1]]);
    let period = given.or(particles.period).ok_or("the file's first line states no period: expected `--period X Y`")?;
    let parameters = Parameters {
        period,
        density: arguments.density,
        normal_stiffness: arguments.kn,
        shear_stiffness: arguments.kt,
        friction: arguments.friction,
        damping: arguments.damping,
        gravity: arguments.gravity,
        time_step: arguments.dt,
        settle_steps: arguments.settle,
        gap: arguments.gap,
        seat_speed: arguments.seat_speed,
        speed: arguments.speed,
        low: 1e3 * arguments.low,
        high: 1e3 * arguments.high,
        cycles: arguments.cycles,
        interval: arguments.interval,
    };
    parameters.check()?;
    Ok(parameters)
}

/// A run and how long it took.
struct Timed {
    outcome: Outcome,
    seconds: f64,
}

/// Runs every seed on threads of its own; a result does not depend on their number.
fn run_seeds(
    arguments: &Arguments,
    particles: &Particles,
    parameters: &Parameters,
) -> Result<Vec<Timed>, Box<dyn Error>> {
    let seeds = arguments.seeds as usize;
    let threads =
        arguments.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from)).max(1);
    let (workers, each) = (threads.min(seeds), (threads / seeds).max(1));
    let board = Board::new(seeds);
    let next = AtomicUsize::new(0);
    let results: Vec<Mutex<Option<Result<Timed, Trouble>>>> = (0..seeds).map(|_| Mutex::new(None)).collect();
    let work = || -> Result<(), rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(each).build()?;
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(result) = results.get(index) else { return Ok(()) };
            let seed = arguments.seed.wrapping_add(index as u64);
            let bed = particles.shaken(seed, arguments.shake);
            let start = Instant::now();
            let tell = |done, all| board.tell(index, done, all);
            let outcome = pool.install(|| match arguments.precision {
                Precision::Single => run::<f32>(&bed, parameters, tell),
                Precision::Double => run::<f64>(&bed, parameters, tell),
            });
            let timed = outcome.map(|outcome| Timed { outcome, seconds: start.elapsed().as_secs_f64() });
            *result.lock().unwrap_or_else(|e| e.into_inner()) = Some(timed);
        }
    };
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        handles.into_iter().try_for_each(|handle| match handle.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })?;
    board.bar.finish_and_clear();
    let results = results.into_iter().filter_map(|r| r.into_inner().unwrap_or_else(|e| e.into_inner()));
    results
        .zip(arguments.seed..)
        .map(|(result, seed)| result.map_err(|trouble| format!("seed {seed}: {trouble}").into()))
        .collect()
}

/// Progress of all seeds together, on a terminal only.
struct Board {
    bar: ProgressBar,
    /// Steps done and expected of each seed; those of a seed that has not begun are as the first's.
    seeds: Mutex<Vec<Option<(u64, u64)>>>,
}

impl Board {
    fn new(seeds: usize) -> Board {
        let bar = if std::io::stderr().is_terminal() { ProgressBar::new(1) } else { ProgressBar::hidden() };
        let style = ProgressStyle::with_template("{spinner} {bar:32} {pos}/{len} steps, about {eta} left");
        Board {
            bar: bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())),
            seeds: Mutex::new(vec![None; seeds]),
        }
    }

    fn tell(&self, seed: usize, done: u64, all: u64) {
        let mut seeds = self.seeds.lock().unwrap_or_else(|e| e.into_inner());
        seeds[seed] = Some((done, all));
        self.bar.set_length(seeds.iter().map(|s| s.map_or(all, |s| s.1)).sum());
        self.bar.set_position(seeds.iter().map(|s| s.map_or(0, |s| s.0)).sum());
    }
}

fn write(
    arguments: &Arguments,
    particles: &Particles,
    parameters: &Parameters,
    reference: Option<&Reference>,
    runs: &[Timed],
) -> Result<(), Box<dyn Error>> {
    let out = &arguments.out;
    for (index, (run, seed)) in runs.iter().zip(arguments.seed..).enumerate() {
        let folder = if index == 0 { out.clone() } else { out.join(format!("seed_{seed}")) };
        files::write_run(&folder, &run.outcome, parameters)?;
    }
    let all: Vec<_> = runs.iter().map(|run| observables(&run.outcome.compression, &run.outcome.cycles)).collect();
    let other = reference.map_or(Vec::new(), |r| observables(&r.compression, &r.cycles));
    let scatter = scatter(&all, &other);
    files::write_scatter(&out.join("scatter.csv"), &scatter)?;
    let summary = summary(arguments, particles, parameters, runs, &scatter);
    std::fs::write(out.join("summary.json"), serde_json::to_string_pretty(&summary)? + "\n")?;
    let outcomes: Vec<Outcome> = runs.iter().map(|run| run.outcome.clone()).collect();
    let name = format!(
        "Oedometer: {} spheres, plate at {} mm/s between {} and {} kPa",
        particles.radii.len(),
        rounded(1e3 * parameters.speed),
        arguments.low,
        arguments.high
    );
    std::fs::write(out.join("oedometer.svg"), picture::draw(&outcomes, reference, &name))?;
    tell(out, runs, &scatter, particles.radii.len());
    Ok(())
}

fn summary(
    arguments: &Arguments,
    particles: &Particles,
    parameters: &Parameters,
    runs: &[Timed],
    scatter: &[Scatter],
) -> serde_json::Value {
    let spheres = particles.radii.len();
    let weight = particles.solid_volume() * parameters.density * parameters.gravity;
    let seeds: Vec<_> = runs
        .iter()
        .zip(arguments.seed..)
        .map(|(run, seed)| {
            serde_json::json!({
                "seed": seed,
                "steps": run.outcome.steps,
                "wall_seconds": run.seconds,
                "sphere_steps_per_second": speed(run, spheres),
                "settled_floor_kPa": run.outcome.compression[0].floor_kpa,
            })
        })
        .collect();
    serde_json::json!({
        "spheres": spheres,
        "solid_volume_m3": particles.solid_volume(),
        "weight_over_area_kPa": weight / parameters.area() / 1e3,
        "parameters": parameters,
        "precision": format!("{:?}", arguments.precision).to_lowercase(),
        "shake_m": arguments.shake,
        "seeds": seeds,
        "observables": scatter,
    })
}

fn speed(run: &Timed, spheres: usize) -> f64 {
    run.outcome.steps as f64 * spheres as f64 / run.seconds
}

/// What a person wants to know first.
fn tell(out: &Path, runs: &[Timed], scatter: &[Scatter], spheres: usize) {
    println!("{:<28} {:>6} {:>11} {:>9} {:>11} {:>9}", "", "at", "mean", "sd", "reference", "bar");
    let digits = |value: Option<f64>, digits: usize| value.map_or(String::new(), |v| format!("{v:.digits$}"));
    for row in scatter.iter().filter(|row| row.bar.is_some() || row.observable != "settlement of the cycle") {
        let sign = row.within.map_or("", |within| if within { "within" } else { "OUTSIDE" });
        println!(
            "{:<28} {:>6} {:>11.4} {:>9} {:>11} {:>9} {sign}",
            format!("{} [{}]", row.observable, row.unit),
            row.at,
            row.mean,
            digits(row.standard_deviation, 4),
            digits(row.reference, 4),
            digits(row.bar, 4)
        );
    }
    for run in runs {
        println!("{} steps in {:.1} s: {:.2e} sphere-steps/s", run.outcome.steps, run.seconds, speed(run, spheres));
    }
    println!("{}", out.display());
}

/// Without the last digits of a product.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}
