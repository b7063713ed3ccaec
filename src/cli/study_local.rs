//! Runs the points of a study on this machine, several at once.

use super::{Outcome, interrupt, memory, progress, terminal};
use crate::diag::Sources;
use crate::execute::Executor;
use crate::nodes::turns;
use crate::study::{self, Plan, PointResult, Repeat, Scene, StudyFolder};
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

/// Runs what has not run yet, repeat by repeat, and keeps each run as soon as it is there. The order of the answer is
/// that of the plan.
pub(super) fn perform(
    scene: Scene<'_>,
    plan: &Plan,
    known: Vec<Option<PointResult>>,
    folder: &StudyFolder,
    executor: &Executor,
    jobs: usize,
) -> Result<Vec<PointResult>, Unfinished> {
    let missing: Vec<usize> = (0..known.len()).filter(|index| known[*index].is_none()).collect();
    let all = missing.into_iter().flat_map(|index| (0..plan.study.repeats).map(move |repeat| (index, repeat)));
    // a damaged run has been told with its point
    let kept = |(index, repeat)| Some(((index, repeat), folder.known_run(&plan.points[index], repeat).ok()??));
    let runs: BTreeMap<(usize, u32), Repeat> = all.clone().filter_map(kept).collect();
    let tasks: Vec<(usize, u32)> = all.filter(|run| !runs.contains_key(run)).collect();
    let done = Arc::new(AtomicUsize::new(known.iter().flatten().count()));
    let bar = progress::Patient::seen("the study");
    let work = Mutex::new(Work { plan, known, runs, bar, done: Arc::clone(&done) });
    // what cannot be written would be computed for nothing
    let (broken, asked) = (AtomicBool::new(false), interrupt::asked());
    let _endable = interrupt::endable(last_words(folder, Arc::clone(&done), plan.points.len()));
    let one = |(index, repeat): &(usize, u32)| {
        if broken.load(Ordering::Relaxed) || asked.load(Ordering::Relaxed) {
            return Ok(());
        }
        let overrides = plan.points[*index].overrides_of(*repeat);
        let run = study::perform(scene, &plan.study.name, &overrides, executor, asked);
        let Some(run) = run else { return Ok(()) };
        let take = || work.lock().unwrap_or_else(PoisonError::into_inner).take(*index, *repeat, run, folder);
        let taken = interrupt::writing(take);
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
    /// One for each point of the plan.
    known: Vec<Option<PointResult>>,
    /// By point and repeat, of points that are not finished.
    runs: BTreeMap<(usize, u32), Repeat>,
    bar: progress::Patient,
    /// Points that are kept.
    done: Arc<AtomicUsize>,
}

impl Work<'_> {
    /// A run is over and is kept; with the last of its point that is finished.
    fn take(&mut self, index: usize, repeat: u32, run: Repeat, folder: &StudyFolder) -> Result<(), String> {
        let (point, all) = (&self.plan.points[index], self.plan.study.repeats);
        folder.keep(point, repeat, &run).map_err(|error| error.to_string())?;
        self.runs.insert((index, repeat), run);
        let runs: Vec<Repeat> = (0..all).map_while(|repeat| self.runs.get(&(index, repeat)).cloned()).collect();
        if runs.len() == all as usize {
            self.known[index] = Some(PointResult::from_repeats(point, &runs));
            self.runs.retain(|(other, _), _| *other != index);
            self.done.fetch_add(1, Ordering::Relaxed);
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
