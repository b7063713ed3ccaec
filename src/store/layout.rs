//! Layout of a directory of results.
//!
//! ```text
//! manifest.json          the work of the directory, and its files
//! summary.json ...       the files of the manifest
//! so_far.html            the page of unfinished work; removed with the unfinished work
//! .trackbed/lock         held while a process works here
//! .trackbed/work         the name and scene of the unfinished work
//! .trackbed/checkpoint   the state from which the work continues
//! .trackbed/pieces/      finished pieces of data, by key
//! .trackbed/claims/      locks of pieces that are being computed, by the same keys
//! .trackbed/gate         shared lock for processes that add pieces, exclusive lock for the end of the work
//! .trackbed/logs/        output of processes on other machines
//! .trackbed/parts/       directories of parts of the work; each is like this one, with work of its own
//! .trackbed/staging/     files of the next results
//! .trackbed/intent.json  the manifest of staged files that are being moved to their places
//! ```

use std::path::{Path, PathBuf};

/// The paths in a directory of results.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub root: PathBuf,
}

impl Layout {
    pub fn manifest(&self) -> PathBuf {
        self.root.join("manifest.json")
    }

    pub fn so_far(&self) -> PathBuf {
        self.root.join("so_far.html")
    }

    /// The folder of everything that is not a result.
    pub fn inner(&self) -> PathBuf {
        self.root.join(".trackbed")
    }

    pub fn lock(&self) -> PathBuf {
        self.inner().join("lock")
    }

    pub fn work(&self) -> PathBuf {
        self.inner().join("work")
    }

    pub fn checkpoint(&self) -> PathBuf {
        self.inner().join("checkpoint")
    }

    pub fn pieces(&self) -> PathBuf {
        self.inner().join("pieces")
    }

    pub fn claims(&self) -> PathBuf {
        self.inner().join("claims")
    }

    pub fn gate(&self) -> PathBuf {
        self.inner().join("gate")
    }

    pub fn logs(&self) -> PathBuf {
        self.inner().join("logs")
    }

    pub fn parts(&self) -> PathBuf {
        self.inner().join("parts")
    }

    pub fn staging(&self) -> PathBuf {
        self.inner().join("staging")
    }

    pub fn intent(&self) -> PathBuf {
        self.inner().join("intent.json")
    }

    /// Whether there is unfinished work.
    pub fn is_unfinished(&self) -> bool {
        let holds_any = |folder: &Path| folder.read_dir().is_ok_and(|mut entries| entries.next().is_some());
        self.checkpoint().exists() || holds_any(&self.pieces())
    }
}

/// The temporary name of a file while it is written; only the holder of the lock writes there.
pub(super) fn part(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}
