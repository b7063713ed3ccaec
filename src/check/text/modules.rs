//! Sources of the files of a scene: a folder, memory, or a cache of parsed files.

use crate::diag::{Diagnostic, FileId};
use crate::syntax::parse;
use crate::syntax::tree::Tree;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The source in which `use site.gravel` finds `site/gravel.track`, and `file("level.csv")` its numbers.
pub trait Modules {
    /// The bytes of a file below the main file's folder; `None` if there is none.
    fn read(&self, relative: &Path) -> Option<Vec<u8>>;

    /// The same, with the reason if it is not read. `relative` has plain names only, no `..`; the implementation must
    /// refuse links that leave the folder.
    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        self.read(relative).ok_or(DataError::Missing)
    }

    /// The tree of a text, which is this file of the sources.
    fn parsed(&self, file: FileId, text: &str) -> Parsed {
        Parsed::new(file, text)
    }
}

/// A file's tree, and all mistakes of its text.
#[derive(Debug, Clone)]
pub struct Parsed {
    pub tree: Arc<Tree>,
    pub mistakes: Arc<[Diagnostic]>,
}

impl Parsed {
    /// Reads a text.
    pub fn new(file: FileId, text: &str) -> Parsed {
        let (tree, mistakes) = parse(file, text);
        Parsed { tree: Arc::new(tree), mistakes: mistakes.into() }
    }
}

/// Why a file is not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DataError {
    Missing,
    /// It does not lie below the main file's folder.
    Outside,
    /// Its size in bytes is above [`LARGEST_DATA_FILE`].
    TooLarge(u64),
    /// The message of the operating system.
    Unreadable(String),
}

/// Largest size of a file that a scene reads, bytes.
pub const LARGEST_DATA_FILE: u64 = 8 << 20;

/// Largest number of bytes read from a file on the command line: a pipe or a device may have no end.
const ENDLESS: u64 = 8 * LARGEST_DATA_FILE;

/// The bytes of a file or a pipe; fails above 64 MiB, and if the operating system refuses.
pub fn read_bounded(path: &Path) -> io::Result<Vec<u8>> {
    read_all(File::open(path)?)
}

/// All bytes of a reader; fails above 64 MiB, and where the operating system refuses.
pub fn read_all(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = reader.take(ENDLESS + 1).read_to_end(&mut bytes)? as u64;
    if read > ENDLESS {
        return Err(io::Error::other(format!("it has more than {} MiB", ENDLESS >> 20)));
    }
    Ok(bytes)
}

/// Modules in a folder.
pub struct Folder(pub PathBuf);

impl Modules for Folder {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.data(relative).ok()
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        let fail = |cause: std::io::Error| match cause.kind() {
            std::io::ErrorKind::NotFound => DataError::Missing,
            _ => DataError::Unreadable(cause.to_string()),
        };
        let folder = if self.0.as_os_str().is_empty() { Path::new(".") } else { &self.0 };
        let folder = folder.canonicalize().map_err(fail)?;
        let path = folder.join(relative).canonicalize().map_err(fail)?;
        if !path.starts_with(&folder) {
            return Err(DataError::Outside);
        }
        let about = path.metadata().map_err(fail)?;
        if !about.is_file() {
            return Err(DataError::Unreadable("it is a folder or a device".into()));
        }
        if about.len() > LARGEST_DATA_FILE {
            return Err(DataError::TooLarge(about.len()));
        }
        std::fs::read(path).map_err(fail)
    }
}

/// Modules of a scene that is compiled many times, such as the points of a study: no text is parsed twice.
pub struct Remembered<M> {
    modules: M,
    trees: Mutex<HashMap<(FileId, String), Parsed>>,
}

impl<M: Modules> Remembered<M> {
    pub fn new(modules: M) -> Self {
        Remembered { modules, trees: Mutex::default() }
    }
}

impl<M: Modules> Modules for Remembered<M> {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.modules.read(relative)
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        self.modules.data(relative)
    }

    fn parsed(&self, file: FileId, text: &str) -> Parsed {
        let key = (file, text.to_string());
        // a panic elsewhere does not damage the map, because only finished trees are put into it
        let known = self.trees.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        known.unwrap_or_else(|| {
            let parsed = Parsed::new(file, text);
            self.trees.lock().unwrap_or_else(PoisonError::into_inner).insert(key, parsed.clone());
            parsed
        })
    }
}

/// No modules except the standard library, for scenes in memory.
pub struct NoModules;

impl Modules for NoModules {
    fn read(&self, _: &Path) -> Option<Vec<u8>> {
        None
    }
}
