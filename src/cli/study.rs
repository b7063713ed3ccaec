//! `trackbed study`: runs the points of a study, several at once, and says which design is best.

use super::memory::MemoryArgument;
use super::scene::{SceneArguments, SeedArgument, failed, not_yet, show};
use super::{Outcome, interrupt, pack, progress, stored, study_summary, terminal};
use crate::check::{Folder, Remembered};
use crate::compile::Compiled;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, has_errors, or_list, render};
use crate::execute;
use crate::nodes::turns;
use crate::report;
use crate::scenario::Study;
use crate::store::Mode;
use crate::study::{self, Answer, Plan, PlannedPoint, PointResult, Repeat, Scene, StudyFolder};
use crate::units::number;
use clap::ValueEnum;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Run a study of a scene: its points, its best design
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    seed: SeedArgument,
    /// Which study of the file; needed where there are several.
    name: Option<String>,
    /// The directory for results; made where it does not exist.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Points at a time; all cores where it is not given. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Go on where an interrupted study of the same scene stopped.
    #[arg(long)]
    resume: bool,
    /// Replace the results of another study in that directory.
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    memory: MemoryArgument,
    /// Where the packed beds of test rigs are kept, by what made them
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
    /// Where points run.
    #[arg(long, value_enum, default_value = "local")]
    executor: Executor,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Executor {
    /// On this machine.
    Local,
    /// On a cluster; not in this version.
    Slurm,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    if arguments.executor == Executor::Slurm {
        terminal::error("this version runs studies on this machine only; leave out `--executor slurm`");
        return Outcome::Usage;
    }
    let scene = arguments.scene.with_seed(&arguments.seed);
    let modules = scene.remembered();
    let Some(compiled) = scene.compile_with(&modules).map(Compiled::to_run) else { return Outcome::Usage };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    if compiled.scenario.is_none() || compiled.runnable().is_none() {
        return not_yet(&compiled);
    }
    let study = match chosen(&compiled, arguments.name.as_deref()) {
        Ok(study) => study,
        Err(message) => {
            terminal::error(&message);
            return Outcome::Usage;
        }
    };
    with_scene(&scene, &modules, &compiled, |scene| run_study(arguments, scene, &compiled, study))
}

/// The study of that name, or the only one.
fn chosen<'a>(compiled: &'a Compiled, name: Option<&str>) -> Result<&'a Study, String> {
    let names: Vec<String> = compiled.studies.iter().map(|s| format!("`{}`", s.name)).collect();
    match (name, compiled.studies.as_slice()) {
        (_, []) => Err("the file has no `study`; `trackbed docs study` says how to write one".into()),
        (None, [only]) => Ok(only),
        (None, _) => Err(format!("the file has several studies: name {}", or_list(&names))),
        (Some(name), studies) => studies.iter().find(|s| s.name == name).ok_or_else(|| {
            let near = nearest(name, studies.iter().map(|s| s.name.as_str()));
            match near {
                Some(near) => format!("the file has no study `{name}`; did you mean `{near}`?"),
                None => format!("the file has no study `{name}`, but {}", or_list(&names)),
            }
        }),
    }
}

/// Diagnostics of every study of a scene, for `check`.
pub(super) fn diagnostics(arguments: &SceneArguments, modules: &Asked, compiled: &Compiled) -> Vec<Diagnostic> {
    with_scene(arguments, modules, compiled, |scene| {
        compiled.studies.iter().flat_map(|study| study::plan(scene, compiled, study).diagnostics).collect()
    })
}

/// Modules of a scene whose points are compiled side by side.
type Asked = Remembered<Folder>;

