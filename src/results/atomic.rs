//! Writes a file so that a reader, or a power cut, finds the old content or the new one and never a half.

use super::ResultsError;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Replaces `path` by `bytes`: a temporary name in the same directory, synced, then renamed.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), ResultsError> {
    let temporary = temporary_name(path);
    let written = File::create(&temporary).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()
    });
    let result = written.and_then(|()| fs::rename(&temporary, path));
    if let Err(cause) = result {
        let _ = fs::remove_file(&temporary); // the first failure is the one to report
        return Err(ResultsError::io(path, "write", cause));
    }
    sync_directory(path);
    Ok(())
}

fn temporary_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

/// Makes the new name itself durable. Not every file system can, and the content is safe without it.
fn sync_directory(path: &Path) {
    if let Some(Ok(directory)) = path.parent().map(File::open) {
        let _ = directory.sync_all();
    }
}
