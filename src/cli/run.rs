//! `trackbed run`: runs a scene into a directory, with checkpoints, a report and the verdict on its expectations.

use super::cluster::{self, ClusterArguments, Elsewhere, Executor as Place};
use super::interrupt::Endable;
use super::memory::MemoryArgument;
use super::run_elsewhere::{self, ToTheLastAxle};
use super::run_progress::Shown;
use super::scene::{PassArguments, SceneArguments, SeedArgument, failed, not_yet, show};
use super::task::Packings;
use super::{Outcome, interrupt, memory, pack, report, stored, terminal};
use crate::compile::{Compiled, fingerprint};
use crate::diag::{Code, Diagnostic, Sources};
use crate::execute::{self, Both, Ending, Event, Executor, Listener};
use crate::graph::Graph;
use crate::lower::Parameter;
use crate::results::{
    self, BedTestsView, BlockRow, Label, NamedBytes, ResultsError, Run, RunRecorder, Scalar, Source, Verdict,
};
use crate::scenario::Scenario;
use crate::solvers::granular::Bed;
use crate::store::{Directory, Finished, Mode, StoreError, Unfinished, Work};
use crate::units::number;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Run a scene and write its results and report
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed run scenarios/transition.track --out out
  trackbed run scenarios/transition.track --out out --resume
  trackbed run scenarios/transition.track --set 'traffic.total=1000 axles' --out longer
  trackbed run scenarios/transition_full.track --out full --executor slurm --dry-run")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    seed: SeedArgument,
    #[command(flatten)]
    passes: PassArguments,
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
    #[command(flatten)]
    memory: MemoryArgument,
    /// Where the packed beds of test rigs are kept, by what made them
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    cluster: ClusterArguments,
    /// Whether this is `trackbed work` for a run of another process.
    #[arg(skip)]
    is_worker: bool,
}

/// Stack of a thread of a run, bytes: that of the main thread of most systems.
const STACK: usize = 8 << 20;

pub(super) fn run(arguments: &Arguments) -> Outcome {
    if arguments.cluster.are_misused() {
        return Outcome::Usage;
    }
    // from within the pool: a thread outside it would sleep and wake in every step of a small bed
    let threads = arguments.threads.map_or(0, usize::from);
    match rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build() {
        Ok(pool) => pool.install(|| run_here(arguments)),
        Err(error) => {
            terminal::error(&format!("cannot start threads: {error}"));
            Outcome::Failed
        }
    }
}

/// Runs in the pool of threads of the caller.
fn run_here(arguments: &Arguments) -> Outcome {
    let scene = arguments.scene.with_seed(&arguments.seed);
    let Some(compiled) = scene.compile_without(&arguments.passes).map(Compiled::to_run) else {
        return Outcome::Usage;
    };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        return not_yet(&compiled);
    };
    if arguments.cluster.dry_run {
        return dry_run(arguments, &compiled, graph, scenario);
    }
    let refusal = arguments.memory.refusal(graph).filter(|_| arguments.cluster.executor == Place::Local);
    if let Some(refusal) = refusal {
        return stop(&compiled, refusal);
    }
    if let Err(error) = arguments.asked().reach() {
        return stop(&compiled, cluster::diagnostic(&error));
    }
    let asked = interrupt::asked();
    arguments.memory.watch(Some(scenario));
    let running = Running::new(&scene, &compiled, (scenario, graph), asked);
    let directory = match Directory::open(&arguments.out, running.work(arguments), arguments.mode()) {
        Ok(directory) => match directory.finished() {
            Some(finished) => return again(finished, directory.path(), &compiled),
            None => directory,
        },
        Err(error) => match given_to_slurm(arguments, &error, &running) {
            Some(state) => return watched_again(arguments, &state, &running),
            None => return stop(&compiled, stored::diagnostic(&error)),
        },
    };
    let has_further = run_elsewhere::needs(graph, scenario).len() > 1;
    if has_further && let Err(error) = run_elsewhere::begin(&directory) {
        return stop(&compiled, stored::diagnostic(&error));
    }
    let ready = match arguments.cluster.executor {
        Place::Local => further_packings(arguments, &running).map(|()| directory),
        Place::Slurm | Place::Workers => computed_elsewhere(arguments, directory, &running),
    };
    finished(arguments, ready, &running)
}

