//! `trackbed run`: runs a scene into a directory, with checkpoints, a report and the verdict on its expectations.

use super::scene::{SceneArguments, SeedArgument, failed, not_yet, show};
use super::{Outcome, pack, progress, report, rig, terminal};
use crate::diag::{Code, Diagnostic, render};
use crate::graph;
use crate::lower;
use crate::results::{self, BlockRow, Run, RunRecorder, Scalar, Store, Verdict, checkpoint};
use crate::scenario::Scenario;
use crate::units::number;
use crate::{Compiled, fingerprint};
use std::collections::BTreeMap;
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
    let started = Instant::now();
    // before anything is done side by side: the pool is made once
    if let Some(threads) = arguments.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
        if let Err(error) = pool {
            terminal::error(&format!("cannot start {threads} threads: {error}"));
            return Outcome::Failed;
        }
    }
    let Some(compiled) = arguments.scene.with_seed(&arguments.seed).compile().map(Compiled::to_run) else {
        return Outcome::Usage;
    };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    if let Some(scenario) = compiled.scenario.as_ref().filter(|scenario| lower::is_rig(scenario)) {
        return run_rig(arguments, &compiled, scenario);
    }
    let (Some(scenario), Some(graph)) = (&compiled.scenario, &compiled.graph) else {
        return not_yet(&compiled);
    };
    let hash = fingerprint(&compiled.sources);
    if let Err(message) = prepare(arguments) {
        return stop(
            &compiled,
            Diagnostic::new(Code::E0802, message).help("give another `--out`, or `--resume` or `--force`"),
        );
    }
    let bar = progress::bar();
    let store = Store { directory: arguments.out.clone(), scene_sha256: hash.clone() };
    let mut recorder = RunRecorder::new(scenario, Some(store), |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    });
    let from = match arguments.resume.then(|| recorder.resume()).transpose() {
        Ok(from) => from.flatten(),
        Err(error) => {
            return stop(
                &compiled,
                Diagnostic::new(Code::E0803, error.to_string()).help("run without `--resume`, with `--force`"),
            );
        }
    };
    let outcome = graph::execute(graph, &mut recorder, from);
    bar.finish_and_clear();
    if let Err(error) = outcome {
        return stop(&compiled, results::diagnose(&error, scenario, graph));
    }
    let computed = started.elapsed().as_secs_f64();
    let run = Run::gather(&recorder, scenario, graph, &compiled.sources, hash);
    drop(recorder);
    match write(&run, &arguments.out, computed, &started) {
        Ok(page) => summary(&run, &page, computed),
        Err(message) => return stop(&compiled, Diagnostic::new(Code::E0802, message)),
    }
    warn(&run, &compiled);
    verdicts(&run.summary.expectations, scenario, &compiled)
}

/// The rig of a scene, in the directory that the arguments name.
fn run_rig(arguments: &Arguments, compiled: &Compiled, scenario: &Scenario) -> Outcome {
    // what cannot be packed is told before a directory is made
    if let Err(mistakes) = lower::rig(scenario) {
        terminal::note(&render::human(&mistakes, &compiled.sources, terminal::colour(), terminal::width()));
        return Outcome::Failed;
    }
    if let Err(message) = prepare(arguments) {
        let help = "give another `--out`, or `--resume` or `--force`";
        return stop(compiled, Diagnostic::new(Code::E0802, message).help(help));
    }
    let beds = pack::beds(arguments.cache.as_deref());
    let options = rig::Options { out: &arguments.out, beds, resume: arguments.resume };
    rig::run_rig(compiled, scenario, &options)
}

/// Says where exchanges of forces and settlement overshot.
fn warn(run: &Run, compiled: &Compiled) {
    let Some(found) = BlockRow::overshoot(&run.blocks) else { return };
    let diagnostic = Diagnostic::new(Code::E0807, found).help("write `update_every = adaptive`");
    let diagnostic = match run.scenario.solve.update_span {
        Some(span) => diagnostic.at(span, "too long between two exchanges"),
        None => diagnostic,
    };
    terminal::note(&render::human(&[diagnostic], &compiled.sources, terminal::colour(), terminal::width()));
}

pub(super) fn stop(compiled: &Compiled, diagnostic: Diagnostic) -> Outcome {
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

fn write(run: &Run, out: &Path, computed: f64, started: &Instant) -> Result<PathBuf, String> {
    results::write(run, out).map_err(|e| e.to_string())?;
    let page = report::write(run, out, false)?;
    let timings = BTreeMap::from([
        ("solve_s".to_string(), computed),
        ("total_s".to_string(), started.elapsed().as_secs_f64()),
        ("threads".to_string(), rayon::current_num_threads() as f64),
    ]);
    results::write_timings(&timings, out).map_err(|e| e.to_string())?;
    checkpoint::remove(out).map_err(|e| e.to_string())?;
    Ok(page)
}

/// The few numbers that people ask for first.
fn summary(run: &Run, page: &Path, seconds: f64) {
    let mut out = format!("{}\n", run.scenario.title);
    let lines: [(&str, &str, &str, f64); 9] = [
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
    headline(&mut out, &run.summary.scalars, &lines);
    if let Some(spread) = run.summary.scalars.get("law_spread") {
        out.push_str(&format!("  {:<26}{}\n", "spread between laws", number((spread.value * 1e2).round() / 1e2)));
    }
    for sentence in results::unsettled(&run.scenario, &run.blocks, &run.laws) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out.push_str(&format!("{} ({} s)\n", page.display(), number((seconds * 10.0).round() / 10.0)));
    terminal::out(&out);
}

/// A line for each scalar that there is, in its unit of so many SI units, with the band of its mean where it has one.
pub(super) fn headline(out: &mut String, scalars: &BTreeMap<String, Scalar>, lines: &[(&str, &str, &str, f64)]) {
    for (name, label, unit, size) in lines {
        let rounded = |value: f64| number((value / size * 1e4).round() / 1e4);
        let Some(scalar) = scalars.get(*name) else { continue };
        let band = scalars.get(&format!("{name}_confidence"));
        let band = band.map_or(String::new(), |half| format!(" +- {}", rounded(half.value)));
        out.push_str(&format!("  {label:<26}{}{band} {unit}\n", rounded(scalar.value)));
    }
}

/// Names every expectation that was missed.
pub(super) fn verdicts(verdicts: &[Verdict], scenario: &Scenario, compiled: &Compiled) -> Outcome {
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
