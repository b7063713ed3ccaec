//! Slurm: job arrays by `sbatch`, their states by `squeue`, partitions by `sinfo`.

use super::scheduler::States;
use super::{Array, ClusterError, Ending, Request, Scheduler, State};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Largest array if Slurm gives no limit: the default of Slurm.
const LARGEST_ARRAY: usize = 1000;

/// A partition of the cluster.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partition {
    pub name: String,
    /// Whether jobs without a partition use it.
    pub is_default: bool,
    /// Longest job, minutes; `None` without a limit.
    pub minutes: Option<u64>,
    /// Memory of its smallest machines, MiB.
    pub megabytes: u64,
    pub cores: u64,
}

/// Settings for tasks in Slurm.
#[derive(Debug, Clone)]
pub struct Slurm {
    /// Name of the jobs in the queue.
    pub name: String,
    /// This program.
    pub program: PathBuf,
    /// The directory of results, which all machines can read.
    pub directory: PathBuf,
    /// Folder of the output of tasks, one file for each task.
    pub logs: PathBuf,
    /// The partition that the user has named.
    pub partition: Option<String>,
    /// Partitions of the cluster; empty if they are not known.
    pub partitions: Vec<Partition>,
    /// Cores of each task.
    pub cores: u16,
    /// Largest number of tasks of an array that run at the same time.
    pub at_a_time: Option<u16>,
    /// Further arguments of `sbatch`.
    pub further: Vec<String>,
    /// Largest number of tasks in an array.
    pub largest_array: usize,
}

impl Slurm {
    /// The script of an array. Fails if no partition takes it or if a path cannot be used in a script.
    pub fn script(&self, array: &Array) -> Result<String, ClusterError> {
        let Request { minutes, megabytes } = array.request;
        let at_a_time = self.at_a_time.map_or(String::new(), |count| format!("%{count}"));
        let mut options = vec![
            format!("--job-name={}", self.name),
            format!("--array=0-{}{at_a_time}", array.count.saturating_sub(1)),
            format!("--time={minutes}"),
            format!("--mem={megabytes}M"),
            format!("--cpus-per-task={}", self.cores),
            format!("--output={}", quoted(&self.logs.join("%A_%a.txt"), '"')?),
        ];
        options.extend(self.partition_of(array.request)?.map(|name| format!("--partition={name}")));
        let options: String = options.iter().map(|option| format!("#SBATCH {option}\n")).collect();
        let (program, directory) = (quoted(&self.program, '\'')?, quoted(&self.directory, '\'')?);
        let number = format!("$(({} + SLURM_ARRAY_TASK_ID))", array.first);
        Ok(format!("#!/bin/sh\n{options}exec {program} work {directory} {number} --threads {}\n", self.cores))
    }

    /// The partition for a request: the named partition; `None` if the default partition takes the request; otherwise
    /// the partition with the shortest limit that takes it.
    fn partition_of(&self, request: Request) -> Result<Option<String>, ClusterError> {
        if self.partition.is_some() || self.partitions.is_empty() {
            return Ok(self.partition.clone());
        }
        let takes = |partition: &&Partition| {
            partition.minutes.is_none_or(|m| m >= request.minutes) && self.fits(partition, request)
        };
        let fitting: Vec<&Partition> = self.partitions.iter().filter(takes).collect();
        if fitting.iter().any(|partition| partition.is_default) {
            return Ok(None);
        }
        let shortest = fitting.iter().min_by_key(|partition| partition.minutes.unwrap_or(u64::MAX));
        let known = || self.partitions.iter().map(|partition| partition.name.clone()).collect();
        shortest.map(|p| Some(p.name.clone())).ok_or_else(|| ClusterError::NoPartition { request, known: known() })
    }

    /// Whether the machines of a partition are large enough.
    fn fits(&self, partition: &Partition, request: Request) -> bool {
        partition.megabytes >= request.megabytes && partition.cores >= self.cores.into()
    }

    /// Available partitions of the cluster.
    pub fn partitions() -> Result<Vec<Partition>, ClusterError> {
        let arguments = ["--noheader", "--format=%a|%P|%l|%m|%c"];
        Ok(said("sinfo", Command::new("sinfo").args(arguments).output())?.lines().filter_map(partition).collect())
    }

    /// Largest number of tasks in an array, from the configuration of the cluster.
    pub fn array_limit() -> usize {
        let told = said("scontrol", Command::new("scontrol").args(["show", "config"]).output());
        let limit = |line: &str| line.strip_prefix("MaxArraySize")?.trim_start_matches([' ', '=']).trim().parse().ok();
        // the largest index is one less
        told.ok()
            .and_then(|text| text.lines().find_map(limit))
            .map_or(LARGEST_ARRAY, |most: usize| most.saturating_sub(1))
    }
}

