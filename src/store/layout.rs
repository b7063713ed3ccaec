//! Where things stand in a directory of results.
//!
//! ```text
//! manifest.json          what the directory is of, and its files
//! summary.json ...       those files
//! so_far.html            the page of work that is not finished; it goes with that
//! .trackbed/lock         held while somebody works here
//! .trackbed/work         whose unfinished work this is
//! .trackbed/checkpoint   the state to go on from
//! .trackbed/pieces/      data that is finished, by its key
//! .trackbed/claims/      locks of pieces that processes compute now, by the same keys
//! .trackbed/gate         held by all who add pieces, and alone by who ends the work
//! .trackbed/logs/        what processes elsewhere have printed
//! .trackbed/staging/     files of the next results
//! .trackbed/intent.json  the manifest of staged files that are on their way to their places
//! ```

use std::path::{Path, PathBuf};

/// The places of a directory.
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

    /// The folder of everything that is no result.
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

    pub fn staging(&self) -> PathBuf {
        self.inner().join("staging")
    }

    pub fn intent(&self) -> PathBuf {
        self.inner().join("intent.json")
    }

    /// Whether somebody's unfinished work is there.
    pub fn is_unfinished(&self) -> bool {
        let holds_any = |folder: &Path| folder.read_dir().is_ok_and(|mut entries| entries.next().is_some());
        self.checkpoint().exists() || holds_any(&self.pieces())
    }
}

/// A name beside a file under which it is written; only the holder of the lock writes there.
pub(super) fn part(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}