fn with_scene<T>(
    arguments: &SceneArguments,
    modules: &Asked,
    compiled: &Compiled,
    f: impl FnOnce(Scene<'_>) -> T,
) -> T {
    let name = arguments.file.display().to_string();
    let text = compiled.sources.iter().next().map_or("", |(_, source)| source.text.as_str());
    f(Scene { name: &name, text, modules, set: &arguments.set })
}

fn run_study(arguments: &Arguments, scene: Scene<'_>, compiled: &Compiled, study: &Study) -> Outcome {
    let plan = study::plan(scene, compiled, study);
    say(&plan.diagnostics, compiled);
    if has_errors(&plan.diagnostics) {
        return Outcome::Failed;
    }
    let jobs = arguments.jobs.map_or_else(turns::cores, usize::from);
    if let Some(refusal) = arguments.memory.refusal_of_study(&plan, jobs) {
        say(&[refusal], compiled);
        return Outcome::Failed;
    }
    let folder = match StudyFolder::open(&arguments.out, &plan, compiled, mode(arguments)) {
        Ok(folder) => folder,
        Err(error) => {
            say(&[stored::diagnostic(&error)], compiled);
            return Outcome::Failed;
        }
    };
    let known = known(&plan, &folder);
    let missing = known.iter().filter(|result| result.is_none()).count();
    match (folder.is_finished(), missing) {
        (true, 0) => terminal::note("this study has been finished before: nothing is run\n"),
        (true, n) => terminal::note(&format!(
            "this study has been finished before by a version that kept less: {n} of {} points run\n",
            plan.points.len()
        )),
        (false, _) => announce(&plan, jobs),
    }
    let started = Instant::now();
    let executor = execute::Executor::default().with_beds(pack::beds(arguments.cache.as_deref()));
    let results = match perform(scene, &plan, known, &folder, &executor, jobs) {
        Ok(results) => results,
        Err(Unfinished::Broken(message)) => {
            say(&[Diagnostic::new(Code::E0802, message).help("go on with `--resume`")], compiled);
            return Outcome::Failed;
        }
        Err(Unfinished::Asked { kept }) => return stopped(&arguments.out, kept, plan.points.len()),
    };
    let title = compiled.scenario.as_ref().map_or("", |s| s.title.as_str());
    let answer = Answer::new(title, &plan, results);
    let name = arguments.scene.file.file_name().unwrap_or_default().to_string_lossy();
    let shown = answer.best().first().copied().or(answer.nearest());
    let best = shown.map(|index| scene.compile(&plan.points[index].overrides));
    let design = best.as_ref().and_then(|compiled| compiled.scenario.as_ref());
    let page = report::study_page(&answer, &name, design);
    let seconds = started.elapsed().as_secs_f64();
    let timings = BTreeMap::from([("total_s".to_string(), seconds), ("jobs".to_string(), jobs as f64)]);
    if (missing > 0 || !folder.is_finished())
        && let Err(error) = folder.finish(&plan, &answer, &page, compiled, &timings)
    {
        say(&[stored::diagnostic(&error)], compiled);
        return Outcome::Failed;
    }
    terminal::out(&study_summary::text(&answer, &arguments.out, seconds));
    let against = study_summary::diagnostics(&answer);
    say(&against, compiled);
    if has_errors(&against) { Outcome::Failed } else { Outcome::Fine }
}

fn mode(arguments: &Arguments) -> Mode {
    match (arguments.force, arguments.resume) {
        (true, _) => Mode::Force,
        (false, true) => Mode::Resume,
        (false, false) => Mode::New,
    }
}

fn say(diagnostics: &[Diagnostic], compiled: &Compiled) {
    if !diagnostics.is_empty() {
        terminal::note(&render::human(diagnostics, &compiled.sources, terminal::colour(), terminal::width()));
    }
}

/// What is about to run.
fn announce(plan: &Plan, jobs: usize) {
    let runs = plan.runs();
    let left_out = match plan.left_out {
        0 => String::new(),
        n => format!(" ({n} of the design break a condition and are left out)"),
    };
    let repeats = if plan.study.repeats > 1 { format!(", {runs} runs") } else { String::new() };
    let as_it_is = match plan.points.iter().find(|point| point.as_it_is).map(|point| point.number) {
        Some(0) => " and the scene as it is".to_string(),
        Some(number) => format!(", number {number} of them the scene as it is"),
        None => String::new(),
    };
    terminal::note(&format!(
        "study `{}`: {} points{left_out}{as_it_is}{repeats}, about {} of computing, {} at a time\n",
        plan.study.name,
        plan.designs(),
        duration(plan.seconds()),
        jobs
    ));
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 90.0 => format!("{} s", number(s.ceil())),
        s if s < 5400.0 => format!("{} min", number((s / 60.0).round())),
        s => format!("{} h", number((s / 360.0).round() / 10.0)),
    }
}

/// What has run before, one for each point.
fn known(plan: &Plan, folder: &StudyFolder) -> Vec<Option<PointResult>> {
    let one = |point: &PlannedPoint| {
        let name = if point.number == 0 { "the scene as it is".to_string() } else { format!("point {}", point.number) };
        let damaged = |error| terminal::error(&format!("{name} runs again: {error}"));
        folder.known(point).map_err(damaged).ok().flatten()
    };
    plan.points.iter().map(one).collect()
}

