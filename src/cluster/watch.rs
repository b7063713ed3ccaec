//! Submits pieces of work to a scheduler and watches them. Only the directory of results shows whether a piece is done;
//! the scheduler only shows which tasks still run.

use super::{Array, ClusterError, Ending, Need, Request, Scheduler, State, Task, tasks};
use crate::store::StoreError;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Number of attempts before a piece is given up.
const ATTEMPTS: u32 = 3;
/// Largest number of parts of a piece that continues from its checkpoint; each part is as long as a task may be.
const PARTS: u32 = 100;

/// Work in pieces, with numbers from 0, for processes on other machines.
pub trait Work {
    fn needs(&self) -> &[Need];

    /// Pieces that are not done yet.
    fn missing(&self) -> Result<BTreeSet<usize>, StoreError>;

    /// Stores the pieces of a task for the process that will do it.
    fn put(&self, task: usize, pieces: &[usize]) -> Result<(), StoreError>;

    /// Stores the ledger, so that another process can continue to watch.
    fn keep(&self, ledger: &Ledger) -> Result<(), StoreError>;

    /// Folder of the output of tasks.
    fn logs(&self) -> PathBuf;
}

/// Record of the tasks that were submitted to a scheduler.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ledger {
    jobs: Vec<Job>,
    /// Pieces of every task.
    tasks: Vec<Vec<usize>>,
    /// Number of submissions of each piece.
    attempts: BTreeMap<usize, u32>,
    /// Number of time-outs of each piece that continues from its checkpoint.
    #[serde(default)]
    parts: BTreeMap<usize, u32>,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Job {
    name: String,
    array: Array,
    /// Indices of tasks that are known to have ended.
    over: BTreeSet<usize>,
}

/// Result of a look.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Seen {
    pub missing: usize,
    /// Number of running tasks.
    pub running: usize,
    pub waiting: usize,
    /// Reason why the first waiting task waits.
    pub why: String,
    /// Pieces that were submitted again in this look, with the end of their tasks.
    pub again: Vec<(usize, Ending)>,
}

/// Work in a scheduler.
pub struct Watch<'a> {
    work: &'a dyn Work,
    scheduler: &'a dyn Scheduler,
    ledger: Ledger,
    /// Tasks that had ended without all their pieces at the last look: a shared disk may show the pieces later.
    doubtful: BTreeSet<usize>,
    given_up: BTreeMap<usize, Ending>,
}

impl Ledger {
    /// Pieces of tasks that are not known to be over.
    fn under_way(&self) -> BTreeSet<usize> {
        let places = |job: &Job| {
            (0..job.array.count)
                .filter(|place| !job.over.contains(place))
                .map(|p| p + job.array.first)
                .collect::<Vec<_>>()
        };
        self.jobs.iter().flat_map(places).flat_map(|task| self.tasks[task].iter().copied()).collect()
    }

    /// Names of the jobs that are not known to be over.
    pub fn jobs(&self) -> Vec<&str> {
        self.jobs.iter().filter(|job| job.over.len() < job.array.count).map(|job| job.name.as_str()).collect()
    }
}

