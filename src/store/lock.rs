//! Locks between processes, and between threads too: the system takes them back when a process dies.
//!
//! A lock file stays when its lock is given back: who removed it could remove the one that somebody else has just taken. On a file
//! system that knows no locks, work goes on without.

use super::StoreError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

/// A lock that is held until it is dropped.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
}

impl Lock {
    /// The lock in a file, at once. Fails with [`StoreError::Busy`] of `directory` where somebody else has it.
    pub fn take(path: &Path, directory: &Path) -> Result<Lock, StoreError> {
        let file = open(path).map_err(|cause| StoreError::io(path, "open", cause))?;
        match file.try_lock() {
            Ok(()) => Ok(Lock { _file: file }),
            Err(TryLockError::WouldBlock) => Err(StoreError::Busy { path: directory.to_owned() }),
            Err(TryLockError::Error(cause)) if cause.kind() == ErrorKind::Unsupported => Ok(Lock { _file: file }),
            Err(TryLockError::Error(cause)) => Err(StoreError::io(path, "lock", cause)),
        }
    }

    /// The lock in a file, at once; `None` where somebody else has it.
    pub fn claim(path: &Path) -> Result<Option<Lock>, StoreError> {
        match Lock::take(path, path) {
            Err(StoreError::Busy { .. }) => Ok(None),
            other => other.map(Some),
        }
    }

    /// A lock in a file that any number may hold together, when nobody has it alone.
    pub fn share(path: &Path) -> Result<Lock, StoreError> {
        let file = open(path).map_err(|cause| StoreError::io(path, "open", cause))?;
        match file.lock_shared() {
            Err(cause) if cause.kind() != ErrorKind::Unsupported => Err(StoreError::io(path, "lock", cause)),
            _ => Ok(Lock { _file: file }),
        }
    }

    /// The lock in a file, when everybody before has given it back.
    pub fn wait(path: &Path) -> Result<Lock, StoreError> {
        let file = open(path).map_err(|cause| StoreError::io(path, "open", cause))?;
        match file.lock() {
            Err(cause) if cause.kind() != ErrorKind::Unsupported => Err(StoreError::io(path, "lock", cause)),
            _ => Ok(Lock { _file: file }),
        }
    }
}

fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().create(true).truncate(false).write(true).open(path)
}