/// Why a study has ended before its last point.
enum Unfinished {
    /// A result could not be written.
    Broken(String),
    /// Ctrl-C or SIGTERM, with so many points kept.
    Asked { kept: usize },
}

/// Says how to go on with a study that Ctrl-C or SIGTERM has stopped.
fn stopped(out: &Path, kept: usize, all: usize) -> Outcome {
    terminal::note(&format!(
        "stopped: {kept} of {all} points are kept in `{}`\nto go on, run the same command with `--resume`: the answer will be the same\n",
        out.display()
    ));
    Outcome::Failed
}

/// Runs what has not run yet, repeat by repeat, and keeps each point as soon as it is there. The order of the answer is that of the
/// plan.
fn perform(
    scene: Scene<'_>,
    plan: &Plan,
    known: Vec<Option<PointResult>>,
    folder: &StudyFolder,
    executor: &execute::Executor,
    jobs: usize,
) -> Result<Vec<PointResult>, Unfinished> {
    let missing = known.iter().enumerate().filter(|(_, result)| result.is_none());
    let tasks: Vec<(usize, u32)> =
        missing.flat_map(|(index, _)| (0..plan.study.repeats).map(move |repeat| (index, repeat))).collect();
    let work = Mutex::new(Work { plan, known, runs: BTreeMap::new(), bar: progress::Patient::seen("the study") });
    // what cannot be written would be computed for nothing
    let (broken, asked) = (AtomicBool::new(false), interrupt::asked());
    let one = |(index, repeat): &(usize, u32)| {
        if broken.load(Ordering::Relaxed) || asked.load(Ordering::Relaxed) {
            return Ok(());
        }
        let run = study::perform(scene, &plan.study, &plan.points[*index], *repeat, executor, asked);
        let Some(run) = run else { return Ok(()) };
        let taken = work.lock().unwrap_or_else(PoisonError::into_inner).take(*index, *repeat, run, folder);
        taken.inspect_err(|_| broken.store(true, Ordering::Relaxed))
    };
    let taken = turns::each(&tasks, jobs, turns::cores(), one)
        .map_err(|error| Unfinished::Broken(format!("cannot start threads: {error}")))?;
    taken.into_iter().collect::<Result<(), String>>().map_err(Unfinished::Broken)?;
    let known = work.into_inner().unwrap_or_else(PoisonError::into_inner).known;
    let results: Vec<PointResult> = known.into_iter().flatten().collect();
    // a signal after the last run changes nothing
    if results.len() < plan.points.len() { Err(Unfinished::Asked { kept: results.len() }) } else { Ok(results) }
}

/// What there is of a study while it runs.
struct Work<'a> {
    plan: &'a Plan,
    /// One for each point of the plan.
    known: Vec<Option<PointResult>>,
    /// By point and repeat, of points that are not finished.
    runs: BTreeMap<(usize, u32), Repeat>,
    bar: progress::Patient,
}

impl Work<'_> {
    /// A run is over; with the last of its point that is kept.
    fn take(&mut self, index: usize, repeat: u32, run: Repeat, folder: &StudyFolder) -> Result<(), String> {
        self.runs.insert((index, repeat), run);
        let (point, all) = (&self.plan.points[index], self.plan.study.repeats);
        let runs: Vec<Repeat> = (0..all).map_while(|repeat| self.runs.get(&(index, repeat)).cloned()).collect();
        if runs.len() == all as usize {
            let result = PointResult::from_repeats(point, &runs);
            folder.keep(point, &result).map_err(|error| error.to_string())?;
            self.known[index] = Some(result);
            self.runs.retain(|(other, _), _| *other != index);
        }
        self.tell();
        Ok(())
    }

    /// Points differ in cost: the bar counts thousandths of the estimate.
    fn tell(&mut self) {
        let seconds = |index: usize| self.plan.points[index].seconds;
        let finished = self.known.iter().enumerate().filter(|(_, result)| result.is_some());
        let done = finished.map(|(index, _)| seconds(index) * f64::from(self.plan.study.repeats)).sum::<f64>()
            + self.runs.keys().map(|(index, _)| seconds(*index)).sum::<f64>();
        self.bar.show((1e3 * done / self.plan.seconds().max(1e-9)) as u64, 1000);
    }
}
