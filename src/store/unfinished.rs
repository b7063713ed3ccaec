//! Work that is under way in a directory: what its holder keeps there, and what others read of it meanwhile.

use super::layout::Layout;
use super::manifest::is_inside;
use super::seal::Seal;
use super::{StoreError, Work, sha256, write_atomically};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Seal of the file that says whose work is under way; it is this very file that names the scene.
pub(super) const WORK: Seal<'_> = Seal { kind: "work", key: "" };

/// Data that has been kept beside a checkpoint. A checkpoint that holds this names exactly the bytes that were kept.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Piece {
    pub key: String,
    pub sha256: String,
}

/// Work under way. It may be read while it goes on, without its lock: every file of it is replaced at once.
#[derive(Debug, Clone)]
pub struct Unfinished {
    pub(super) layout: Layout,
    pub(super) work: Work,
}

impl Unfinished {
    /// The work under way in a directory; `None` where none has kept anything.
    pub fn open(path: &Path) -> Result<Option<Unfinished>, StoreError> {
        let layout = Layout { root: path.to_owned() };
        if !layout.is_unfinished() {
            return Ok(None);
        }
        let work = Unfinished::work_in(&layout)?;
        Ok(Some(Unfinished { layout, work }))
    }

    /// Whose work is under way.
    pub(super) fn work_in(layout: &Layout) -> Result<Work, StoreError> {
        let path = layout.work();
        let sealed = read(&path)?.ok_or_else(|| StoreError::damaged(&path, "it is gone"))?;
        WORK.open_json(&path, &sealed)
    }

    pub fn work(&self) -> &Work {
        &self.work
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        &self.layout.root
    }

    /// The state of the last checkpoint; `None` where there is none. Fails where it is damaged, or of another scene or version.
    pub fn read_checkpoint<T: DeserializeOwned>(&self) -> Result<Option<T>, StoreError> {
        let path = self.layout.checkpoint();
        read(&path)?.map(|bytes| self.checkpoint_seal().open_json(&path, &bytes)).transpose()
    }

    /// Data that was kept under a key; `None` where there is none. Fails where it is damaged or of another version.
    pub fn kept(&self, key: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let path = self.piece(key)?;
        let Some(bytes) = read(&path)? else { return Ok(None) };
        Ok(Some(Seal { kind: "piece", key: &self.piece_key(key) }.open(&path, &bytes)?.to_vec()))
    }

    /// The very bytes of a piece that was kept. Fails where they are missing or others.
    pub fn read_piece(&self, piece: &Piece) -> Result<Vec<u8>, StoreError> {
        match self.kept(&piece.key)? {
            Some(bytes) if sha256(&bytes) == piece.sha256 => Ok(bytes),
            Some(_) => Err(StoreError::damaged(&self.piece(&piece.key)?, "it is not what the checkpoint names")),
            None => Err(StoreError::damaged(&self.piece(&piece.key)?, "it is gone, and the checkpoint names it")),
        }
    }

    /// Writes the page that shows the work so far, which goes as the work ends. Gives its place.
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
            return Err(StoreError::unwritable(&path, "it has no name of a piece"));
        }
        Ok(path)
    }
}

/// The bytes of a file; `None` where there is none.
pub(super) fn read(path: &Path) -> Result<Option<Vec<u8>>, StoreError> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(None),
        Err(cause) => Err(StoreError::io(path, "read", cause)),
    }
}
