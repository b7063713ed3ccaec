//! Files of a scene: open texts have priority over files on the disk, and syntax trees are kept between two edits.

use super::positions::Lines;
use crate::check::{DataError, Folder, Modules, Parsed};
use crate::diag::{FileId, Sources};
use lsp_types::{Location, Url};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Texts that are open, by their path.
pub type OpenTexts = Arc<BTreeMap<PathBuf, Arc<str>>>;

/// Syntax trees of texts that seldom change: the standard library, defaults and modules.
#[derive(Default)]
pub struct Trees {
    known: Mutex<HashMap<(FileId, String), Parsed>>,
}

/// Largest number of stored trees, more than a scene has.
const MOST_TREES: usize = 400;

impl Trees {
    fn parsed(&self, file: FileId, text: &str) -> Parsed {
        // the main file changes with every edit
        if file == FileId(0) {
            return Parsed::new(file, text);
        }
        let key = (file, text.to_owned());
        // a panic elsewhere leaves the map valid: only finished trees are put into it
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.len() >= MOST_TREES && !known.contains_key(&key) {
            known.clear();
        }
        known.entry(key).or_insert_with(|| Parsed::new(file, text)).clone()
    }
}

/// The modules and data files beside a file.
pub struct Beside {
    /// `None` for a text without a file.
    pub folder: Option<PathBuf>,
    pub open: OpenTexts,
    pub trees: Arc<Trees>,
}

impl Modules for Beside {
    fn read(&self, relative: &Path) -> Option<Vec<u8>> {
        self.data(relative).ok()
    }

    fn data(&self, relative: &Path) -> Result<Vec<u8>, DataError> {
        let Some(folder) = &self.folder else { return Err(DataError::Missing) };
        match self.open.get(&folder.join(relative)) {
            Some(text) => Ok(text.as_bytes().to_vec()),
            None => Folder(folder.clone()).data(relative),
        }
    }

    fn parsed(&self, file: FileId, text: &str) -> Parsed {
        self.trees.parsed(file, text)
    }
}

/// Addresses of the sources of a scene.
#[derive(Debug, Clone)]
pub struct Places {
    pub main: Url,
    /// The folder of the main file.
    pub folder: Option<PathBuf>,
    /// The folder in which the standard library is written as files.
    pub library: PathBuf,
}

impl Places {
    /// The address of a source; `None` if it is not a file, such as a default.
    pub fn address(&self, sources: &Sources, file: FileId) -> Option<Url> {
        let source = sources.get(file);
        if file == FileId(0) {
            return Some(self.main.clone());
        }
        let folder = if source.library { &self.library } else { self.folder.as_ref()? };
        let is_file = source.name.contains('.');
        Url::from_file_path(folder.join(&source.name)).ok().filter(|_| is_file)
    }

    /// The address of a part of a source.
    pub fn location(&self, sources: &Sources, file: FileId, start: usize, end: usize) -> Option<Location> {
        let text = &sources.get(file).text;
        let range = Lines::new(text).range(text, start, end);
        Some(Location::new(self.address(sources, file)?, range))
    }
}