/// Computes what is left of a run, and gives the verdict on its expectations.
fn finished(arguments: &Arguments, ready: Result<Directory, Outcome>, running: &Running<'_>) -> Outcome {
    let run = ready.and_then(|directory| compute(arguments, directory, running));
    let verdict = |run: Run| verdicts(&run.summary.expectations, running.scenario, running.compiled);
    run.map_or_else(|outcome| outcome, verdict)
}

/// The state of a run that Slurm computes, if a task of the run has the directory now. A task has it as long as it
/// computes the run itself, also while nobody watches.
fn given_to_slurm(arguments: &Arguments, error: &StoreError, running: &Running<'_>) -> Option<Unfinished> {
    let is_meant = arguments.resume && arguments.cluster.executor == Place::Slurm;
    if !is_meant || !matches!(error, StoreError::Busy { .. }) {
        return None;
    }
    let state = Unfinished::open(&arguments.out).ok()??;
    (*state.work() == running.work(arguments) && cluster::has_ledger(&state)).then_some(state)
}

/// Watches the tasks of a run whose directory a task has, to the end of the run.
fn watched_again(arguments: &Arguments, state: &Unfinished, running: &Running<'_>) -> Outcome {
    let ready = further_works(arguments, running).and_then(|works| watched(arguments, state, running, works));
    finished(arguments, ready, running)
}

/// Shows what a cluster would be asked for.
fn dry_run(arguments: &Arguments, compiled: &Compiled, graph: &Graph, scenario: &Scenario) -> Outcome {
    match arguments.asked().dry_run(&run_elsewhere::needs(graph, scenario)) {
        Ok(scripts) => {
            terminal::out(&scripts);
            Outcome::Fine
        }
        Err(error) => stop(compiled, cluster::diagnostic(&error)),
    }
}

/// Has other processes compute all packings. Gives the directory back, to go on from there.
fn computed_elsewhere(
    arguments: &Arguments,
    directory: Directory,
    running: &Running<'_>,
) -> Result<Directory, Outcome> {
    let works = further_works(arguments, running)?;
    let of_store = |error| stop(running.compiled, stored::diagnostic(&error));
    run_elsewhere::begin(&directory).map_err(of_store)?;
    let state = directory.shared().clone();
    // the lock is for the process that computes the run itself
    drop(directory);
    watched(arguments, &state, running, works)
}

/// Waits until other processes have computed all packings. Gives the directory, to go on from there.
fn watched(
    arguments: &Arguments,
    state: &Unfinished,
    running: &Running<'_>,
    works: Vec<(PathBuf, Work)>,
) -> Result<Directory, Outcome> {
    let of_run = (run_elsewhere::needs(running.graph, running.scenario), works);
    match run_elsewhere::perform(arguments.packings(), &arguments.asked(), state, of_run) {
        Ok(None) => {}
        Ok(Some(outcome)) => return Err(outcome),
        Err(error) => return Err(stop(running.compiled, cluster::diagnostic(&error))),
    }
    let opened = Directory::open(&arguments.out, running.work(arguments), Mode::Resume);
    opened.map_err(|error| stop(running.compiled, stored::diagnostic(&error)))
}

/// What each further packing is, by its directory: results of another scene that lie there are not those of this one.
fn further_works(arguments: &Arguments, running: &Running<'_>) -> Result<Vec<(PathBuf, Work)>, Outcome> {
    let seeds = (1..run_elsewhere::needs(running.graph, running.scenario).len() as u64)
        .map(|further| running.scenario.solve.seed + further);
    let work = |seed: u64| {
        let scene = arguments.scene.with_seed(&SeedArgument::with(seed));
        let compiled = scene.compile_without(&arguments.passes).ok_or(Outcome::Usage)?;
        let work = Work { name: arguments.name(), scene_sha256: fingerprint(&compiled.sources) };
        Ok((results::packing_directory(&arguments.out, seed), work))
    };
    seeds.map(work).collect()
}

