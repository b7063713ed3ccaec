//! Runs the points of a study on this machine, several at once.

use super::{Outcome, interrupt, memory, progress, terminal};
use crate::diag::Sources;
use crate::execute::Executor;
use crate::nodes::turns;
use crate::study::{self, Next, Plan, Repeat, Scene, StudyFolder};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Why a study has ended before its last point.
pub(super) enum Unfinished {
    /// A result could not be written.
    Broken(String),
    /// Ctrl-C or SIGTERM, with so many points kept.
    Asked { kept: usize },
}

/// Runs what is missing, round after round, and keeps each run as soon as it is there. Gives the runs of every point,
/// in the order of the plan.
pub(super) fn perform(
    scene: Scene<'_>,
    plan: &Plan,
    stored: Vec<Vec<Repeat>>,
    folder: &StudyFolder,
    executor: &Executor,
    jobs: usize,
) -> Result<Vec<Vec<Repeat>>, Unfinished> {
    let least = plan.study.repeats.least as usize;
    let done = Arc::new(AtomicUsize::new(stored.iter().filter(|runs| runs.len() >= least).count()));
    let _endable = interrupt::endable(last_words(folder, Arc::clone(&done), plan.points.len()));
    let mut work = Work { plan, stored, apart: BTreeMap::new(), bar: None, done, of_round: [0.0; 2] };
    loop {
        let missing = match study::next(plan, &work.stored) {
            Next::Done(runs) => return Ok(runs),
            Next::Run(missing) => missing,
        };
        let kept = one_round(scene, &mut work, &missing, folder, executor, jobs)?;
        if !kept {
            return Err(Unfinished::Asked { kept: work.done.load(Ordering::Relaxed) });
        }
    }
}

/// Computes the missing runs of a round; `false` where somebody has asked to stop before all were there.
fn one_round(
    scene: Scene<'_>,
    work: &mut Work<'_>,
    missing: &[(usize, u32)],
    folder: &StudyFolder,
    executor: &Executor,
    jobs: usize,
) -> Result<bool, Unfinished> {
    // a run behind a damaged one is kept, and is not computed again; the damaged one has been told
    let plan = work.plan;
    let kept = |(index, repeat): &(usize, u32)| folder.known_run(&plan.points[*index], *repeat).ok().flatten();
    let (known, tasks): (Vec<_>, Vec<_>) = missing.iter().copied().partition(|run| kept(run).is_some());
    let known: Vec<_> = known.into_iter().filter_map(|run| Some((run, kept(&run)?))).collect();
    work.begin(missing);
    known.into_iter().for_each(|((index, repeat), run)| work.put(index, repeat, run));
    // what cannot be written would be computed for nothing
    let (broken, asked) = (AtomicBool::new(false), interrupt::asked());
    let shared = Mutex::new(work);
    let one = |(index, repeat): &(usize, u32)| {
        if broken.load(Ordering::Relaxed) || asked.load(Ordering::Relaxed) {
            return Ok(());
        }
        let point = &plan.points[*index];
        let run = study::perform(scene, &plan.study.name, &point.overrides_of(*repeat), executor, asked);
        let Some(run) = run else { return Ok(()) };
        let take = || {
            folder.keep(point, *repeat, &run).map_err(|error| error.to_string())?;
            shared.lock().unwrap_or_else(PoisonError::into_inner).put(*index, *repeat, run);
            Ok(())
        };
        interrupt::writing(take).inspect_err(|_: &String| broken.store(true, Ordering::Relaxed))
    };
    let taken = turns::each(&tasks, jobs, turns::cores(), one)
        .map_err(|error| Unfinished::Broken(format!("cannot start threads: {error}")))?;
    taken.into_iter().collect::<Result<(), String>>().map_err(Unfinished::Broken)?;
    let work = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    // a signal after the last run changes nothing
    Ok(missing.iter().all(|(index, repeat)| work.stored[*index].len() > *repeat as usize))
}

/// What a study says that is ended from outside.
fn last_words(folder: &StudyFolder, done: Arc<AtomicUsize>, all: usize) -> impl Fn() -> Outcome + Send + use<> {
    let out = folder.path().to_owned();
    move || stopped(&out, done.load(Ordering::Relaxed), all)
}

/// Says how to go on with a study that Ctrl-C, SIGTERM or its memory has stopped.
pub(super) fn stopped(out: &Path, kept: usize, all: usize) -> Outcome {
    let points = format!("{kept} of {all} points are kept in `{}`", out.display());
    if let Some(outgrown) = memory::outgrown(&points) {
        terminal::diagnostics(&[outgrown], &Sources::default());
        return Outcome::Failed;
    }
    terminal::note(&format!(
        "stopped: {points}\nto go on, run the same command with `--resume`: the answer will be the same\n"
    ));
    Outcome::Failed
}

/// What there is of a study while it runs.
struct Work<'a> {
    plan: &'a Plan,
    /// The runs of each point from the first without a gap.
    stored: Vec<Vec<Repeat>>,
    /// By point and repeat, runs behind a gap.
    apart: BTreeMap<(usize, u32), Repeat>,
    bar: Option<progress::Patient>,
    /// Points that have the least number of runs.
    done: Arc<AtomicUsize>,
    /// Estimated seconds of this round that are done, and of all.
    of_round: [f64; 2],
}

impl Work<'_> {
    /// A round begins: the first has the least number of runs of every point, each other one a further packing of
    /// some points.
    fn begin(&mut self, missing: &[(usize, u32)]) {
        let all = missing.iter().map(|(index, _)| self.plan.points[*index].seconds).sum();
        self.of_round = [0.0, all];
        let repeats = self.plan.study.repeats;
        let further = missing.iter().map(|(_, repeat)| *repeat).max().filter(|repeat| *repeat >= repeats.least);
        if let Some(repeat) = further {
            let (points, of) = (missing.len(), self.plan.points.len());
            terminal::note(&format!("packing {} of {repeats}: {points} of {of} points\n", repeat + 1));
        }
        self.bar = Some(progress::Patient::seen("the study"));
    }

    /// A run is there. Points differ in cost: the bar counts thousandths of the estimate.
    fn put(&mut self, index: usize, repeat: u32, run: Repeat) {
        self.apart.insert((index, repeat), run);
        let (runs, least) = (&mut self.stored[index], self.plan.study.repeats.least as usize);
        let before = runs.len();
        while let Some(run) = self.apart.remove(&(index, runs.len() as u32)) {
            runs.push(run);
        }
        if before < least && runs.len() >= least {
            self.done.fetch_add(1, Ordering::Relaxed);
        }
        let [done, all] = &mut self.of_round;
        *done += self.plan.points[index].seconds;
        let share = (1e3 * *done / all.max(1e-9)) as u64;
        self.bar.iter_mut().for_each(|bar| bar.show(share, 1000));
    }
}
