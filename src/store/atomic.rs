//! Writes a file so that a reader, or a power cut, finds the old content or the new one and never a half.

use super::StoreError;
use super::disk::{Disk, FileSystem};
use std::path::{Path, PathBuf};

/// Replaces `path` by `bytes`: a temporary name in the same directory, synced, then renamed. Fails where the operating system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let temporary = temporary_name(path);
    replace(&FileSystem, path, &temporary, bytes).inspect_err(|_| {
        let _ = FileSystem.remove_file(&temporary); // the first failure is the one to report
    })
}

/// Replaces the content of an existing file and keeps its permissions; of a link, that of the file it leads to. Fails where the operating
/// system refuses.
pub fn rewrite_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let failed = |cause| StoreError::io(path, "write", cause);
    let path = path.canonicalize().map_err(failed)?;
    let permissions = path.metadata().map_err(failed)?.permissions();
    let temporary = temporary_name(&path);
    let written = FileSystem.write(&temporary, bytes).and_then(|()| std::fs::set_permissions(&temporary, permissions));
    written.and_then(|()| FileSystem.rename(&temporary, &path)).map_err(|cause| {
        let _ = FileSystem.remove_file(&temporary); // the first failure is the one to report
        failed(cause)
    })
}

/// Replaces `path` on a disk, by way of a temporary file beside it.
pub(super) fn replace(disk: &impl Disk, path: &Path, temporary: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let written = disk.write(temporary, bytes).and_then(|()| disk.rename(temporary, path));
    let synced = written.and_then(|()| path.parent().map_or(Ok(()), |folder| disk.sync_folder(folder)));
    synced.map_err(|cause| StoreError::io(path, "write", cause))
}

/// A name that no other process uses.
fn temporary_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}
