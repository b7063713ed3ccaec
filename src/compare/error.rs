//! Why results cannot be compared.

use super::kind::Kind;
use crate::results::ResultsError;
use crate::store::StoreError;
use std::fmt;
use std::path::PathBuf;

/// A failure to compare, said in one line with what to do.
#[derive(Debug)]
pub enum CompareError {
    /// Fewer than two directories.
    Alone,
    /// A directory without finished results.
    Nothing {
        path: PathBuf,
    },
    /// A directory of results that are neither a run, a test nor a study.
    Other {
        path: PathBuf,
        work: String,
    },
    /// Two directories of different kinds.
    Kinds {
        first: (PathBuf, Kind),
        other: (PathBuf, Kind),
    },
    Results(ResultsError),
}

impl From<ResultsError> for CompareError {
    fn from(error: ResultsError) -> Self {
        CompareError::Results(error)
    }
}

impl From<StoreError> for CompareError {
    fn from(error: StoreError) -> Self {
        CompareError::Results(error.into())
    }
}

impl fmt::Display for CompareError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CompareError::Alone => write!(out, "a comparison needs two directories or more"),
            CompareError::Nothing { path } => write!(
                out,
                "`{0}` holds no finished results: finish its run with `--resume`, or name another directory",
                path.display()
            ),
            CompareError::Other { path, work } => {
                write!(out, "`{}` holds a {work}: only runs, tests of rigs and studies are compared", path.display())
            }
            CompareError::Kinds { first: (first, one), other: (other, another) } => write!(
                out,
                "`{}` holds {one} and `{}` {another}: name directories of one kind",
                first.display(),
                other.display()
            ),
            CompareError::Results(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for CompareError {}
