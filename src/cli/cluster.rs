//! What `study` and `run` share of work on a cluster: its options, its scripts, the watch over its jobs.

use super::{Outcome, interrupt, progress, terminal};
use crate::cluster::{self, Array, ClusterError, Ledger, Need, Scheduler, Seen, Slurm, Watch, Work};
use crate::diag::{Code, Diagnostic};
use crate::store::{StoreError, Unfinished};
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// Where work is done, and how a cluster is asked for it.
#[derive(clap::Args, Default)]
pub(super) struct ClusterArguments {
    /// Where work is done
    #[arg(long, value_enum, default_value = "local")]
    pub executor: Executor,
    /// Show the scripts that `--executor slurm` would submit, and submit nothing
    #[arg(long)]
    pub dry_run: bool,
    /// The partition for all tasks; else the default one, or the shortest that takes the task
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Cores of each task on the cluster
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    cores: Option<u16>,
    /// A further argument of `sbatch`, such as `--sbatch=--account=rail`
    #[arg(long, value_name = "ARGUMENT", allow_hyphen_values = true)]
    sbatch: Vec<String>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Executor {
    /// This machine
    #[default]
    Local,
    /// Slurm: job arrays, which are watched until all results are there
    Slurm,
    /// `trackbed work`, which another program starts: PBS, HyperQueue, xargs
    Workers,
}

impl ClusterArguments {
    /// Says of options that only a cluster understands that they need one; whether there were any.
    pub fn are_misused(&self) -> bool {
        let given = [
            (self.dry_run, "--dry-run"),
            (self.partition.is_some(), "--partition"),
            (self.cores.is_some(), "--cores"),
            (!self.sbatch.is_empty(), "--sbatch"),
        ];
        let misused = given.into_iter().find(|(is_given, _)| *is_given && self.executor != Executor::Slurm);
        if let Some((_, option)) = misused {
            terminal::error(&format!("`{option}` needs `--executor slurm`"));
        }
        misused.is_some()
    }
}

/// Work that a cluster is to do.
pub(super) struct Elsewhere<'a> {
    pub arguments: &'a ClusterArguments,
    /// What the queue calls it.
    pub name: &'a str,
    /// The directory of results.
    pub out: &'a Path,
    /// Tasks at a time.
    pub at_a_time: Option<u16>,
}

/// The key of the ledger among the pieces of work.
const LEDGER: &str = "ledger";
/// Looks follow each other by these times: the first task may be short, and a queue is not to be asked often.
const PAUSES: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(10)];

impl Elsewhere<'_> {
    /// The scripts that would be submitted for such work.
    pub fn dry_run(&self, needs: &[Need]) -> Result<String, ClusterError> {
        // on a machine without Slurm the partition stays open
        let partitions = Slurm::partitions().unwrap_or_default();
        let slurm = Slurm { partitions, ..self.slurm(&self.out.join(".trackbed/logs")) };
        let mut tasks = cluster::tasks(&needs.iter().copied().enumerate().collect::<Vec<_>>());
        for task in &mut tasks {
            task.request = task.request_within(needs, |request| slurm.longest(request));
        }
        tasks.sort_by_key(|task| task.request);
        let mut scripts = String::new();
        let mut first = 0;
        for alike in tasks.chunk_by(|a, b| a.request == b.request) {
            let runs: usize = alike.iter().map(|task| task.pieces.len()).sum();
            let array = Array { first, count: alike.len(), request: alike[0].request };
            scripts +=
                &format!("# {}, {}\n{}\n", counted(alike.len(), "task"), counted(runs, "run"), slurm.script(&array)?);
            first += alike.len();
        }
        Ok(scripts)
    }

    /// Fails where the cluster that is asked for does not answer.
    pub fn reach(&self) -> Result<(), ClusterError> {
        if self.arguments.executor == Executor::Slurm { Slurm::partitions().map(drop) } else { Ok(()) }
    }

    /// Gives work to Slurm and waits for all of it. Gives an outcome where somebody has asked to stop.
    pub fn watch(&self, work: &dyn Work, state: &Unfinished) -> Result<Option<Outcome>, ClusterError> {
        let partitions = Slurm::partitions()?;
        let logs = absolute(&state.logs()?);
        let slurm = Slurm { partitions, largest_array: Slurm::array_limit(), ..self.slurm(&logs) };
        let mut watch = Watch::new(work, &slurm, ledger(state)?);
        watch.submit()?;
        let (asked, mut shown) = (interrupt::asked(), Shown::new(work.missing()?.len()));
        let mut pause = PAUSES[0];
        loop {
            let seen = watch.look()?;
            pause = if shown.show(&seen) { PAUSES[0] } else { (pause * 3 / 2).min(PAUSES[1]) };
            if seen.missing == 0 {
                return Ok(None);
            }
            let until = Instant::now() + pause;
            while Instant::now() < until {
                if asked.load(Ordering::Relaxed) {
                    drop(shown);
                    return Ok(Some(left(watch.ledger(), &seen)));
                }
                thread::sleep(PAUSES[0] / 4);
            }
        }
    }

    /// Writes the tasks of what is missing for workers, and says how they are started.
    pub fn for_workers(&self, work: &dyn Work) -> Result<Outcome, ClusterError> {
        let missing: Vec<(usize, Need)> =
            work.missing()?.into_iter().map(|piece| (piece, work.needs()[piece])).collect();
        let tasks = cluster::tasks(&missing);
        for (number, task) in tasks.iter().enumerate() {
            work.put(number, &task.pieces)?;
        }
        let (out, last) = (self.out.display(), tasks.len().saturating_sub(1));
        terminal::summary(&format!(
            "`{out}` holds {} with {}; start them on any machine that sees this directory, for example\n  \
             seq 0 {last} | xargs -P 4 -n 1 trackbed work '{out}'\n\
             then run the same command with `--resume` and without `--executor`: it gives the answer\n",
            counted(tasks.len(), "task"),
            counted(missing.len(), "run")
        ));
        Ok(Outcome::Fine)
    }

    fn slurm(&self, logs: &Path) -> Slurm {
        Slurm {
            name: self.name.to_owned(),
            program: std::env::current_exe().unwrap_or_else(|_| "trackbed".into()),
            directory: absolute(self.out),
            logs: absolute(logs),
            partition: self.arguments.partition.clone(),
            partitions: Vec::new(),
            cores: self.arguments.cores.unwrap_or(1),
            at_a_time: self.at_a_time,
            further: self.arguments.sbatch.clone(),
            largest_array: usize::MAX,
        }
    }
}