/// Computes packings of a run that another process watches.
pub(super) fn packings_of(run: &Path, packings: &Packings) -> Result<(), Outcome> {
    let arguments = Arguments::of_packings(run, packings);
    let scene = &arguments.scene;
    let compiled = scene.compile_without(&arguments.passes).map(Compiled::to_run).ok_or(Outcome::Usage)?;
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        show(&compiled);
        return Err(not_yet(&compiled));
    };
    let asked = interrupt::asked();
    let running = Running::new(scene, &compiled, (scenario, graph), asked);
    for packing in &packings.packings {
        match packing {
            0 => to_the_last_axle(&arguments, &running)?,
            further => one_packing(&arguments, scenario.solve.seed + u64::from(*further), asked)?,
        }
    }
    Ok(())
}

/// Computes a run up to its last axle, and keeps its state there.
fn to_the_last_axle(arguments: &Arguments, running: &Running<'_>) -> Result<(), Outcome> {
    let Running { compiled, sha256, scenario, graph, asked, .. } = running;
    let directory = Directory::open(&arguments.out, running.work(arguments), Mode::Resume)
        .map_err(|error| stop(compiled, stored::diagnostic(&error)))?;
    let end = ToTheLastAxle::new(graph);
    let source = Source { sources: &compiled.sources, sha256, diagnostics: &compiled.diagnostics };
    let mut recorder =
        RunRecorder::new(scenario, graph).kept_in(&directory).made_by(source).interrupted_by(end.reached());
    let from = recorder.resume().map_err(|error| stop(compiled, results_diagnostic(&error)))?;
    let executor = Executor::default().with_beds(pack::beds(arguments.cache.as_deref()));
    let (mut recording, endable) = Recording::endable(&mut recorder, directory.path(), true);
    let ended = executor.run(graph, &mut Both(&mut &end, &mut recording), from);
    drop(endable);
    match (ended, recorder.failure()) {
        (Err(error), _) => return Err(stop(compiled, execute::diagnose(&error, graph, &compiled.origins))),
        (Ok(_), Some(error)) => return Err(stop(compiled, results_diagnostic(&error))),
        (Ok(_), None) if asked.load(Ordering::Relaxed) => {
            return Err(stopped(directory.path(), true, recorder.has_kept()));
        }
        (Ok(_), None) => {}
    }
    drop(recorder);
    // whoever sees the word takes up the directory
    drop(directory);
    run_elsewhere::computed(&arguments.out).map_err(|error| stop(compiled, stored::diagnostic(&error)))
}

/// Runs the scene of a track on grains on the further packings that it asks for, each in a directory of its own below
/// that of the run.
fn further_packings(arguments: &Arguments, running: &Running<'_>) -> Result<(), Outcome> {
    let solve = &running.scenario.solve;
    let further = if running.graph.has_grains_under_track() { solve.grains.repeats - 1 } else { 0 };
    for number in 1..=u64::from(further) {
        let seed = solve.seed + number;
        terminal::note(&format!("packing {number} of {}: seed {seed}\n", further + 1));
        one_packing(arguments, seed, running.asked)?;
    }
    if further > 0 {
        terminal::note(&format!("packing {0} of {0}: seed {1}\n", further + 1, solve.seed));
    }
    Ok(())
}

/// Runs the scene on the packing of another seed, or goes on with it.
fn one_packing(arguments: &Arguments, seed: u64, asked: &'static AtomicBool) -> Result<(), Outcome> {
    let scene = arguments.scene.with_seed(&SeedArgument::with(seed));
    let compiled = scene.compile_without(&arguments.passes).map(Compiled::to_run).ok_or(Outcome::Usage)?;
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        show(&compiled);
        return Err(not_yet(&compiled));
    };
    let running = Running::new(&scene, &compiled, (scenario, graph), asked);
    let open = |mode| Directory::open(&results::packing_directory(&arguments.out, seed), running.work(arguments), mode);
    let directory = match (arguments.force, arguments.is_worker) {
        (true, false) => open(Mode::Force),
        // an earlier attempt at this very packing goes on
        (true, true) => open(Mode::Resume).or_else(|error| match error.is_of_another() {
            true => open(Mode::Force),
            false => Err(error),
        }),
        (false, _) => open(Mode::Resume),
    };
    let directory = directory.map_err(|error| stop(&compiled, stored::diagnostic(&error)))?;
    if directory.finished().is_some() { Ok(()) } else { compute(arguments, directory, &running).map(drop) }
}

