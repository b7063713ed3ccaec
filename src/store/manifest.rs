//! `manifest.json`: the work of a directory of results, and each file with its hash.

use super::seal::version;
use super::{StoreError, Work, sha256};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// The files of finished work. Equal work gives equal manifests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Number of the format of this file.
    format: u32,
    /// The version of the program that made the results.
    pub version: String,
    pub work: Work,
    /// The files, sorted by name.
    pub files: Vec<FileRecord>,
    /// SHA-256 of all fields above.
    sha256: String,
}

/// A file of a directory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileRecord {
    /// The path below the directory, with `/` between folders.
    pub name: String,
    /// SHA-256 of its content; `None` for a file that differs between equal runs, such as timings.
    pub sha256: Option<String>,
}

const FORMAT: u32 = 1;

impl Manifest {
    /// The manifest of results; `made_by` is the version of the program that made them, by default this version.
    pub(super) fn new(made_by: Option<&str>, work: Work, mut files: Vec<FileRecord>) -> Manifest {
        let version = made_by.unwrap_or(version()).to_owned();
        files.sort_by(|a, b| a.name.cmp(&b.name));
        let mut manifest = Manifest { format: FORMAT, version, work, files, sha256: String::new() };
        manifest.sha256 = manifest.own_hash();
        manifest
    }

    /// The record of a file; `None` if the file is not in the manifest.
    pub fn file(&self, name: &str) -> Option<&FileRecord> {
        self.files.iter().find(|file| file.name == name)
    }

    /// Hash of everything except the hash itself.
    fn own_hash(&self) -> String {
        let bare = Manifest { sha256: String::new(), ..self.clone() };
        sha256(&serde_json::to_vec(&bare).unwrap_or_default()) // texts and numbers can always be written
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(self).unwrap_or_default(); // as above
        bytes.push(b'\n');
        bytes
    }

    /// The manifest in a file; `None` if the file does not exist.
    pub(super) fn read(path: &Path) -> Result<Option<Manifest>, StoreError> {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(StoreError::io(path, "read", cause)),
        };
        let manifest: Manifest = serde_json::from_slice(&bytes).map_err(|cause| StoreError::damaged(path, cause))?;
        if manifest.sha256 != manifest.own_hash() {
            return Err(StoreError::damaged(path, "the file is damaged: its checksum does not match its content"));
        }
        if manifest.format != FORMAT {
            let (expected, found) = (FORMAT.to_string(), manifest.format.to_string());
            return Err(StoreError::OtherVersion { path: path.to_owned(), expected, found });
        }
        if let Some(file) = manifest.files.iter().find(|file| !is_inside(&file.name)) {
            return Err(StoreError::damaged(
                path,
                format!("the manifest names `{}`, which is not in the directory", file.name),
            ));
        }
        Ok(Some(manifest))
    }
}

/// Whether a name is inside the directory and not a file of the store itself.
pub(super) fn is_inside(name: &str) -> bool {
    let plain = |part: &str| !part.is_empty() && !part.starts_with('.') && !part.contains(['\\', ':']);
    name.split('/').all(plain) && name != "manifest.json"
}

impl FileRecord {
    /// Checks that `bytes` are the content of the file; `path` is for the error.
    pub(super) fn verify(&self, path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
        match &self.sha256 {
            Some(hash) if *hash != sha256(bytes) => {
                Err(StoreError::damaged(path, "the file is damaged: its content does not match the manifest"))
            }
            _ => Ok(()),
        }
    }
}
