//! `trackbed run`: runs a scene into a directory, with checkpoints, a report and the verdict on its expectations.

use super::cluster::{self, ClusterArguments, Elsewhere, Executor as Place};
use super::memory::MemoryArgument;
use super::running::{self, Request, Running};
use super::scene::{PassArguments, SceneArguments, SeedArgument, failed, not_yet, show};
use super::{Outcome, report, run_elsewhere, run_packings, stored, terminal};
use crate::compile::{Compiled, NextTier};
use crate::diag::{Code, Diagnostic};
use crate::results::{self, Run, Verdict};
use crate::store::{Directory, Finished, Mode, StoreError, Unfinished};
use crate::units::{number, percent};
use std::path::{Path, PathBuf};

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

/// Runs in the pool of threads of the caller. A law that its check refutes is followed by a run in the next tier.
fn run_here(arguments: &Arguments) -> Outcome {
    let request = arguments.request();
    let Some(compiled) = request.compile() else { return Outcome::Usage };
    let next = compiled.next_tier.map(|next| (next, request.in_next(next)));
    let has_begun_again = |next: &Request| !arguments.force && is_in(next, &arguments.out);
    if let Some((_, next)) = next.as_ref().filter(|(_, next)| has_begun_again(next)) {
        return next
            .compile()
            .map_or(Outcome::Usage, |compiled| attempt(arguments, next, &compiled, arguments.mode()).0);
    }
    let (outcome, parted) = attempt(arguments, &request, &compiled, arguments.mode());
    let (Some((axles, share)), Some((NextTier { tier, limit, .. }, next))) = (parted, next) else { return outcome };
    terminal::note(&format!(
        "after {axles} axles law and cells part by {} of the largest settlement, more than the {} that the `tolerance` \
         leaves: the run begins again with `substructure = {}`\n",
        percent(share),
        percent(limit),
        tier.name()
    ));
    next.compile().map_or(Outcome::Usage, |compiled| attempt(arguments, &next, &compiled, Mode::Force).0)
}

/// Whether the directory has the work of a request, finished or not.
fn is_in(request: &Request, out: &Path) -> bool {
    let Some(compiled) = request.compile() else { return false };
    let work = request.work(&compiled.sources);
    let unfinished = Unfinished::open(out).ok().flatten().map(|state| state.work().clone());
    let finished = || Finished::open(out).ok().flatten().map(|finished| finished.manifest().work.clone());
    unfinished.or_else(finished).is_some_and(|found| found == work)
}

/// Runs a compiled scene. The second value tells after how many axles its check has ended it, and at which difference.
fn attempt(arguments: &Arguments, request: &Request, compiled: &Compiled, mode: Mode) -> (Outcome, Option<(u64, f64)>) {
    show(compiled);
    if failed(compiled) {
        return (Outcome::Failed, None);
    }
    let (Some(scenario), Some(graph)) = (&compiled.scenario, compiled.runnable()) else {
        return (not_yet(compiled), None);
    };
    let running = Running::new(request, compiled, (scenario, graph));
    let outcome = perform(arguments, &running, mode);
    (outcome, running.parted.get().copied())
}

fn perform(arguments: &Arguments, running: &Running<'_>, mode: Mode) -> Outcome {
    if arguments.cluster.dry_run {
        return dry_run(arguments, running);
    }
    let refusal = arguments.memory.refusal(running.graph).filter(|_| arguments.cluster.executor == Place::Local);
    if let Some(refusal) = refusal {
        return running.stop(refusal);
    }
    if let Err(error) = arguments.asked().reach() {
        return running.stop(cluster::diagnostic(&error));
    }
    arguments.memory.watch(Some(running.scenario));
    let directory = match Directory::open(&arguments.out, running.work.clone(), mode) {
        Ok(directory) => match directory.finished() {
            Some(finished) => return again(finished, directory.path(), running),
            None => directory,
        },
        Err(error) => match given_to_slurm(arguments, &error, running) {
            Some(state) => return finished(watched(arguments, &state, running), running),
            None => return running.stop(stored::diagnostic(&error)),
        },
    };
    let ready = match arguments.cluster.executor {
        Place::Local => run_packings::begin(&directory, running).map(|()| directory),
        Place::Slurm | Place::Workers => computed_elsewhere(arguments, directory, running),
    };
    finished(ready, running)
}