impl Arguments {
    /// Those of a process that computes packings for another one.
    fn of_packings(run: &Path, packings: &Packings) -> Arguments {
        Arguments {
            scene: SceneArguments { file: packings.scene.clone(), set: packings.set.clone() },
            seed: SeedArgument::default(),
            passes: PassArguments { without: packings.without.clone() },
            out: run.to_owned(),
            resume: true,
            threads: None,
            force: packings.force,
            memory: MemoryArgument::default(),
            cache: packings.cache.clone(),
            cluster: ClusterArguments::default(),
            is_worker: true,
        }
    }

    fn asked(&self) -> Elsewhere<'_> {
        Elsewhere { arguments: &self.cluster, name: "run", out: &self.out, at_a_time: None }
    }

    /// What a process needs that computes packings.
    fn packings(&self) -> Packings {
        let SceneArguments { file, set } = self.scene.with_seed(&self.seed);
        let (without, cache) = (self.passes.without.clone(), self.cache.as_deref().map(cluster::absolute));
        Packings { scene: cluster::absolute(&file), set, without, cache, force: self.force, packings: Vec::new() }
    }

    /// What is done in the directory: a run without some passes is another work.
    fn name(&self) -> String {
        let without = self.passes.without.join("`, `");
        if without.is_empty() { "run".to_owned() } else { format!("run without `{without}`") }
    }

    fn mode(&self) -> Mode {
        match (self.force, self.resume) {
            (true, _) => Mode::Force,
            (false, true) => Mode::Resume,
            (false, false) => Mode::New,
        }
    }
}

/// A run on its way.
struct Running<'a> {
    compiled: &'a Compiled,
    sha256: String,
    /// The whole scene as one file, kept beside its results.
    resolved: Option<String>,
    scenario: &'a Scenario,
    graph: &'a Graph,
    /// Whether somebody wants it to stop.
    asked: &'static AtomicBool,
}

impl<'a> Running<'a> {
    fn new(
        scene: &SceneArguments,
        compiled: &'a Compiled,
        (scenario, graph): (&'a Scenario, &'a Graph),
        asked: &'static AtomicBool,
    ) -> Running<'a> {
        let (sha256, resolved) = (fingerprint(&compiled.sources), scene.resolved_in_place());
        Running { compiled, sha256, resolved, scenario, graph, asked }
    }

    fn work(&self, arguments: &Arguments) -> Work {
        Work { name: arguments.name(), scene_sha256: self.sha256.clone() }
    }
}

/// Runs a scene into its directory, to its report.
fn compute(arguments: &Arguments, directory: Directory, running: &Running<'_>) -> Result<Run, Outcome> {
    let asked = running.asked;
    let Running { compiled, sha256, scenario, graph, .. } = running;
    let out = directory.path().to_owned();
    let refused = |error: &ResultsError| stop(compiled, results_diagnostic(error));
    let source = Source { sources: &compiled.sources, sha256, diagnostics: &compiled.diagnostics };
    let mut recorder = RunRecorder::new(scenario, graph).kept_in(&directory).made_by(source).interrupted_by(asked);
    let from = match recorder.resume() {
        Ok(from) => from,
        Err(error) => return Err(refused(&error)),
    };
    if let Some(checkpoint) = &from {
        terminal::note(&format!("goes on after {}: what is left is told from here\n", checkpoint.clock));
    }
    let executor = Executor::default().with_beds(pack::beds(arguments.cache.as_deref()));
    let mut shown = Shown::new(graph, from.as_ref());
    let (mut recording, endable) = Recording::endable(&mut recorder, &out, arguments.is_worker);
    let ended = executor.run(graph, &mut Both(&mut recording, &mut shown), from);
    drop(endable);
    drop(shown);
    match (ended, recorder.failure()) {
        (Ok(Ending::Finished), _) => {}
        (Ok(Ending::Stopped), Some(error)) => return Err(refused(&error)),
        (Ok(Ending::Stopped), None) => return Err(stopped(&out, arguments.is_worker, recorder.has_kept())),
        (Err(error), _) => return Err(stop(compiled, execute::diagnose(&error, graph, &compiled.origins))),
    }
    let timed = Timed { solve: recorder.seconds(), parts: recorder.parts(), after: Instant::now() };
    let packings = results::read_packings(&out, &scenario.solve).map_err(|error| refused(&error))?;
    let run = Run::gather(&recorder, scenario, graph, source).with_packings(packings);
    let mut files = files(&run, recorder.last_bed.take(), &out).map_err(|error| refused(&error))?;
    files.extend(running.resolved.iter().map(|text| (results::RESOLVED.to_owned(), text.clone().into_bytes())));
    drop(recorder);
    put_in_place(directory, &files, &timed).map_err(|error| refused(&error))?;
    summary(&run, &out.join(report::PAGE), timed.solve);
    warn(&run, compiled);
    Ok(run)
}

