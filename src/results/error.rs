//! What can go wrong between a run and its files, each said in one line that names the file.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// A failure to write or read a run's directory.
#[derive(Debug)]
pub enum ResultsError {
    /// The operating system refused.
    Io { path: PathBuf, action: &'static str, cause: io::Error },
    /// The file is there but does not say what it should.
    Malformed { path: PathBuf, cause: String },
    /// A number that is no number was about to be written; `row` counts from 1.
    NotFinite { table: String, column: String, row: usize },
    /// The data cannot be put into the file's format.
    Unwritable { path: PathBuf, cause: String },
    /// A checkpoint of another scene; both as SHA-256.
    OtherScene { path: PathBuf, expected: String, found: String },
    /// A checkpoint of another version of the program.
    OtherVersion { path: PathBuf, expected: String, found: String },
}

impl ResultsError {
    pub(super) fn io(path: &Path, action: &'static str, cause: io::Error) -> Self {
        ResultsError::Io { path: path.to_owned(), action, cause }
    }

    pub(super) fn malformed(path: &Path, cause: impl fmt::Display) -> Self {
        ResultsError::Malformed { path: path.to_owned(), cause: one_line(&cause.to_string()) }
    }

    pub(super) fn unwritable(path: &Path, cause: impl fmt::Display) -> Self {
        ResultsError::Unwritable { path: path.to_owned(), cause: one_line(&cause.to_string()) }
    }
}

impl fmt::Display for ResultsError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ResultsError::Io { path, action, cause } => write!(out, "cannot {action} `{}`: {cause}", path.display()),
            ResultsError::Malformed { path, cause } => write!(out, "cannot read `{}`: {cause}", path.display()),
            ResultsError::NotFinite { table, column, row } => {
                write!(out, "refused to write `{table}`: column `{column}` of row {row} is not a finite number")
            }
            ResultsError::Unwritable { path, cause } => write!(out, "cannot write `{}`: {cause}", path.display()),
            ResultsError::OtherScene { path, expected, found } => write!(
                out,
                "`{}` belongs to another scene: expected {}, found {}",
                path.display(),
                short(expected),
                short(found)
            ),
            ResultsError::OtherVersion { path, expected, found } => {
                write!(out, "`{}` was written by another version: expected {expected}, found {found}", path.display())
            }
        }
    }
}

impl std::error::Error for ResultsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ResultsError::Io { cause, .. } => Some(cause),
            _ => None,
        }
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first digits of a hash, enough to tell two apart.
fn short(hash: &str) -> String {
    hash.chars().take(12).collect()
}
