//! Errors in writing and reading the files of a run; each message is one line with the name of the file.

use crate::store::StoreError;
use std::fmt;
use std::io;
use std::path::Path;

/// A failure to write or read a run's directory.
#[derive(Debug)]
pub enum ResultsError {
    /// A file cannot be written or read.
    Store(StoreError),
    /// The program was about to write a number that is not finite; `row` counts from 1.
    NotFinite { table: String, column: String, row: usize },
}

impl ResultsError {
    pub(super) fn io(path: &Path, action: &'static str, cause: io::Error) -> Self {
        StoreError::io(path, action, cause).into()
    }

    pub(super) fn malformed(path: &Path, cause: impl fmt::Display) -> Self {
        StoreError::damaged(path, cause).into()
    }

    /// A number that must not be in a file.
    pub(super) fn not_finite(table: &str, column: &str, row: usize) -> Self {
        ResultsError::NotFinite { table: table.to_owned(), column: column.to_owned(), row }
    }

    /// The same in a file that was read.
    pub(super) fn read_not_finite(path: &Path, column: &str, row: usize) -> Self {
        ResultsError::malformed(path, format!("column `{column}` of row {row} is not a finite number"))
    }

    pub(crate) fn unwritable(path: &Path, cause: impl fmt::Display) -> Self {
        StoreError::unwritable(path, cause).into()
    }
}

/// Refuses a number that is not finite; `row` counts from 1.
pub(super) fn check_finite(table: &str, column: &str, row: usize, value: f64) -> Result<(), ResultsError> {
    if value.is_finite() { Ok(()) } else { Err(ResultsError::not_finite(table, column, row)) }
}

impl From<StoreError> for ResultsError {
    fn from(error: StoreError) -> Self {
        ResultsError::Store(error)
    }
}

impl fmt::Display for ResultsError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ResultsError::Store(error) => error.fmt(out),
            ResultsError::NotFinite { table, column, row } => {
                write!(out, "refused to write `{table}`: column `{column}` of row {row} is not a finite number")
            }
        }
    }
}

impl std::error::Error for ResultsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ResultsError::Store(error) => Some(error),
            ResultsError::NotFinite { .. } => None,
        }
    }
}