impl<'a> Watch<'a> {
    /// Continues from a ledger, which may be empty.
    pub fn new(work: &'a dyn Work, scheduler: &'a dyn Scheduler, ledger: Ledger) -> Watch<'a> {
        Watch { work, scheduler, ledger, doubtful: BTreeSet::new(), given_up: BTreeMap::new() }
    }

    /// Record of the submitted tasks.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Submits all missing pieces that no task has. Attempts are counted again from 0, because the user may have
    /// corrected the cause.
    pub fn submit(&mut self) -> Result<(), ClusterError> {
        self.ledger.attempts.clear();
        self.ledger.parts.clear();
        let under_way = self.ledger.under_way();
        let missing = self.work.missing()?.into_iter().filter(|piece| !under_way.contains(piece));
        let pieces: Vec<(usize, Need)> = missing.map(|piece| (piece, self.work.needs()[piece])).collect();
        self.give(tasks(&pieces))
    }

    /// Looks once, and submits lost pieces again. Fails if pieces are missing after the last attempt and no other task
    /// is in progress.
    pub fn look(&mut self) -> Result<Seen, ClusterError> {
        let missing = self.work.missing()?;
        let states = if missing.is_empty() { BTreeMap::new() } else { self.scheduler.states()? };
        let mut seen = Seen { missing: missing.len(), ..Seen::default() };
        let mut again: BTreeMap<Request, Vec<usize>> = BTreeMap::new();
        for (job, place, task) in self.open_tasks() {
            let (name, request) = (self.ledger.jobs[job].name.clone(), self.ledger.jobs[job].array.request);
            let left: Vec<usize> =
                self.ledger.tasks[task].iter().copied().filter(|piece| missing.contains(piece)).collect();
            let ending = match states.get(&(name, place)) {
                _ if left.is_empty() => Ending::Done,
                Some(State::Running) => {
                    seen.running += 1;
                    continue;
                }
                Some(State::Waiting(why)) => {
                    if seen.waiting == 0 {
                        seen.why.clone_from(why);
                    }
                    seen.waiting += 1;
                    continue;
                }
                _ if self.doubtful.insert(task) => {
                    seen.running += 1;
                    continue;
                }
                Some(State::Ended(ending)) => *ending,
                None => Ending::Lost,
            };
            self.ledger.jobs[job].over.insert(place);
            let left = self.worth_another(left, ending);
            seen.again.extend(left.iter().map(|piece| (*piece, ending)));
            again.entry(grown(request, ending)).or_default().extend(left);
        }
        // now one task for each piece: a piece that fails does not stop the others
        let tasks = again
            .into_iter()
            .flat_map(|(request, pieces)| pieces.into_iter().map(move |piece| Task { request, pieces: vec![piece] }));
        self.give(tasks.collect())?;
        self.verdict(&missing, &seen)?;
        Ok(seen)
    }

    /// Job, place and number of every task that is not known to be over.
    fn open_tasks(&self) -> Vec<(usize, usize, usize)> {
        let of_job = |(job, it): (usize, &Job)| {
            let open = (0..it.array.count).filter(|place| !it.over.contains(place));
            open.map(|place| (job, place, it.array.first + place)).collect::<Vec<_>>()
        };
        self.ledger.jobs.iter().enumerate().flat_map(of_job).collect()
    }

    /// Pieces of a task that are submitted again.
    fn worth_another(&mut self, left: Vec<usize>, ending: Ending) -> Vec<usize> {
        let needs = self.work.needs();
        let in_parts = |piece: &&usize| ending == Ending::TimedOut && needs[**piece].goes_on;
        for piece in left.iter().filter(in_parts) {
            // it has made progress, so this is not a failed attempt
            *self.ledger.parts.entry(*piece).or_default() += 1;
            self.ledger.attempts.remove(piece);
        }
        let count = |of: &BTreeMap<usize, u32>, piece: &usize| of.get(piece).copied().unwrap_or(0);
        let tried = |piece: &usize| count(&self.ledger.attempts, piece) >= ATTEMPTS;
        let hopeless =
            |piece: &usize| ending == Ending::Cancelled || tried(piece) || count(&self.ledger.parts, piece) >= PARTS;
        let (given_up, again): (Vec<usize>, Vec<usize>) = left.into_iter().partition(hopeless);
        self.given_up.extend(given_up.into_iter().map(|piece| (piece, ending)));
        again
    }

    fn verdict(&self, missing: &BTreeSet<usize>, seen: &Seen) -> Result<(), ClusterError> {
        let hopeless = self.given_up.iter().filter(|(piece, _)| missing.contains(piece));
        let hopeless: Vec<Ending> = hopeless.map(|(_, ending)| *ending).collect();
        match hopeless.last() {
            Some(ending) if seen.running + seen.waiting == 0 && seen.again.is_empty() => {
                Err(ClusterError::GivenUp { pieces: hopeless.len(), ending: *ending, logs: self.work.logs() })
            }
            _ => Ok(()),
        }
    }

    /// Submits tasks; tasks with the same request are one array. The ledger is stored after each array, so a kill in
    /// between loses at most one array, whose pieces are then done twice.
    fn give(&mut self, mut tasks: Vec<Task>) -> Result<(), ClusterError> {
        for task in &mut tasks {
            task.request = task.request_within(self.work.needs(), |request| self.scheduler.longest(request));
        }
        tasks.sort_by_key(|task| task.request);
        for alike in tasks.chunk_by(|a, b| a.request == b.request) {
            for some in alike.chunks(self.scheduler.largest_array().max(1)) {
                let array = Array { first: self.ledger.tasks.len(), count: some.len(), request: some[0].request };
                for task in some {
                    self.work.put(self.ledger.tasks.len(), &task.pieces)?;
                    self.ledger.tasks.push(task.pieces.clone());
                    task.pieces.iter().for_each(|piece| *self.ledger.attempts.entry(*piece).or_default() += 1);
                }
                let name = self.scheduler.submit(&array)?;
                self.ledger.jobs.push(Job { name, array, over: BTreeSet::new() });
                self.work.keep(&self.ledger)?;
            }
        }
        Ok(())
    }
}

/// Request of the next task after this end.
fn grown(request: Request, ending: Ending) -> Request {
    match ending {
        Ending::TimedOut => request.longer(),
        Ending::OutOfMemory => request.larger(),
        Ending::Done | Ending::Failed | Ending::Lost | Ending::Cancelled => request,
    }
}

#[cfg(test)]
mod tests;