/// A recorder that is not ended from outside while it keeps what it hears.
struct Recording<'r, 'a> {
    recorder: &'r mut RunRecorder<'a>,
    /// Whether there is a state to go on from.
    has_kept: Arc<AtomicBool>,
}

impl<'r, 'a> Recording<'r, 'a> {
    /// The recorder of a run into a directory, which may be ended from outside until the other value is dropped.
    fn endable(recorder: &'r mut RunRecorder<'a>, out: &Path, is_worker: bool) -> (Recording<'r, 'a>, Endable) {
        let has_kept = Arc::new(AtomicBool::new(recorder.has_kept()));
        let (out, kept) = (out.to_owned(), Arc::clone(&has_kept));
        let words = move || stopped(&out, is_worker, kept.load(Ordering::Relaxed));
        (Recording { recorder, has_kept }, interrupt::endable(words))
    }
}

impl Listener for Recording<'_, '_> {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        interrupt::writing(|| {
            let heard = self.recorder.hear(event);
            self.has_kept.store(self.recorder.has_kept(), Ordering::Relaxed);
            heard
        })
    }
}

/// Says how to go on with a run that Ctrl-C, SIGTERM or its memory has stopped.
fn stopped(out: &Path, is_worker: bool, has_kept: bool) -> Outcome {
    let kept = if has_kept { format!("the state is kept in `{}`", out.display()) } else { NOTHING_KEPT.to_owned() };
    if let Some(outgrown) = memory::outgrown(&kept) {
        terminal::diagnostics(&[outgrown], &Sources::default());
        return Outcome::Failed;
    }
    let (out, how) = (out.display(), if is_worker { "again" } else { "with `--resume`" });
    terminal::note(&match has_kept {
        true => format!(
            "stopped: the state is kept in `{out}`\nto go on, run the same command {how}: the answer will be the same\n"
        ),
        false => {
            format!("stopped before there was a state to keep\nto start again, run the same command {how}\n")
        }
    });
    Outcome::Failed
}

const NOTHING_KEPT: &str = "there was no state to keep yet";

/// Says what a run found that is finished already.
fn again(finished: &Finished, out: &Path, compiled: &Compiled) -> Outcome {
    let summary = match results::read_summary(out) {
        Ok(summary) => summary,
        Err(error) => return stop(compiled, results_diagnostic(&error)),
    };
    let (page, version) = (out.join(report::PAGE).display().to_string(), &finished.manifest().version);
    terminal::summary(&match version == env!("CARGO_PKG_VERSION") {
        true => format!("{page} was finished before\n"),
        false => format!("{page} was finished before by version {version}: `--force` runs it anew with this one\n"),
    });
    match &compiled.scenario {
        Some(scenario) => verdicts(&summary.expectations, scenario, compiled),
        None => Outcome::Fine,
    }
}

/// Says where exchanges of forces and settlement overshot.
fn warn(run: &Run, compiled: &Compiled) {
    let Some(found) = BlockRow::overshoot(&run.blocks) else { return };
    let diagnostic = Diagnostic::new(Code::E0807, found).help("write `update_every = adaptive`");
    let diagnostic = match compiled.origins.span(Parameter::Update) {
        Some(span) => diagnostic.label(span, "too long between two exchanges"),
        None => diagnostic,
    };
    terminal::diagnostics(&[diagnostic], &compiled.sources);
}

