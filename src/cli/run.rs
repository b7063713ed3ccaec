//! `trackbed run`: runs a scene into a directory, with checkpoints, a report and the verdict on its expectations.

use super::scene::{SceneArguments, SeedArgument, failed, not_yet, show};
use super::{Outcome, pack, progress, report, terminal};
use crate::compile::{Compiled, fingerprint};
use crate::diag::{Code, Diagnostic, render};
use crate::execute::{Both, Ending, Event, Executor, Listener};
use crate::graph::{Graph, Schedule};
use crate::lower::Parameter;
use crate::results::{self, BedTestsView, BlockRow, NamedBytes, Run, RunRecorder, Scalar, Store, Verdict, checkpoint};
use crate::scenario::Scenario;
use crate::units::number;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Run a scene and write its results and report
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    seed: SeedArgument,
    /// The directory for results; made where it does not exist.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Go on where an interrupted run of the same scene stopped.
    #[arg(long)]
    resume: bool,
    /// Threads that the run may use; all cores where it is not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Replace the results of another run in that directory.
    #[arg(long)]
    force: bool,
    /// Where the packed beds of test rigs are kept, by what made them
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(threads) = arguments.threads else { return run_here(arguments) };
    match rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build() {
        Ok(pool) => pool.install(|| run_here(arguments)),
        Err(error) => {
            terminal::error(&format!("cannot start {threads} threads: {error}"));
            Outcome::Failed
        }
    }
}

/// Runs in the pool of threads of the caller.
fn run_here(arguments: &Arguments) -> Outcome {
    let started = Instant::now();
    let Some(compiled) = arguments.scene.with_seed(&arguments.seed).compile().map(Compiled::to_run) else {
        return Outcome::Usage;
    };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        return not_yet(&compiled);
    };
    if let Err(message) = prepare(arguments) {
        let help = "give another `--out`, or `--resume` or `--force`";
        return stop(&compiled, Diagnostic::new(Code::E0802, message).help(help));
    }
    let hash = fingerprint(&compiled.sources);
    let store = Store { directory: arguments.out.clone(), scene_sha256: hash.clone() };
    let mut recorder = RunRecorder::new(scenario, graph).kept_in(store);
    let from = match arguments.resume.then(|| recorder.resume()).transpose() {
        Ok(from) => from.flatten(),
        Err(error) => {
            let mistake = Diagnostic::new(Code::E0803, error.to_string());
            return stop(&compiled, mistake.help("run without `--resume`, with `--force`"));
        }
    };
    let executor = Executor::default().with_beds(pack::beds(arguments.cache.as_deref()));
    let mut shown = Shown::new(graph);
    let ended = executor.run(graph, &mut Both(&mut recorder, &mut shown), from);
    drop(shown);
    match ended {
        Ok(Ending::Finished) => {}
        Ok(Ending::Stopped) => {
            let why = recorder.failure().map_or_else(|| "the run was ended".to_owned(), |error| error.to_string());
            return stop(&compiled, Diagnostic::new(Code::E0802, why).help("the run can be resumed with `--resume`"));
        }
        Err(error) => return stop(&compiled, results::diagnose(&error, graph, &compiled.origins)),
    }
    let computed = started.elapsed().as_secs_f64();
    let run = Run::gather(&recorder, scenario, graph, &compiled.sources, hash);
    match write(&run, recorder, &arguments.out, computed, &started) {
        Ok(page) => summary(&run, &page, computed),
        Err(message) => return stop(&compiled, Diagnostic::new(Code::E0802, message)),
    }
    warn(&run, &compiled);
    verdicts(&run.summary.expectations, scenario, &compiled)
}

/// Shows how far a run is, on a terminal or in a line a minute.
struct Shown {
    bar: progress::Patient,
    tests: bool,
}

impl Shown {
    fn new(graph: &Graph) -> Shown {
        let tests = matches!(graph.schedule, Schedule::Actuators(_));
        Shown { bar: progress::Patient::new(if tests { "the bed" } else { "the run" }), tests }
    }
}

