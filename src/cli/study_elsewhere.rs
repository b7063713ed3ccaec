//! Points of a study on other machines: as job arrays of Slurm, or by workers that another program starts.

use super::{Outcome, interrupt, progress, terminal};
use crate::cluster::{self, Array, ClusterError, Ledger, Need, Seen, Slurm, Watch, Work};
use crate::store::{Directory, StoreError};
use crate::study::{self, Plan, Scene, StudyFolder, Task, TaskRun};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// How a cluster is asked.
#[derive(clap::Args)]
pub(super) struct ClusterArguments {
    /// Show the scripts that `--executor slurm` would submit, and submit nothing
    #[arg(long)]
    pub dry_run: bool,
    /// The partition for all tasks; else the default one, or the shortest that takes the task
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Cores of each task
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    cores: Option<u16>,
    /// A further argument of `sbatch`, such as `--sbatch=--account=rail`
    #[arg(long, value_name = "ARGUMENT", allow_hyphen_values = true)]
    sbatch: Vec<String>,
}

impl ClusterArguments {
    /// One of the options that only a cluster understands, where one was given.
    pub fn given(&self) -> Option<&'static str> {
        let given = [
            (self.dry_run, "--dry-run"),
            (self.partition.is_some(), "--partition"),
            (self.cores.is_some(), "--cores"),
            (!self.sbatch.is_empty(), "--sbatch"),
        ];
        given.into_iter().find(|(is_given, _)| *is_given).map(|(_, name)| name)
    }
}

/// A study that other processes compute.
#[derive(Clone, Copy)]
pub(super) struct Study<'a> {
    pub scene: Scene<'a>,
    pub plan: &'a Plan,
    pub out: &'a Path,
    pub cache: Option<&'a Path>,
}

/// The key of the ledger among the pieces of a study.
const LEDGER: &str = "ledger";
/// Looks follow each other by these times: the first task may be short, and a queue is not to be asked often.
const PAUSES: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(10)];

impl Study<'_> {
    /// The scripts that would be submitted for all points.
    pub fn dry_run(&self, arguments: &ClusterArguments, at_a_time: Option<u16>) -> Result<String, ClusterError> {
        // on a machine without Slurm the partition stays open
        let partitions = Slurm::partitions().unwrap_or_default();
        let slurm = Slurm { partitions, ..self.slurm(arguments, at_a_time, &self.out.join(".trackbed/logs")) };
        let needs = self.needs();
        let mut tasks = cluster::tasks(&needs.into_iter().enumerate().collect::<Vec<_>>());
        tasks.sort_by_key(|task| task.request);
        let mut scripts = String::new();
        let mut first = 0;
        for alike in tasks.chunk_by(|a, b| a.request == b.request) {
            let runs: usize = alike.iter().map(|task| task.pieces.len()).sum();
            let array = Array { first, count: alike.len(), request: alike[0].request };
            scripts += &format!("# {} tasks, {runs} runs\n{}\n", alike.len(), slurm.script(&array)?);
            first += alike.len();
        }
        Ok(scripts)
    }

    /// Gives the points to Slurm and waits for them. Gives an outcome where the study ends here without its answer.
    pub fn on_slurm(
        &self,
        folder: &StudyFolder,
        arguments: &ClusterArguments,
        at_a_time: Option<u16>,
    ) -> Result<Option<Outcome>, ClusterError> {
        let work = self.work(folder);
        let partitions = Slurm::partitions()?;
        let logs = folder.directory().shared().logs()?;
        let largest_array = Slurm::array_limit();
        let slurm = Slurm { partitions, largest_array, ..self.slurm(arguments, at_a_time, &absolute(&logs)) };
        let mut watch = Watch::new(&work, &slurm, work.ledger()?);
        watch.submit()?;
        let (asked, mut shown) = (interrupt::asked(), Shown::new(work.needs.len()));
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
                thread::sleep(PAUSES[0].min(pause) / 4);
            }
        }
    }

    /// Writes the tasks for workers, and says how they are started.
    pub fn for_workers(&self, folder: &StudyFolder) -> Result<Outcome, ClusterError> {
        let work = self.work(folder);
        let missing: Vec<(usize, Need)> = work.missing()?.into_iter().map(|piece| (piece, work.needs[piece])).collect();
        let tasks = cluster::tasks(&missing);
        for (number, task) in tasks.iter().enumerate() {
            work.put(number, &task.pieces)?;
        }
        let (out, last) = (self.out.display(), tasks.len() - 1);
        terminal::out(&format!(
            "{} tasks with {} runs are in `{out}`; start them wherever this directory is seen, for example\n  \
             seq 0 {last} | xargs -P 4 -n 1 trackbed work '{out}'\n\
             then the same command with `--resume` and without `--executor` gives the answer\n",
            tasks.len(),
            missing.len()
        ));
        Ok(Outcome::Fine)
    }

    fn slurm(&self, arguments: &ClusterArguments, at_a_time: Option<u16>, logs: &Path) -> Slurm {
        Slurm {
            name: self.plan.study.name.clone(),
            program: std::env::current_exe().unwrap_or_else(|_| "trackbed".into()),
            directory: absolute(self.out),
            logs: absolute(logs),
            partition: arguments.partition.clone(),
            partitions: Vec::new(),
            cores: arguments.cores.unwrap_or(1),
            at_a_time,
            further: arguments.sbatch.clone(),
            largest_array: usize::MAX,
        }
    }

    /// Of every run, in the order of [`Runs::number`].
    fn needs(&self) -> Vec<Need> {
        let of = |point: &study::PlannedPoint| Need { seconds: point.seconds, bytes: point.bytes };
        self.plan.points.iter().flat_map(|point| (0..self.plan.study.repeats).map(move |_| of(point))).collect()
    }

    fn work<'a>(&'a self, folder: &'a StudyFolder) -> Runs<'a> {
        Runs { study: self, directory: folder.directory(), needs: self.needs() }
    }
}

