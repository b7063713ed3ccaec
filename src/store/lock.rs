//! Locks between processes and threads: the system releases them when a process dies.
//!
//! A lock file stays after its lock is released, because removing it could remove a lock that another process has just
//! taken. On a file system without locks the work continues without locks.

use super::StoreError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

/// A lock, held until this is dropped.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of a file without waiting. Fails with [`StoreError::Busy`] for `directory` if another process has
    /// it.
    pub fn take(path: &Path, directory: &Path) -> Result<Lock, StoreError> {
        let file = open(path).map_err(|cause| StoreError::io(path, "open", cause))?;
        match file.try_lock() {
            Ok(()) => Ok(Lock { _file: file }),
            Err(TryLockError::WouldBlock) => Err(StoreError::Busy { path: directory.to_owned() }),
            Err(TryLockError::Error(cause)) if cause.kind() == ErrorKind::Unsupported => Ok(Lock { _file: file }),
            Err(TryLockError::Error(cause)) => Err(StoreError::io(path, "lock", cause)),
        }
    }

    /// Takes the lock of a file without waiting; `None` if another process has it.
    pub fn claim(path: &Path) -> Result<Option<Lock>, StoreError> {
        match Lock::take(path, path) {
            Err(StoreError::Busy { .. }) => Ok(None),
            other => other.map(Some),
        }
    }

    /// Takes a shared lock of a file; waits while another process has the exclusive lock.
    pub fn share(path: &Path) -> Result<Lock, StoreError> {
        let file = open(path).map_err(|cause| StoreError::io(path, "open", cause))?;
        match file.lock_shared() {
            Err(cause) if cause.kind() != ErrorKind::Unsupported => Err(StoreError::io(path, "lock", cause)),
            _ => Ok(Lock { _file: file }),
        }
    }

    /// Takes the exclusive lock of a file; waits until all others have released it.
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