impl Scheduler for Slurm {
    fn submit(&self, array: &Array) -> Result<String, ClusterError> {
        let script = self.script(array)?;
        let mut command = Command::new("sbatch");
        command
            .arg("--parsable")
            .args(&self.further)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let answer = command.spawn().and_then(|mut child| {
            if let Some(mut input) = child.stdin.take() {
                input.write_all(script.as_bytes())?;
            }
            child.wait_with_output()
        });
        let answer = said("sbatch", answer)?;
        // the name of the cluster follows after a semicolon if there are several clusters
        Ok(answer.trim().split(';').next().unwrap_or_default().to_owned())
    }

    fn states(&self) -> Result<States, ClusterError> {
        let arguments = ["--me", "--noheader", "--array", "--states=all", "--format=%F|%K|%T|%r"];
        let told = said("squeue", Command::new("squeue").args(arguments).output())?;
        Ok(told.lines().filter_map(state).collect())
    }

    fn largest_array(&self) -> usize {
        self.largest_array
    }

    fn longest(&self, request: Request) -> Option<u64> {
        let asked = |partition: &&Partition| match &self.partition {
            Some(name) => partition.name == *name,
            None => self.fits(partition, request),
        };
        let limits: Vec<Option<u64>> =
            self.partitions.iter().filter(asked).map(|partition| partition.minutes).collect();
        // a partition without a limit takes any task
        limits.into_iter().collect::<Option<Vec<u64>>>()?.into_iter().max()
    }
}