/// Why a cluster does not do some work.
pub(super) fn diagnostic(error: &ClusterError) -> Diagnostic {
    match error {
        ClusterError::Store(error) => super::stored::diagnostic(error),
        other => Diagnostic::new(Code::E0815, other.to_string()).help(other.help()),
    }
}

/// Keeps a task, or the ledger, beside work under way.
pub(super) fn put_json(state: &Unfinished, key: &str, value: &impl serde::Serialize) -> Result<(), StoreError> {
    let bytes = serde_json::to_vec(value).map_err(|cause| StoreError::unwritable(state.path(), cause))?;
    state.add(key, &bytes).map(drop)
}

/// Keeps what has been given to a cluster.
pub(super) fn keep_ledger(state: &Unfinished, ledger: &Ledger) -> Result<(), StoreError> {
    put_json(state, LEDGER, ledger)
}

/// Whether something has been given to a cluster.
pub(super) fn has_ledger(state: &Unfinished) -> bool {
    state.keys().is_ok_and(|keys| keys.contains(LEDGER))
}

fn ledger(state: &Unfinished) -> Result<Ledger, StoreError> {
    let Some(bytes) = state.kept(LEDGER)? else { return Ok(Ledger::default()) };
    serde_json::from_slice(&bytes).map_err(|cause| StoreError::damaged(state.path(), cause))
}

/// `1 run`, `3 runs`
pub(super) fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The same path from the root, links as they are: the names that other machines see.
pub(super) fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Says how to go on with jobs that nobody watches any more.
fn left(ledger: &Ledger, seen: &Seen) -> Outcome {
    let jobs = ledger.jobs().join(" ");
    terminal::note(&format!(
        "stopped with {} left, and the jobs go on ({jobs})\nto watch them again, run the same command with `--resume`; to end them: scancel {jobs}\n",
        counted(seen.missing, "run")
    ));
    Outcome::Failed
}

/// What people see of a watch.
struct Shown {
    all: usize,
    last: Option<Seen>,
    bar: progress::Patient,
}

impl Shown {
    fn new(all: usize) -> Shown {
        Shown { all, last: None, bar: progress::Patient::seen("the runs") }
    }

    /// Shows what was seen; whether it is something new.
    fn show(&mut self, seen: &Seen) -> bool {
        let is_new = self.last.as_ref() != Some(seen);
        self.bar.show(self.all.saturating_sub(seen.missing) as u64, self.all as u64);
        if let Some((_, ending)) = seen.again.first() {
            terminal::note(&format!(
                "given again: {}, the task {}\n",
                counted(seen.again.len(), "run"),
                ending.words()
            ));
        }
        let begins = self.last.as_ref().is_none_or(|last| last.running == 0) && seen.running > 0;
        let waits = self.last.is_none() && seen.running == 0 && seen.waiting > 0;
        if begins || waits {
            let why = if waits && !seen.why.is_empty() { format!(" ({})", seen.why) } else { String::new() };
            terminal::note(&format!("tasks: {} running, {} waiting{why}\n", seen.running, seen.waiting));
        }
        self.last = Some(seen.clone());
        is_new
    }
}