/// The runs of a study as pieces of work: those of the first point, those of the second one, and so on.
struct Runs<'a> {
    study: &'a Study<'a>,
    directory: &'a Directory,
    needs: Vec<Need>,
}

impl Runs<'_> {
    /// Place of the point in the plan, and its repeat.
    fn of(&self, piece: usize) -> (usize, u32) {
        let repeats = self.study.plan.study.repeats;
        (piece / repeats as usize, piece as u32 % repeats)
    }

    fn ledger(&self) -> Result<Ledger, StoreError> {
        let Some(bytes) = self.directory.kept(LEDGER)? else { return Ok(Ledger::default()) };
        serde_json::from_slice(&bytes).map_err(|cause| StoreError::damaged(self.directory.path(), cause))
    }

    fn put_json(&self, key: &str, value: &impl serde::Serialize) -> Result<(), StoreError> {
        let bytes = serde_json::to_vec(value);
        let bytes = bytes.map_err(|cause| StoreError::unwritable(self.directory.path(), cause))?;
        self.directory.keep(key, &bytes).map(drop)
    }
}

impl Work for Runs<'_> {
    fn needs(&self) -> &[Need] {
        &self.needs
    }

    fn missing(&self) -> Result<BTreeSet<usize>, StoreError> {
        let kept = self.directory.shared().keys()?;
        let is_missing = |piece: &usize| {
            let (point, repeat) = self.of(*piece);
            !kept.contains(&self.study.plan.points[point].key(repeat))
        };
        Ok((0..self.needs.len()).filter(is_missing).collect())
    }

    fn put(&self, task: usize, pieces: &[usize]) -> Result<(), StoreError> {
        let Study { scene, plan, cache, .. } = self.study;
        let run = |piece: &usize| {
            let (point, repeat) = self.of(*piece);
            TaskRun::new(&plan.points[point], repeat)
        };
        let value = Task {
            scene: absolute(Path::new(scene.name)),
            set: scene.set.to_vec(),
            study: plan.study.name.clone(),
            cache: cache.map(absolute),
            runs: pieces.iter().map(run).collect(),
        };
        self.put_json(&Task::key(task), &value)
    }

    fn keep(&self, ledger: &Ledger) -> Result<(), StoreError> {
        self.put_json(LEDGER, ledger)
    }

    fn logs(&self) -> PathBuf {
        self.directory.path().join(".trackbed/logs")
    }
}

/// The same path from the root, links as they are: the names that other machines see.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Says how to go on with jobs that nobody watches any more.
fn left(ledger: &Ledger, seen: &Seen) -> Outcome {
    let jobs = ledger.jobs().join(" ");
    terminal::note(&format!(
        "stopped: {} runs are missing, and the jobs go on ({jobs})\nto watch them again, run the same command with `--resume`; to end them: scancel {jobs}\n",
        seen.missing
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
        Shown { all, last: None, bar: progress::Patient::seen("the study") }
    }

    /// Shows what was seen; whether it is something new.
    fn show(&mut self, seen: &Seen) -> bool {
        let is_new = self.last.as_ref() != Some(seen);
        self.bar.show((self.all - seen.missing) as u64, self.all as u64);
        if let Some((_, ending)) = seen.again.first() {
            terminal::note(&format!("{} runs are given again: their task {}\n", seen.again.len(), ending.words()));
        }
        let begins = self.last.as_ref().is_none_or(|last| last.running == 0) && seen.running > 0;
        let waits = self.last.is_none() && seen.running == 0 && seen.waiting > 0;
        if begins || waits {
            let why = if waits && !seen.why.is_empty() { format!(" ({})", seen.why) } else { String::new() };
            terminal::note(&format!("{} tasks run, {} wait{why}\n", seen.running, seen.waiting));
        }
        self.last = Some(seen.clone());
        is_new
    }
}
