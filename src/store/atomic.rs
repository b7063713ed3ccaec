//! Writes a file so that a reader, or a restart after a power cut, finds either the old or the new content, never a
//! part.

use super::StoreError;
use super::disk::{Disk, FileSystem};
use std::path::{Path, PathBuf};

/// Replaces the content of `path` by `bytes`: writes a temporary file in the same directory, syncs it, then renames it.
/// Fails if the operating system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    remove_left_over(path);
    let temporary = temporary_name(path);
    replace(&FileSystem, path, &temporary, bytes).inspect_err(|_| {
        let _ = FileSystem.remove_file(&temporary); // the first failure is the one to report
    })
}

/// Replaces the content of an existing file, or of the target of a link, and keeps its permissions. Fails if the
/// operating system refuses.
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

/// Replaces `path` on a disk through a temporary file beside it.
pub(super) fn replace(disk: &impl Disk, path: &Path, temporary: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let written = disk.write(temporary, bytes).and_then(|()| disk.rename(temporary, path));
    let synced = written.and_then(|()| path.parent().map_or(Ok(()), |folder| disk.sync_folder(folder)));
    synced.map_err(|cause| StoreError::io(path, "write", cause))
}

/// Removes temporary files of killed processes. A file younger than an hour may belong to a running process and stays.
fn remove_left_over(path: &Path) {
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let first = format!(".{}.", name.to_string_lossy());
    for entry in folder.read_dir().into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_part = name.to_string_lossy().strip_prefix(&first).is_some_and(|rest| {
            rest.strip_suffix(".part").is_some_and(|process| process.bytes().all(|letter| letter.is_ascii_digit()))
        });
        let age = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if is_part && age().is_some_and(|age| age > LEFT_OVER) {
            let _ = FileSystem.remove_file(&entry.path()); // it may be gone by now
        }
    }
}

/// Age after which a temporary file belongs to a killed process.
const LEFT_OVER: std::time::Duration = std::time::Duration::from_secs(3600);

/// A name that no other process uses.
fn temporary_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
    use std::time::SystemTime;

    #[test]
    fn what_a_killed_process_left_goes_with_the_next_attempt() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.svg");
        let old = folder.path().join(".scene.svg.4711.part");
        let young = folder.path().join(".scene.svg.4712.part");
        let other = folder.path().join(".scene.svg.mine.part");
        for file in [&old, &young, &other] {
            File::create(file).unwrap();
        }
        let hours_ago = SystemTime::now() - 2 * LEFT_OVER;
        for file in [&old, &other] {
            File::options().write(true).open(file).unwrap().set_modified(hours_ago).unwrap();
        }
        write_atomically(&path, b"whole").unwrap();
        assert_eq!((old.exists(), young.exists(), other.exists()), (false, true, true));
        assert_eq!(std::fs::read(&path).unwrap(), b"whole");
    }
}
