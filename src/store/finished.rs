//! Finished results; each file is checked against the manifest.

use super::directory::enter;
use super::layout::Layout;
use super::manifest::Manifest;
use super::{FileSystem, StoreError, recovery};
use std::fs;
use std::path::{Path, PathBuf};

/// The results of a directory.
#[derive(Debug, Clone)]
pub struct Finished {
    root: PathBuf,
    manifest: Manifest,
}

impl Finished {
    /// The results of a directory; `None` if there are no finished results. An interrupted commit is finished first.
    /// Fails if another process is finishing this commit, or if the manifest is damaged.
    pub fn open(path: &Path) -> Result<Option<Finished>, StoreError> {
        let layout = Layout { root: path.to_owned() };
        if layout.intent().exists() {
            let _lock = enter(&FileSystem, &layout)?;
            recovery::recover(&FileSystem, &layout)?;
        }
        Finished::read_from(path)
    }

    pub(super) fn new(root: PathBuf, manifest: Manifest) -> Finished {
        Finished { root, manifest }
    }

    /// The same for a directory without an interrupted commit.
    pub(super) fn read_from(path: &Path) -> Result<Option<Finished>, StoreError> {
        let manifest = Manifest::read(&Layout { root: path.to_owned() }.manifest())?;
        Ok(manifest.map(|manifest| Finished::new(path.to_owned(), manifest)))
    }

    /// The manifest of the files.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The content of a file; `None` if it is not in the manifest. Fails if it is missing or damaged.
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let Some(record) = self.manifest.file(name) else { return Ok(None) };
        let path = self.root.join(name);
        let bytes = fs::read(&path).map_err(|cause| StoreError::io(&path, "read", cause))?;
        record.verify(&path, &bytes)?;
        Ok(Some(bytes))
    }

    /// Fails with the first file that is missing or damaged.
    pub fn verify(&self) -> Result<(), StoreError> {
        self.manifest.files.iter().try_for_each(|file| self.read(&file.name).map(drop))
    }
}