/// Computes what is left of a run, and gives the verdict on its expectations.
fn finished(ready: Result<Directory, Outcome>, running: &Running<'_>) -> Outcome {
    let further = |directory: &Directory, run: &Run| run_packings::further(directory, running, run);
    let run = ready.and_then(|directory| running::compute(directory, running, &further));
    run.map_or_else(|outcome| outcome, |run| verdicts(&run.summary.expectations, running))
}

/// The state of a run that Slurm computes, if a task of the run has the directory now. A task has it as long as it
/// computes the run itself, also while nobody watches.
fn given_to_slurm(arguments: &Arguments, error: &StoreError, running: &Running<'_>) -> Option<Unfinished> {
    let is_meant = arguments.resume && arguments.cluster.executor == Place::Slurm;
    if !is_meant || !matches!(error, StoreError::Busy { .. }) {
        return None;
    }
    let state = Unfinished::open(&arguments.out).ok()??;
    (*state.work() == running.work && cluster::has_ledger(&state)).then_some(state)
}

/// Shows what a cluster would be asked for.
fn dry_run(arguments: &Arguments, running: &Running<'_>) -> Outcome {
    match arguments.asked().dry_run(&run_packings::needs(running.graph, running.scenario)) {
        Ok(scripts) => {
            terminal::out(&scripts);
            Outcome::Fine
        }
        Err(error) => running.stop(cluster::diagnostic(&error)),
    }
}

/// Has other processes compute all packings. Gives the directory back, to go on from there.
fn computed_elsewhere(
    arguments: &Arguments,
    directory: Directory,
    running: &Running<'_>,
) -> Result<Directory, Outcome> {
    run_packings::share(&directory, running).map_err(|error| running.stop(stored::diagnostic(&error)))?;
    let state = directory.shared().clone();
    // the lock is for the process that computes the run itself
    drop(directory);
    watched(arguments, &state, running)
}

/// Waits until other processes have computed all packings. Gives the directory, to go on from there.
fn watched(arguments: &Arguments, state: &Unfinished, running: &Running<'_>) -> Result<Directory, Outcome> {
    let pieces = run_packings::pieces(state, running)?;
    let of_run = (run_packings::needs(running.graph, running.scenario), pieces);
    match run_elsewhere::perform(running.request.packings(), &arguments.asked(), state, of_run) {
        Ok(None) => {}
        Ok(Some(outcome)) => return Err(outcome),
        Err(error) => return Err(running.stop(cluster::diagnostic(&error))),
    }
    let opened = Directory::open(&arguments.out, running.work.clone(), Mode::Resume);
    opened.map_err(|error| running.stop(stored::diagnostic(&error)))
}

impl Arguments {
    fn request(&self) -> Request {
        Request {
            scene: self.scene.with_seed(&self.seed),
            passes: self.passes.clone(),
            out: self.out.clone(),
            cache: self.cache.clone(),
            force: self.force,
            is_worker: false,
            is_part: false,
        }
    }

    fn asked(&self) -> Elsewhere<'_> {
        Elsewhere { arguments: &self.cluster, name: "run", out: &self.out, at_a_time: None }
    }

    fn mode(&self) -> Mode {
        match (self.force, self.resume) {
            (true, _) => Mode::Force,
            (false, true) => Mode::Resume,
            (false, false) => Mode::New,
        }
    }
}

/// Says what a run found that is finished already.
fn again(finished: &Finished, out: &Path, running: &Running<'_>) -> Outcome {
    let summary = match results::read_summary(out) {
        Ok(summary) => summary,
        Err(error) => return running.refuse(&error),
    };
    let (page, version) = (out.join(report::PAGE).display().to_string(), &finished.manifest().version);
    terminal::summary(&match version == env!("CARGO_PKG_VERSION") {
        true => format!("{page} was finished before\n"),
        false => format!("{page} was finished before by version {version}: `--force` runs it anew with this one\n"),
    });
    verdicts(&summary.expectations, running)
}

/// Names every expectation that was missed.
fn verdicts(verdicts: &[Verdict], running: &Running<'_>) -> Outcome {
    let missed: Vec<Diagnostic> = verdicts
        .iter()
        .zip(&running.scenario.expectations)
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
    terminal::diagnostics(&missed, &running.compiled.sources);
    Outcome::Failed
}