/// Output of a program. Fails if the program could not be started or has failed.
fn said(program: &'static str, output: std::io::Result<Output>) -> Result<String, ClusterError> {
    let output = output.map_err(|cause| ClusterError::NotHere { program, cause })?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let said = said.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ");
        return Err(ClusterError::Refused { program, said });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A path in quotation marks for a script.
fn quoted(path: &Path, mark: char) -> Result<String, ClusterError> {
    let text = path.display().to_string();
    let broken = text.contains(['\n', '\'', '"', '$', '`', '\\']);
    if broken { Err(ClusterError::Path { path: path.to_owned() }) } else { Ok(format!("{mark}{text}{mark}")) }
}

/// `up|short*|1:00:00|64000+|16`
fn partition(line: &str) -> Option<Partition> {
    let [availability, name, limit, megabytes, cores] = line.trim().split('|').collect::<Vec<_>>().try_into().ok()?;
    let number = |text: &str| text.trim_end_matches('+').parse().ok();
    (availability == "up").then_some(())?;
    Some(Partition {
        name: name.trim_end_matches('*').to_owned(),
        is_default: name.ends_with('*'),
        minutes: if limit == "infinite" { None } else { Some(minutes(limit)?) },
        megabytes: number(megabytes)?,
        cores: number(cores)?,
    })
}

/// Whole minutes of `days-hours:minutes:seconds`; the first parts may be missing.
fn minutes(limit: &str) -> Option<u64> {
    let (days, clock) = limit.split_once('-').unwrap_or(("0", limit));
    let parts: Vec<u64> = clock.split(':').map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let (hours, minutes) = match parts.as_slice() {
        [hours, minutes, _] => (*hours, *minutes),
        [minutes, _] => (0, *minutes),
        _ => return None,
    };
    Some((days.parse::<u64>().ok()? * 24 + hours) * 60 + minutes)
}

/// `41|3|RUNNING|None`
fn state(line: &str) -> Option<((String, usize), State)> {
    let [job, place, state, why] = line.trim().split('|').collect::<Vec<_>>().try_into().ok()?;
    let state = match state {
        "RUNNING" | "COMPLETING" | "STAGE_OUT" | "SIGNALING" | "STOPPED" => State::Running,
        "COMPLETED" => State::Ended(Ending::Done),
        "FAILED" => State::Ended(Ending::Failed),
        "TIMEOUT" | "DEADLINE" => State::Ended(Ending::TimedOut),
        "OUT_OF_MEMORY" => State::Ended(Ending::OutOfMemory),
        "NODE_FAIL" | "BOOT_FAIL" | "PREEMPTED" | "REVOKED" => State::Ended(Ending::Lost),
        "CANCELLED" => State::Ended(Ending::Cancelled),
        _ => State::Waiting(why.to_owned()),
    };
    Some(((job.to_owned(), place.parse().ok()?), state))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slurm() -> Slurm {
        Slurm {
            name: "pads".into(),
            program: "/opt/track bed/trackbed".into(),
            directory: "/home/a/out".into(),
            logs: "/home/a/out/.trackbed/logs".into(),
            partition: None,
            partitions: Vec::new(),
            cores: 2,
            at_a_time: Some(8),
            further: Vec::new(),
            largest_array: 1000,
        }
    }

    fn array(minutes: u64, megabytes: u64) -> Array {
        Array { first: 7, count: 12, request: Request { minutes, megabytes } }
    }

    #[test]
    fn a_script_says_what_its_tasks_need() {
        let expected = "#!/bin/sh
#SBATCH --job-name=pads
#SBATCH --array=0-11%8
#SBATCH --time=30
#SBATCH --mem=1024M
#SBATCH --cpus-per-task=2
#SBATCH --output=\"/home/a/out/.trackbed/logs/%A_%a.txt\"
exec '/opt/track bed/trackbed' work '/home/a/out' $((7 + SLURM_ARRAY_TASK_ID)) --threads 2
";
        assert_eq!(slurm().script(&array(30, 1024)).unwrap(), expected);
        let broken = Slurm { directory: "/home/a'; rm -r /'".into(), ..slurm() };
        assert!(matches!(broken.script(&array(30, 1024)), Err(ClusterError::Path { .. })));
    }

    #[test]
    fn the_partition_is_one_that_takes_the_task() {
        let lines = "up|short*|1:00:00|16000|8\nup|long|7-00:00:00|64000+|16\ndown|huge|infinite|999999|64\nup|day|1-00:00:00|64000|16\n";
        let partitions: Vec<Partition> = lines.lines().filter_map(partition).collect();
        assert_eq!(partitions.iter().map(|p| p.minutes).collect::<Vec<_>>(), [Some(60), Some(10_080), Some(1440)]);
        let slurm = Slurm { partitions, ..slurm() };
        let of = |minutes, megabytes| slurm.partition_of(Request { minutes, megabytes });
        assert_eq!(of(60, 8192).unwrap(), None, "the default one");
        assert_eq!(of(90, 8192).unwrap().as_deref(), Some("day"));
        assert_eq!(of(2880, 8192).unwrap().as_deref(), Some("long"));
        assert_eq!(of(5, 32768).unwrap().as_deref(), Some("day"), "the default has too little memory");
        let error = of(5, 131_072).unwrap_err().to_string();
        assert_eq!(error, "no partition takes a task of 5 min and 131072 MiB (there are `short`, `long`, `day`)");
        let longest = |megabytes| slurm.longest(Request { minutes: 1 << 20, megabytes });
        assert_eq!((longest(8192), longest(131_072)), (Some(10_080), None));
        let short = Slurm { partition: Some("short".into()), ..slurm.clone() };
        assert_eq!(short.longest(Request { minutes: 1 << 20, megabytes: 512 }), Some(60));
        let named = Slurm { partition: Some("gpu".into()), ..slurm };
        assert_eq!(named.partition_of(Request { minutes: 90, megabytes: 1 << 30 }).unwrap().as_deref(), Some("gpu"));
    }

    #[test]
    fn states_are_read() {
        let told = "41|0|RUNNING|None\n41|1|PENDING|Resources\n41|2|TIMEOUT|TimeLimit\n42|0|OUT_OF_MEMORY|None\n42|N/A|RUNNING|None\n";
        let states: States = told.lines().filter_map(state).collect();
        let of = |job: &str, place: usize| states[&(job.to_owned(), place)].clone();
        assert_eq!(of("41", 0), State::Running);
        assert_eq!(of("41", 1), State::Waiting("Resources".into()));
        assert_eq!(of("41", 2), State::Ended(Ending::TimedOut));
        assert_eq!(of("42", 0), State::Ended(Ending::OutOfMemory));
        assert_eq!(states.len(), 4, "a job without an array is somebody else's");
    }

    #[test]
    fn a_cluster_that_is_not_there_is_told() {
        let error = said("no_such_scheduler", Command::new("no_such_scheduler").output()).unwrap_err();
        assert!(error.to_string().starts_with("cannot start `no_such_scheduler`"), "{error}");
        let error =
            said("sbatch", Command::new("sh").args(["-c", "echo no account >&2; exit 1"]).output()).unwrap_err();
        assert_eq!(error.to_string(), "`sbatch` refused: no account");
    }
}
