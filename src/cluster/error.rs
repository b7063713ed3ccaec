//! What can go wrong beyond this machine.

use super::{Ending, Request};
use crate::store::StoreError;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// A failure to give work to a cluster, or of the work there.
#[derive(Debug)]
pub enum ClusterError {
    /// A program of the scheduler cannot be started.
    NotHere {
        program: &'static str,
        cause: io::Error,
    },
    /// A program of the scheduler has refused, with its own words.
    Refused {
        program: &'static str,
        said: String,
    },
    /// No partition takes such a task; the names of those that there are.
    NoPartition {
        request: Request,
        known: Vec<String>,
    },
    /// Pieces that have been given as often as is sensible; how many, how the last task has ended, and where it has
    /// printed what.
    GivenUp {
        pieces: usize,
        ending: Ending,
        logs: PathBuf,
    },
    /// A path that cannot stand in a script.
    Path {
        path: PathBuf,
    },
    Store(StoreError),
}

impl ClusterError {
    /// A way out, as a sentence to a person at the command line.
    pub fn help(&self) -> String {
        match self {
            ClusterError::NotHere { .. } => {
                "run this where Slurm's commands are, or leave out `--executor slurm`".into()
            }
            ClusterError::Refused { program, .. } if *program != "sbatch" => {
                format!("see that `{program}` answers on this machine, or leave out `--executor slurm`")
            }
            ClusterError::Refused { .. } => {
                "give what your cluster asks for with `--sbatch`, such as `--sbatch=--account=NAME`; then `--resume`"
                    .into()
            }
            ClusterError::NoPartition { .. } => {
                "name a partition with `--partition`, or make the points smaller: `trackbed plan` says what one takes"
                    .into()
            }
            ClusterError::GivenUp { logs, .. } => {
                format!("read the last lines of the files in `{}`, then go on with `--resume`", logs.display())
            }
            ClusterError::Path { .. } => {
                "give a directory whose path has no end of a line and no quotation mark".into()
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
            ClusterError::Path { path } => write!(out, "`{}` cannot stand in a script", path.display()),
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
