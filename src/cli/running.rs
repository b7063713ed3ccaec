//! A run on its way: what is asked for, and its computation into a directory, to its report.

use super::cluster::absolute;
use super::interrupt::Endable;
use super::parts::Parts;
use super::run_progress::Shown;
use super::scene::{PassArguments, SceneArguments, SeedArgument};
use super::task::Packings;
use super::{Outcome, interrupt, memory, pack, report, stored, terminal};
use crate::check::Override;
use crate::compile::{Compiled, NextTier, fingerprint};
use crate::diag::{Code, Diagnostic, Sources};
use crate::execute::{self, Both, Ending, Event, Executor, Listener};
use crate::graph::Graph;
use crate::lower::Parameter;
use crate::results::{
    self, BedTestsView, BlockRow, Label, NamedBytes, Packing, Parting, ResultsError, Run, RunRecorder, Scalar, Source,
};
use crate::scenario::Scenario;
use crate::store::{Beds, Directory, Work};
use crate::units::{number, percent};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// What is to be run, and where.
#[derive(Clone)]
pub(super) struct Request {
    pub scene: SceneArguments,
    pub passes: PassArguments,
    pub out: PathBuf,
    /// Where packed beds are kept.
    pub cache: Option<PathBuf>,
    /// Whether results of another run are replaced.
    pub force: bool,
    /// Whether this is `trackbed work` for a run of another process.
    pub is_worker: bool,
    /// Whether the command goes on with other runs and says itself what came out.
    pub is_part: bool,
}

impl Request {
    /// The request of a process that computes packings for another one.
    pub fn of_packings(run: &Path, packings: &Packings) -> Request {
        Request {
            scene: SceneArguments { file: packings.scene.clone(), set: packings.set.clone() },
            passes: PassArguments { without: packings.without.clone() },
            out: run.to_owned(),
            cache: packings.cache.clone(),
            force: packings.force,
            is_worker: true,
            is_part: false,
        }
    }

    /// What a process needs that computes packings.
    pub fn packings(&self) -> Packings {
        let SceneArguments { file, set } = self.scene.clone();
        let (without, cache) = (self.passes.without.clone(), self.cache.as_deref().map(absolute));
        Packings { scene: absolute(&file), set, without, cache, force: self.force, packings: Vec::new() }
    }

    /// The same with another seed.
    pub fn with_seed(&self, seed: u64) -> Request {
        Request { scene: self.scene.with_seed(&SeedArgument::with(seed)), ..self.clone() }
    }

    /// The same in the next tier.
    pub fn in_next(&self, next: NextTier) -> Request {
        let edit = |path: &str, value: String| Override { path: path.into(), value };
        let of_tier = edit("solve.substructure", next.tier.name().into());
        let tolerance = next.tolerance.map(|share| edit("solve.tolerance", percent(share)));
        let SceneArguments { file, set } = self.scene.clone();
        let set = set.into_iter().chain([of_tier]).chain(tolerance).collect();
        Request { scene: SceneArguments { file, set }, ..self.clone() }
    }

    /// Compiles the scene; `None` where it cannot be read, which has been said.
    pub fn compile(&self) -> Option<Compiled> {
        self.scene.compile_without(&self.passes).map(Compiled::to_run)
    }

    /// What is done in the directory: a run without some passes is another work.
    pub fn work(&self, sources: &Sources) -> Work {
        let without = self.passes.without.join("`, `");
        let name = if without.is_empty() { "run".to_owned() } else { format!("run without `{without}`") };
        Work { name, scene_sha256: fingerprint(sources) }
    }
}

/// A run on its way.
pub(super) struct Running<'a> {
    pub request: &'a Request,
    pub compiled: &'a Compiled,
    pub scenario: &'a Scenario,
    pub graph: &'a Graph,
    pub work: Work,
    /// Whether somebody wants it to stop.
    pub asked: &'static AtomicBool,
    /// The axles after which a law and the cells that check it have parted too far to go on, and by how much.
    pub parted: OnceLock<(u64, f64)>,
    /// The whole scene as one file, kept beside its results.
    resolved: Option<String>,
}

