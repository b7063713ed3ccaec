//! Errors of work on other machines.

use super::{Ending, Request};
use crate::store::StoreError;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// A failure to submit work to a cluster, or a failure of the work there.
#[derive(Debug)]
pub enum ClusterError {
    /// A program of the scheduler cannot be started.
    NotHere {
        program: &'static str,
        cause: io::Error,
    },
    /// A program of the scheduler has refused; `said` is its message.
    Refused {
        program: &'static str,
        said: String,
    },
    /// No partition takes the task; `known` are the names of the partitions.
    NoPartition {
        request: Request,
        known: Vec<String>,
    },
    /// Pieces that have failed too often: their number, the end of the last task, and the folder of its output.
    GivenUp {
        pieces: usize,
        ending: Ending,
        logs: PathBuf,
    },
    /// A path that cannot be used in a script.
    Path {
        path: PathBuf,
    },
    Store(StoreError),
}

impl ClusterError {
    /// Help for the user at the command line.
    pub fn help(&self) -> String {
        match self {
            ClusterError::NotHere { .. } => {
                "run this on a machine with the Slurm commands, or leave out `--executor slurm`".into()
            }
            ClusterError::Refused { program, .. } if *program != "sbatch" => {
                format!("check that `{program}` works on this machine, or leave out `--executor slurm`")
            }
            ClusterError::Refused { .. } => {
                "add the options that your cluster needs with `--sbatch`, such as `--sbatch=--account=NAME`; then use `--resume`"
                    .into()
            }
            ClusterError::NoPartition { .. } => {
                "name a partition with `--partition`, or make the points smaller: `trackbed plan` shows time and memory of a point"
                    .into()
            }
            ClusterError::GivenUp { logs, .. } => {
                format!("read the last lines of the files in `{}`, then continue with `--resume`", logs.display())
            }
            ClusterError::Path { .. } => {
                "use a directory whose path has no line break, quotation mark, dollar sign, backquote or backslash".into()
            }
            ClusterError::Store(error) => error.help().into(),
        }
    }
}

impl fmt::Display for ClusterError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClusterError::NotHere { program, cause } => write!(out, "cannot start `{program}`: {cause}"),
            ClusterError::Refused { program, said } => write!(out, "`{program}` refused: {said}"),
            ClusterError::NoPartition { request, known } => {
                let Request { minutes, megabytes } = request;
                write!(out, "no partition takes a task of {minutes} min and {megabytes} MiB")?;
                if known.is_empty() { Ok(()) } else { write!(out, " (there are `{}`)", known.join("`, `")) }
            }
            ClusterError::GivenUp { pieces, ending, .. } => {
                let runs = if *pieces == 1 { "1 run is" } else { &format!("{pieces} runs are") };
                write!(out, "{runs} missing: the last attempt {}", ending.words())
            }
            ClusterError::Path { path } => write!(out, "the path `{}` cannot be used in a script", path.display()),
            ClusterError::Store(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for ClusterError {}

impl From<StoreError> for ClusterError {
    fn from(error: StoreError) -> Self {
        ClusterError::Store(error)
    }
}
