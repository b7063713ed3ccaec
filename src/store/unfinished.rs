//! Work in progress in a directory: data that its holder stores there, and that other processes can read.

use super::layout::Layout;
use super::manifest::is_inside;
use super::seal::Seal;
use super::{StoreError, Work, sha256, write_atomically};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Seal of the file that names the work in progress and its scene; its key is therefore empty.
pub(super) const WORK: Seal<'_> = Seal { kind: "work", key: "" };

/// Reference to data stored beside a checkpoint; the hash identifies exactly the stored bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Piece {
    pub key: String,
    pub sha256: String,
}

/// Work in progress. It may be read without its lock while it runs, because every file is replaced atomically.
#[derive(Debug, Clone)]
pub struct Unfinished {
    pub(super) layout: Layout,
    pub(super) work: Work,
}

impl Unfinished {
    /// The work in progress in a directory; `None` if nothing is stored.
    pub fn open(path: &Path) -> Result<Option<Unfinished>, StoreError> {
        let layout = Layout { root: path.to_owned() };
        if !layout.is_unfinished() {
            return Ok(None);
        }
        let work = Unfinished::work_in(&layout)?;
        Ok(Some(Unfinished { layout, work }))
    }

    /// The name and scene of the work in progress.
    pub(super) fn work_in(layout: &Layout) -> Result<Work, StoreError> {
        let path = layout.work();
        let sealed = read(&path)?.ok_or_else(|| StoreError::damaged(&path, "the file is missing"))?;
        WORK.open_json(&path, &sealed)
    }

    pub fn work(&self) -> &Work {
        &self.work
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.layout.root
    }

    /// The directory of a part of the work that has checkpoints and results of its own. It is removed with the work.
    pub fn part(&self, name: &str) -> PathBuf {
        self.layout.parts().join(name)
    }

    /// The state of the last checkpoint; `None` if there is none. Fails if it is damaged, or if it has another scene or
    /// version.
    pub fn read_checkpoint<T: DeserializeOwned>(&self) -> Result<Option<T>, StoreError> {
        let path = self.layout.checkpoint();
        read(&path)?.map(|bytes| self.checkpoint_seal().open_json(&path, &bytes)).transpose()
    }

    /// Data stored under a key; `None` if there is none. Fails if it is damaged or has another version.
    pub fn kept(&self, key: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let path = self.piece(key)?;
        let Some(bytes) = read(&path)? else { return Ok(None) };
        Ok(Some(Seal { kind: "piece", key: &self.piece_key(key) }.open(&path, &bytes)?.to_vec()))
    }

    /// The bytes of a stored piece. Fails if they are missing or different.
    pub fn read_piece(&self, piece: &Piece) -> Result<Vec<u8>, StoreError> {
        match self.kept(&piece.key)? {
            Some(bytes) if sha256(&bytes) == piece.sha256 => Ok(bytes),
            Some(_) => Err(StoreError::damaged(&self.piece(&piece.key)?, "the file does not match the checkpoint")),
            None => {
                Err(StoreError::damaged(&self.piece(&piece.key)?, "the file is missing, but the checkpoint names it"))
            }
        }
    }

    /// Writes the page of the work so far, which is removed at the end of the work. Returns its path.
    pub fn show(&self, page: &[u8]) -> Result<PathBuf, StoreError> {
        let path = self.layout.so_far();
        write_atomically(&path, page)?;
        Ok(path)
    }

    pub(super) fn checkpoint_seal(&self) -> Seal<'_> {
        Seal { kind: "checkpoint", key: &self.work.scene_sha256 }
    }

    /// Binds a piece to its scene and to its key.
    pub(super) fn piece_key(&self, key: &str) -> String {
        format!("{} {key}", self.work.scene_sha256)
    }

    pub(super) fn piece(&self, key: &str) -> Result<PathBuf, StoreError> {
        let path = self.layout.pieces().join(key);
        if key.contains('/') || !is_inside(key) {
            return Err(StoreError::unwritable(&path, "the name is not valid for a piece"));
        }
        Ok(path)
    }
}

/// The bytes of a file; `None` if it does not exist.
pub(super) fn read(path: &Path) -> Result<Option<Vec<u8>>, StoreError> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(None),
        Err(cause) => Err(StoreError::io(path, "read", cause)),
    }
}