impl<'a> Running<'a> {
    pub fn new(
        request: &'a Request,
        compiled: &'a Compiled,
        (scenario, graph): (&'a Scenario, &'a Graph),
    ) -> Running<'a> {
        let (work, resolved) = (request.work(&compiled.sources), request.scene.resolved_in_place());
        let (asked, parted) = (interrupt::asked(), OnceLock::new());
        Running { request, compiled, scenario, graph, work, asked, parted, resolved }
    }

    /// The difference of a law and the cells that check it at which the run begins again in the next tier / largest
    /// settlement. A run of a chart is compared as it is, and goes on.
    fn limit_of_check(&self) -> Option<f64> {
        self.compiled.next_tier.filter(|_| !self.request.is_part).map(|next| next.limit)
    }

    pub fn source(&self) -> Source<'_> {
        let Compiled { sources, diagnostics, .. } = self.compiled;
        Source { sources, sha256: &self.work.scene_sha256, diagnostics }
    }

    pub fn executor(&self) -> Executor {
        // runs whose times are compared build their own beds
        match self.request.is_part {
            true => Executor::default().with_beds(Beds::not_kept()),
            false => Executor::default().with_beds(pack::beds(self.request.cache.as_deref())),
        }
    }

    /// Shows why the run stops.
    pub fn stop(&self, diagnostic: Diagnostic) -> Outcome {
        terminal::diagnostics(&[diagnostic], &self.compiled.sources);
        Outcome::Failed
    }

    pub fn refuse(&self, error: &ResultsError) -> Outcome {
        self.stop(results_diagnostic(error))
    }
}

fn results_diagnostic(error: &ResultsError) -> Diagnostic {
    match error {
        ResultsError::Store(error) => stored::diagnostic(error),
        other => {
            Diagnostic::new(Code::E0802, other.to_string()).help("what was computed is kept: go on with `--resume`")
        }
    }
}

/// What gives the runs on further packings, after the run itself.
pub(super) type Further<'f> = &'f dyn Fn(&Directory, &Run) -> Result<Vec<Packing>, Outcome>;

/// Runs a scene into its directory, to its report.
pub(super) fn compute(directory: Directory, running: &Running<'_>, further: Further<'_>) -> Result<Run, Outcome> {
    let (out, refused) = (directory.path().to_owned(), |error: &ResultsError| running.refuse(error));
    let parts = Parts::read(directory.shared(), running.graph, &running.work).map_err(|error| refused(&error))?;
    let Computed { run, view, timed } = match parts {
        Some(parts) => joined(parts, running),
        None => execute(&directory, running.graph, running)?,
    };
    let packings = further(&directory, &run)?;
    let run = run.with_packings(packings);
    // further packings have timings of their own
    let timed = Timed { after: Instant::now(), ..timed };
    let mut files = files(&run, view.as_ref(), &out).map_err(|error| refused(&error))?;
    files.extend(running.resolved.iter().map(|text| (results::RESOLVED.to_owned(), text.clone().into_bytes())));
    put_in_place(directory, &files, &timed).map_err(|error| refused(&error))?;
    if !running.request.is_part {
        summary(&run, &out.join(report::PAGE), timed.solve);
    }
    warn(&run, running);
    Ok(run)
}

/// Computes the test of one packing, by its place, into the directory of this part of a run.
pub(super) fn compute_part(directory: Directory, place: u32, running: &Running<'_>) -> Result<(), Outcome> {
    let out = directory.path().to_owned();
    let graph = running.graph.clone().with_one_packing(place);
    let Computed { view, timed, .. } = execute(&directory, &graph, running)?;
    let files: Result<Vec<NamedBytes>, ResultsError> =
        view.iter().map(|view| results::tests_file(view, &out)).collect();
    files.and_then(|files| put_in_place(directory, &files, &timed)).map_err(|error| running.refuse(&error))
}

/// What a run has given.
struct Computed {
    run: Run,
    /// The tests of beds, with the last bed.
    view: Option<BedTestsView>,
    timed: Timed,
}

/// Runs a graph, or goes on with it.
fn execute(directory: &Directory, graph: &Graph, running: &Running<'_>) -> Result<Computed, Outcome> {
    let Running { request, compiled, scenario, asked, .. } = running;
    let refused = |error: &ResultsError| running.refuse(error);
    let mut recorder = RunRecorder::new(scenario, graph)
        .kept_in(directory)
        .made_by(running.source())
        .interrupted_by(asked)
        .ended_by_check(running.limit_of_check());
    let from = recorder.resume().map_err(|error| refused(&error))?;
    if let Some(checkpoint) = &from {
        terminal::note(&format!("goes on after {}: what is left is told from here\n", checkpoint.clock));
    }
    let mut shown = Shown::new(graph, from.as_ref());
    let (mut recording, endable) = Recording::endable(&mut recorder, request);
    let ended = running.executor().run(graph, &mut Both(&mut recording, &mut shown), from);
    drop(endable);
    drop(shown);
    match (ended, recorder.failure()) {
        (Ok(Ending::Finished), _) => {}
        (Ok(Ending::Stopped), Some(error)) => return Err(refused(&error)),
        (Ok(Ending::Stopped), None) => {
            return Err(match recorder.parted() {
                Some(parted) => {
                    running.parted.get_or_init(|| parted);
                    Outcome::Failed
                }
                None => stopped(request, recorder.has_kept()),
            });
        }
        (Err(error), _) => return Err(running.stop(execute::diagnose(&error, graph, &compiled.origins))),
    }
    let timed = Timed {
        solve: recorder.seconds(),
        build: recorder.build_seconds(),
        parts: recorder.parts(),
        after: Instant::now(),
    };
    let run = Run::gather(&recorder, scenario, graph, running.source());
    let bed = recorder.last_bed.take();
    let view = bed.map(|mut bed| BedTestsView::new(run.clone(), &mut bed)).transpose();
    let unwritable = |cause| refused(&ResultsError::unwritable(directory.path(), cause));
    Ok(Computed { run, view: view.map_err(unwritable)?.flatten(), timed })
}