impl Listener for Shown {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Packing(progress) => pack::at(&mut self.bar, progress),
            Event::Packed { found, .. } => {
                pack::tell_loss(found);
                self.bar = progress::Patient::new("the test");
            }
            Event::Tested { .. } if self.tests => self.bar = progress::Patient::new("the bed"),
            Event::Progress { done, all } => self.bar.at(*done, *all),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

/// Says where exchanges of forces and settlement overshot.
fn warn(run: &Run, compiled: &Compiled) {
    let Some(found) = BlockRow::overshoot(&run.blocks) else { return };
    let diagnostic = Diagnostic::new(Code::E0807, found).help("write `update_every = adaptive`");
    let diagnostic = match compiled.origins.span(Parameter::Update) {
        Some(span) => diagnostic.at(span, "too long between two exchanges"),
        None => diagnostic,
    };
    terminal::note(&render::human(&[diagnostic], &compiled.sources, terminal::colour(), terminal::width()));
}

fn stop(compiled: &Compiled, diagnostic: Diagnostic) -> Outcome {
    terminal::note(&render::human(&[diagnostic], &compiled.sources, terminal::colour(), terminal::width()));
    Outcome::Failed
}

/// Makes the directory ready: the results of another run are not overwritten by accident.
fn prepare(arguments: &Arguments) -> Result<(), String> {
    let out = &arguments.out;
    let shown = out.display();
    if out.is_file() {
        return Err(format!("`{shown}` is a file, not a directory"));
    }
    std::fs::create_dir_all(out).map_err(|e| format!("cannot make the directory `{shown}`: {e}"))?;
    let holds = |name: &str| out.join(name).exists();
    if arguments.force {
        results::remove_states(out).map_err(|e| e.to_string())?;
        for name in ["summary.json", "checkpoint.json", "histories.parquet", "laws.csv"] {
            if holds(name) {
                std::fs::remove_file(out.join(name)).map_err(|e| format!("cannot replace `{shown}/{name}`: {e}"))?;
            }
        }
    }
    if holds("summary.json") {
        return Err(format!("`{shown}` holds the results of a finished run"));
    }
    if holds("checkpoint.json") && !arguments.resume {
        return Err(format!("`{shown}` holds an interrupted run"));
    }
    Ok(())
}

/// Every file of a finished run, its page among them.
fn files(run: &Run, mut recorder: RunRecorder<'_>, out: &Path) -> Result<Vec<NamedBytes>, String> {
    let failure = |error: &dyn std::fmt::Display| format!("cannot write the results: {error}");
    let view = match &mut recorder.last_bed {
        Some(bed) => BedTestsView::new(run.clone(), bed).map_err(|error| failure(&error))?,
        None => None,
    };
    match view {
        Some(view) => {
            let files = results::test_files(&view, out).map_err(|error| failure(&error))?;
            Ok([report::test_pages(&view, false), files].concat())
        }
        None => {
            let files = results::files(run, out).map_err(|error| failure(&error))?;
            Ok([files, report::run_pages(run, false)].concat())
        }
    }
}

fn write(
    run: &Run,
    recorder: RunRecorder<'_>,
    out: &Path,
    computed: f64,
    started: &Instant,
) -> Result<PathBuf, String> {
    let files = files(run, recorder, out)?;
    results::write_files(&files, out).map_err(|e| e.to_string())?;
    let timings = BTreeMap::from([
        ("solve_s".to_string(), computed),
        ("total_s".to_string(), started.elapsed().as_secs_f64()),
        ("threads".to_string(), rayon::current_num_threads() as f64),
    ]);
    let timings = results::timings_file(&timings, out).map_err(|e| e.to_string())?;
    results::write_files(&[timings], out).map_err(|e| e.to_string())?;
    checkpoint::remove(out).map_err(|e| e.to_string())?;
    Ok(out.join(report::PAGE))
}

/// The few numbers that people ask for first.
fn summary(run: &Run, page: &Path, seconds: f64) {
    let mut out = format!("{}\n", run.scenario.title);
    headline(&mut out, &run.summary.scalars, if run.tests.is_some() { &OF_TESTS } else { &OF_TRACKS });
    if let Some(spread) = run.summary.scalars.get("law_spread") {
        out.push_str(&format!("  {:<26}{}\n", "spread between laws", number((spread.value * 1e2).round() / 1e2)));
    }
    for sentence in results::unsettled(&run.scenario, &run.blocks, &run.laws) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out.push_str(&format!("{} ({} s)\n", page.display(), number((seconds * 10.0).round() / 10.0)));
    terminal::out(&out);
}

/// A scalar, how it is called, its unit, and that unit in SI.
type Line = (&'static str, &'static str, &'static str, f64);

const OF_TRACKS: [Line; 9] = [
    ("max_settlement", "largest settlement", "mm", 1e-3),
    ("max_settlement_x", "  at", "m", 1.0),
    ("far_field_settlement", "far-field settlement", "mm", 1e-3),
    ("voided_sleepers", "voided sleepers", "", 1.0),
    ("max_wheel_force", "largest wheel force", "kN", 1e3),
    ("dynamic_amplification", "dynamic amplification", "", 1.0),
    ("max_rail_seat_load", "largest rail seat load", "kN", 1e3),
    ("max_rail_moment", "largest rail moment", "kN m", 1e3),
    ("max_rail_displacement", "largest rail displacement", "mm", 1e-3),
];

const OF_TESTS: [Line; 10] = [
    ("max_settlement", "settlement", "mm", 1e-3),
    ("first_settlement", "  after one cycle", "mm", 1e-3),
    ("support_stiffness", "resilient stiffness", "MN/m", 1e6),
    ("oedometric_modulus", "oedometric modulus", "MPa", 1e6),
    ("peak_deviator", "largest deviator", "kPa", 1e3),
    ("peak_friction_angle", "largest angle of friction", "deg", std::f64::consts::PI / 180.0),
    ("peak_strain", "  at a strain of", "%", 0.01),
    ("cycles", "cycles", "", 1.0),
    ("repeats", "packings", "", 1.0),
    ("grains", "grains", "", 1.0),
];

/// A line for each scalar that there is, in its unit of so many SI units, with the band of its mean where it has one.
fn headline(out: &mut String, scalars: &BTreeMap<String, Scalar>, lines: &[Line]) {
    for (name, label, unit, size) in lines {
        let rounded = |value: f64| number((value / size * 1e4).round() / 1e4);
        let Some(scalar) = scalars.get(*name) else { continue };
        let band = scalars.get(&format!("{name}_confidence"));
        let band = band.map_or(String::new(), |half| format!(" +- {}", rounded(half.value)));
        out.push_str(&format!("  {label:<26}{}{band} {unit}\n", rounded(scalar.value)));
    }
}

/// Names every expectation that was missed.
fn verdicts(verdicts: &[Verdict], scenario: &Scenario, compiled: &Compiled) -> Outcome {
    let missed: Vec<Diagnostic> = verdicts
        .iter()
        .zip(&scenario.expectations)
        .filter(|(verdict, _)| !verdict.met)
        .map(|(verdict, expectation)| {
            let values: Vec<String> =
                verdict.values.iter().map(|v| format!("{} {}", number(*v), verdict.unit)).collect();
            let found = verdict.problem.clone().unwrap_or_else(|| values.join(", "));
            Diagnostic::new(Code::E0804, format!("expected `{}`, found {found}", verdict.text))
                .at(expectation.span, "not met")
        })
        .collect();
    if missed.is_empty() {
        return Outcome::Fine;
    }
    terminal::note(&render::human(&missed, &compiled.sources, terminal::colour(), terminal::width()));
    Outcome::Failed
}
