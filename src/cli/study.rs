//! `trackbed study`: runs the points of a study, here or on a cluster, and says which design is best.

use super::cluster::{self, ClusterArguments, Elsewhere, Executor};
use super::memory::MemoryArgument;
use super::progress::Patient;
use super::scene::{SceneArguments, SeedArgument, failed, not_yet, show};
use super::study_elsewhere;
use super::study_local::{Unfinished, perform, stopped};
use super::{Outcome, interrupt, pack, stored, study_summary, terminal};
use crate::check::{self, Folder, Remembered};
use crate::cluster::ClusterError;
use crate::compile::Compiled;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, has_errors, or_list};
use crate::execute;
use crate::nodes::turns;
use crate::report;
use crate::scenario::Study;
use crate::store::Mode;
use crate::study::{self, Answer, Next, Plan, PlannedPoint, PointOutcome, Repeat, Scene, StudyFolder};
use crate::units::duration;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Instant;

/// Run a study of a scene: its points, its best design
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed study scenarios/study_usp.track --out pads
  trackbed study scenarios/study_usp.track --out pads --resume
  trackbed study scenarios/study_usp.track --out pads --executor slurm --dry-run")]
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
    /// Points at a time; all cores where it is not given, and all that the cluster allows with `--executor slurm`. The
    /// results do not depend on it.
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
    #[command(flatten)]
    cluster: ClusterArguments,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    if arguments.cluster.are_misused() {
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
        compiled.studies.iter().flat_map(|study| planned(scene, compiled, study).diagnostics).collect()
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

/// The points of a study, checked; thousands take longer than two seconds, which a bar shows.
fn planned(scene: Scene<'_>, compiled: &Compiled, study: &Study) -> Plan {
    let bar = Mutex::new(Patient::new("the check of all points"));
    study::plan_told(scene, compiled, study, &|done, all| {
        // a thread that finds another one at it has nothing new to say
        if let Ok(mut bar) = bar.try_lock() {
            bar.show(done, all);
        }
    })
}

fn run_study(arguments: &Arguments, scene: Scene<'_>, compiled: &Compiled, study: &Study) -> Outcome {
    let plan = planned(scene, compiled, study);
    say(&plan.diagnostics, compiled);
    if has_errors(&plan.diagnostics) {
        return Outcome::Failed;
    }
    let jobs = arguments.jobs.map_or_else(turns::cores, usize::from);
    let refusal =
        arguments.memory.refusal_of_study(&plan, jobs).filter(|_| arguments.cluster.executor == Executor::Local);
    if let Some(refusal) = refusal {
        say(&[refusal], compiled);
        return Outcome::Failed;
    }
    arguments.memory.watch(None);
    let elsewhere = study_elsewhere::Study { scene, plan: &plan, cache: arguments.cache.as_deref() };
    let asked =
        Elsewhere { arguments: &arguments.cluster, name: &study.name, out: &arguments.out, at_a_time: arguments.jobs };
    if arguments.cluster.dry_run {
        return match asked.dry_run(&elsewhere.needs()) {
            Ok(scripts) => {
                terminal::out(&scripts);
                Outcome::Fine
            }
            Err(error) => refused(&error, compiled),
        };
    }
    if let Err(error) = asked.reach() {
        return refused(&error, compiled);
    }
    // a signal from here on is heard
    interrupt::asked();
    let folder = match StudyFolder::open(&arguments.out, &plan, compiled, mode(arguments)) {
        Ok(folder) => folder,
        Err(error) => {
            say(&[stored::diagnostic(&error)], compiled);
            return Outcome::Failed;
        }
    };
    let mut stored = stored_of(&plan, &folder);
    let mut next = study::next(&plan, &stored);
    let missing = next.points();
    match (folder.is_finished(), missing) {
        (true, 0) => terminal::note("this study has been finished before: nothing is run\n"),
        (true, n) => terminal::note(&format!(
            "this study has been finished before by a version that kept less: {n} of {} points run\n",
            plan.points.len()
        )),
        (false, _) => announce(&plan, jobs, arguments.cluster.executor),
    }
    let started = Instant::now();
    let is_elsewhere = arguments.cluster.executor != Executor::Local && !folder.is_finished();
    while let (true, Next::Run(runs)) = (is_elsewhere, &next) {
        match elsewhere.perform(&folder, &asked, runs) {
            Ok(None) => {
                stored = stored_of(&plan, &folder);
                let following = study::next(&plan, &stored);
                // what is kept but damaged is computed here
                let is_stuck = following == next;
                next = following;
                if is_stuck {
                    break;
                }
            }
            Ok(Some(outcome)) => return outcome,
            Err(error) => return refused(&error, compiled),
        }
    }
    let executor = execute::Executor::default().with_beds(pack::beds(arguments.cache.as_deref()));
    let runs = match next {
        Next::Done(runs) => runs,
        Next::Run(_) => match perform(scene, &plan, stored, &folder, &executor, jobs) {
            Ok(runs) => runs,
            Err(Unfinished::Broken(message)) => {
                say(&[Diagnostic::new(Code::E0802, message).help("go on with `--resume`")], compiled);
                return Outcome::Failed;
            }
            Err(Unfinished::Asked { kept }) => return stopped(&arguments.out, kept, plan.points.len()),
        },
    };
    finish(arguments, (scene, compiled, &plan), folder, &runs, (missing, started, jobs))
}

/// Writes what a study has found, and says it.
fn finish(
    arguments: &Arguments,
    (scene, compiled, plan): (Scene<'_>, &Compiled, &Plan),
    folder: StudyFolder,
    runs: &[Vec<Repeat>],
    (missing, started, jobs): (usize, Instant, usize),
) -> Outcome {
    let title = compiled.scenario.as_ref().map_or("", |s| s.title.as_str());
    let answer = Answer::new(title, plan, runs.iter().map(|runs| PointOutcome::gathered(runs)).collect());
    let name = arguments.scene.file.file_name().unwrap_or_default().to_string_lossy();
    let shown = answer.best().first().copied().or(answer.nearest());
    let best = shown.map(|index| scene.compile(&plan.points[index].overrides));
    let design = best.as_ref().and_then(|compiled| compiled.scenario.as_ref());
    let page = report::study_page(&answer, &name, design);
    let resolved = check::resolve(&name, scene.text, scene.modules, scene.set);
    let seconds = started.elapsed().as_secs_f64();
    let timings = BTreeMap::from([("total_s".to_string(), seconds), ("jobs".to_string(), jobs as f64)]);
    let written = match (folder.is_finished(), missing) {
        (true, 0) => folder.show_again(&page),
        _ => folder.finish(plan, (&answer, runs), (&page, resolved.as_deref()), compiled, &timings),
    };
    if let Err(error) = written {
        say(&[stored::diagnostic(&error)], compiled);
        return Outcome::Failed;
    }
    terminal::summary(&study_summary::text(&answer, &arguments.out, seconds));
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
    terminal::diagnostics(diagnostics, &compiled.sources);
}

/// Says why a cluster does not do the study.
fn refused(error: &ClusterError, compiled: &Compiled) -> Outcome {
    say(&[cluster::diagnostic(error)], compiled);
    Outcome::Failed
}

/// What is about to run.
fn announce(plan: &Plan, jobs: usize, executor: Executor) {
    let left_out = match plan.left_out {
        0 => String::new(),
        n => format!(" ({n} of the design break a condition and are left out)"),
    };
    let ([least, most], [shortest, longest]) = (plan.runs(), plan.seconds());
    let repeats = match plan.study.repeats.are_several() {
        true if least < most => format!(", {least} to {most} runs"),
        true => format!(", {most} runs"),
        false => String::new(),
    };
    let about = match least < most {
        true => format!("{} to {}", duration(shortest), duration(longest)),
        false => format!("about {}", duration(longest)),
    };
    let as_it_is = match plan.points.iter().find(|point| point.as_it_is).map(|point| point.number) {
        Some(0) => " and the scene as it is".to_string(),
        Some(number) => format!(", number {number} of them the scene as it is"),
        None => String::new(),
    };
    let how = if executor == Executor::Local { format!(", {jobs} at a time") } else { String::new() };
    terminal::note(&format!(
        "study `{}`: {} points{left_out}{as_it_is}{repeats}, {about} of computing{how}\n",
        plan.study.name,
        plan.designs(),
    ));
}

/// The stored runs, one list for each point.
fn stored_of(plan: &Plan, folder: &StudyFolder) -> Vec<Vec<Repeat>> {
    let one = |point: &PlannedPoint| {
        let name = if point.number == 0 { "the scene as it is".to_string() } else { format!("point {}", point.number) };
        let damaged = |error| terminal::error(&format!("{name} runs again: {error}"));
        folder.runs(point).map_err(damaged).unwrap_or_default()
    };
    plan.points.iter().map(one).collect()
}