/// The run of its parts: in an open range of repeats of the first that suffice.
fn joined(parts: Parts, running: &Running<'_>) -> Computed {
    let Running { scenario, graph, .. } = running;
    let parts = parts.sufficient(&scenario.solve.grains);
    let timed = Timed { solve: parts.seconds, build: 0.0, parts: parts.starts, after: Instant::now() };
    let mut recorder = RunRecorder::new(scenario, graph);
    if let Some(tests) = &mut recorder.tables.tests {
        tests.tests = parts.tests();
    }
    let run = Run::gather(&recorder, scenario, graph, running.source());
    Computed { view: BedTestsView::of_packings(run.clone(), parts.views), run, timed }
}

/// A recorder that is not ended from outside while it keeps what it hears.
pub(super) struct Recording<'r, 'a> {
    recorder: &'r mut RunRecorder<'a>,
    /// Whether there is a state to go on from.
    has_kept: Arc<AtomicBool>,
}

impl<'r, 'a> Recording<'r, 'a> {
    /// The recorder of a run, which may be ended from outside until the other value is dropped.
    pub fn endable(recorder: &'r mut RunRecorder<'a>, request: &Request) -> (Recording<'r, 'a>, Endable) {
        let has_kept = Arc::new(AtomicBool::new(recorder.has_kept()));
        let (request, kept) = (request.clone(), Arc::clone(&has_kept));
        let words = move || stopped(&request, kept.load(Ordering::Relaxed));
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
pub(super) fn stopped(request: &Request, has_kept: bool) -> Outcome {
    let Request { out, is_worker, is_part, .. } = request;
    let kept = if has_kept { format!("the state is kept in `{}`", out.display()) } else { NOTHING_KEPT.to_owned() };
    if let Some(outgrown) = memory::outgrown(&kept) {
        terminal::diagnostics(&[outgrown], &Sources::default());
        return Outcome::Failed;
    }
    let (out, how) = (out.display(), if *is_worker || *is_part { "again" } else { "with `--resume`" });
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

/// Says where exchanges of forces and settlement overshot.
fn warn(run: &Run, running: &Running<'_>) {
    let Some(found) = BlockRow::overshoot(&run.blocks) else { return };
    let diagnostic = Diagnostic::new(Code::E0807, found).help("write `update_every = adaptive`, or shorter blocks");
    let diagnostic = match running.compiled.origins.span(Parameter::Update) {
        Some(span) => diagnostic.label(span, "too long between two exchanges"),
        None => diagnostic,
    };
    running.stop(diagnostic);
}

/// Every file of a finished run, its page among them.
fn files(run: &Run, view: Option<&BedTestsView>, out: &Path) -> Result<Vec<NamedBytes>, ResultsError> {
    Ok(match view {
        Some(view) => [results::test_files(view, out)?, report::test_pages(view, false)].concat(),
        None => [results::files(run, out)?, report::run_pages(run, false)].concat(),
    })
}

/// What a run took.
struct Timed {
    /// Seconds of all its parts.
    solve: f64,
    /// Seconds of these until the first train ran on grains.
    build: f64,
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
        ("build_s".to_string(), timed.build),
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
    if let Some(parting) = Parting::of_rows(&run.scenario, &run.check) {
        let help = if parting.exceeds() { format!(": {}", parting.help()) } else { String::new() };
        out.push_str(&format!("  {}{help}\n", parting.sentence()));
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
        let over = |what: &str| scalars.get(&format!("{name}_{what}")).map(|scalar| rounded(scalar.value));
        let over = match (over("mean"), over("mean_confidence"), over("deviation")) {
            (Some(mean), Some(half), Some(deviation)) => {
                format!(" (mean over packings {mean} +- {half}, standard deviation {deviation})")
            }
            _ => String::new(),
        };
        out.push_str(&format!("  {text:<26}{}{band} {unit}{over}\n", rounded(scalar.value)));
    }
}