fn stop(compiled: &Compiled, diagnostic: Diagnostic) -> Outcome {
    terminal::diagnostics(&[diagnostic], &compiled.sources);
    Outcome::Failed
}

fn results_diagnostic(error: &ResultsError) -> Diagnostic {
    match error {
        ResultsError::Store(error) => stored::diagnostic(error),
        other => {
            Diagnostic::new(Code::E0802, other.to_string()).help("what was computed is kept: go on with `--resume`")
        }
    }
}

/// Every file of a finished run, its page among them.
fn files(run: &Run, last_bed: Option<Bed<f32>>, out: &Path) -> Result<Vec<NamedBytes>, ResultsError> {
    let view = match last_bed {
        Some(mut bed) => {
            BedTestsView::new(run.clone(), &mut bed).map_err(|cause| ResultsError::unwritable(out, cause))?
        }
        None => None,
    };
    Ok(match view {
        Some(view) => [results::test_files(&view, out)?, report::test_pages(&view, false)].concat(),
        None => [results::files(run, out)?, report::run_pages(run, false)].concat(),
    })
}

/// What a run took.
struct Timed {
    /// Seconds of all its parts.
    solve: f64,
    parts: u64,
    /// When it was computed: files and pages follow.
    after: Instant,
}

/// Puts all files in place at once.
fn put_in_place(mut directory: Directory, files: &[NamedBytes], timed: &Timed) -> Result<(), ResultsError> {
    for (name, bytes) in files {
        directory.stage(name, bytes)?;
    }
    let timings = BTreeMap::from([
        ("solve_s".to_string(), timed.solve),
        ("total_s".to_string(), timed.solve + timed.after.elapsed().as_secs_f64()),
        ("parts".to_string(), timed.parts as f64),
        ("threads".to_string(), rayon::current_num_threads() as f64),
    ]);
    let (name, bytes) = results::timings_file(&timings, directory.path())?;
    directory.stage_changing(&name, &bytes)?;
    directory.commit()?;
    Ok(())
}

/// The few numbers that people ask for first.
fn summary(run: &Run, page: &Path, seconds: f64) {
    let mut out = format!("{}\n", run.scenario.title);
    headline(
        &mut out,
        &run.summary.scalars,
        if run.tests.is_some() { &results::OF_TESTS } else { &results::OF_TRACKS },
    );
    if let Some(spread) = run.summary.scalars.get("law_spread") {
        out.push_str(&format!("  {:<26}{}\n", "spread between laws", number((spread.value * 1e2).round() / 1e2)));
    }
    for sentence in results::unsettled(&run.scenario, &run.blocks, &run.laws) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out.push_str(&format!("{} ({} s)\n", page.display(), number((seconds * 10.0).round() / 10.0)));
    terminal::summary(&out);
}

/// A line for each scalar that there is, in its unit. Its band of confidence or its scatter over packings follows where
/// it has one.
fn headline(out: &mut String, scalars: &BTreeMap<String, Scalar>, lines: &[Label]) {
    for Label { name, text, unit, size } in lines {
        let rounded = |value: f64| number((value / size * 1e4).round() / 1e4);
        let Some(scalar) = scalars.get(*name) else { continue };
        let band = scalars.get(&format!("{name}_confidence"));
        let band = band.map_or(String::new(), |half| format!(" +- {}", rounded(half.value)));
        let over = scalars.get(&format!("{name}_mean")).zip(scalars.get(&format!("{name}_deviation")));
        let over = over.map_or(String::new(), |(mean, deviation)| {
            format!(" (over packings {}, standard deviation {})", rounded(mean.value), rounded(deviation.value))
        });
        out.push_str(&format!("  {text:<26}{}{band} {unit}{over}\n", rounded(scalar.value)));
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
                .label(expectation.span, "not met")
        })
        .collect();
    if missed.is_empty() {
        return Outcome::Fine;
    }
    terminal::diagnostics(&missed, &compiled.sources);
    Outcome::Failed
}
