//! Errors of directories of results and of stored beds: each names the file, the fault, and a remedy.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// A failure to store or to read data.
#[derive(Debug)]
pub enum StoreError {
    /// The operating system refused.
    Io { path: PathBuf, action: &'static str, cause: io::Error },
    /// The file exists but has not the content that was written.
    Damaged { path: PathBuf, cause: String },
    /// The data cannot be written in the format of the file.
    Unwritable { path: PathBuf, cause: String },
    /// A file of another scene; both scenes as SHA-256.
    OtherScene { path: PathBuf, expected: String, found: String },
    /// A file of another version of the program.
    OtherVersion { path: PathBuf, expected: String, found: String },
    /// A directory of other work than requested, such as a study.
    OtherWork { path: PathBuf, expected: String, found: String },
    /// Another process is working in the directory.
    Busy { path: PathBuf },
    /// The directory holds the results of finished work.
    Finished { path: PathBuf, work: String },
    /// The directory holds interrupted work.
    Unfinished { path: PathBuf, work: String },
    /// The directory holds neither finished results nor work in progress.
    Empty { path: PathBuf },
    /// The directory holds files that are not in a manifest: the first by name, and their number.
    Foreign { path: PathBuf, first: String, count: usize },
}

impl StoreError {
    pub(crate) fn io(path: &Path, action: &'static str, cause: io::Error) -> Self {
        StoreError::Io { path: path.to_owned(), action, cause }
    }

    pub(crate) fn damaged(path: &Path, cause: impl fmt::Display) -> Self {
        StoreError::Damaged { path: path.to_owned(), cause: one_line(&cause.to_string()) }
    }

    pub(crate) fn unwritable(path: &Path, cause: impl fmt::Display) -> Self {
        StoreError::Unwritable { path: path.to_owned(), cause: one_line(&cause.to_string()) }
    }

    /// Whether the file belongs to another scene, to other work, or to another version of the program.
    pub fn is_of_another(&self) -> bool {
        matches!(self, StoreError::OtherScene { .. } | StoreError::OtherVersion { .. } | StoreError::OtherWork { .. })
    }

    /// Help for the user at the command line.
    pub fn help(&self) -> &'static str {
        match self {
            StoreError::Io { .. } | StoreError::Unwritable { .. } => "use another directory, or make space in this one",
            StoreError::Damaged { .. } => "run again with `--force`",
            StoreError::OtherScene { .. } | StoreError::OtherVersion { .. } | StoreError::OtherWork { .. } => {
                "run without `--resume` into another `--out`, or replace the results with `--force`"
            }
            StoreError::Busy { .. } => "wait until the other process has ended, or give another `--out`",
            StoreError::Finished { .. } | StoreError::Foreign { .. } => "give another `--out`, or `--force`",
            StoreError::Empty { .. } => "give the directory that `trackbed run --out` wrote",
            StoreError::Unfinished { .. } => "continue with `--resume`, or start again with `--force`",
        }
    }
}

impl fmt::Display for StoreError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StoreError::Io { path, action, cause } => write!(out, "cannot {action} `{}`: {cause}", path.display()),
            StoreError::Damaged { path, cause } => write!(out, "cannot read `{}`: {cause}", path.display()),
            StoreError::Unwritable { path, cause } => write!(out, "cannot write `{}`: {cause}", path.display()),
            StoreError::OtherScene { path, expected, found } => {
                let (path, expected, found) = (path.display(), short(expected), short(found));
                write!(out, "`{path}` belongs to another scene: expected {expected}, found {found}")
            }
            StoreError::OtherVersion { path, expected, found } => {
                write!(out, "`{}` was written by another version: expected {expected}, found {found}", path.display())
            }
            StoreError::OtherWork { path, expected, found } => {
                write!(out, "`{}` holds a {found}, not a {expected}", path.display())
            }
            StoreError::Busy { path } => write!(out, "another process is working in `{}`", path.display()),
            StoreError::Finished { path, work } => {
                write!(out, "`{}` holds the results of a finished {work}", path.display())
            }
            StoreError::Unfinished { path, work } => write!(out, "`{}` holds an interrupted {work}", path.display()),
            StoreError::Empty { path } => {
                let path = path.display();
                write!(
                    out,
                    "`{path}` holds no results: no run is finished there, and no run has stored a checkpoint yet"
                )
            }
            StoreError::Foreign { path, first, count } => {
                let more = if *count > 1 { format!(" and {} more", count - 1) } else { String::new() };
                write!(out, "`{}` holds files that are not in a manifest of results: `{first}`{more}", path.display())
            }
        }
    }
}

impl std::error::Error for StoreError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StoreError::Io { cause, .. } => Some(cause),
            _ => None,
        }
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first digits of a hash, enough to distinguish two hashes.
fn short(hash: &str) -> String {
    hash.chars().take(12).collect()
}
