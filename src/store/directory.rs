//! A directory of results, from its opening to the commit of its files.

use super::atomic::replace;
use super::disk::{Disk, FileSystem};
use super::layout::{Layout, part};
use super::lock::Lock;
use super::manifest::{FileRecord, Manifest, is_inside};
use super::seal::Seal;
use super::unfinished::{Piece, Unfinished, WORK};
use super::{Finished, StoreError, Work, recovery, sha256};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The allowed use of a directory that has content.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The directory must be empty, except for hidden files.
    New,
    /// Continue the same work, finished or not; start it if the directory is empty.
    Resume,
    /// Discard unfinished work, and replace finished work when the new work is finished. Files that are not in the
    /// manifest stay, unless a result has the same name.
    Force,
}

/// A directory with work in progress; no other process can open it until this is dropped.
///
/// Old results stay unchanged and readable until [`Directory::commit`].
#[derive(Debug)]
pub struct Directory<D: Disk = FileSystem> {
    disk: D,
    unfinished: Unfinished,
    finished: Option<Finished>,
    /// Files of the next results, staged or taken from the last results.
    files: Vec<FileRecord>,
    /// The program version of results that are amended.
    version: Option<String>,
    _lock: Lock,
}

impl Directory {
    /// Opens a directory for some work, and creates it if it does not exist. An interrupted commit is finished first.
    ///
    /// Fails if another process works there, if `mode` does not allow its content, and in [`Mode::Resume`] if it
    /// belongs to other work or a finished file is damaged.
    pub fn open(path: &Path, work: Work, mode: Mode) -> Result<Directory, StoreError> {
        Directory::open_on(FileSystem, path, work, mode)
    }

    /// Opens finished work to add or replace files. Fails if there is no finished work, and if other work has started
    /// in the directory, because a commit would end that work.
    pub fn amend(path: &Path) -> Result<Directory, StoreError> {
        let layout = Layout { root: path.to_owned() };
        let nothing =
            || StoreError::damaged(&layout.manifest(), "there is no manifest: the directory has no finished results");
        Finished::open(path)?.ok_or_else(nothing)?; // before anything is created there
        let lock = enter(&FileSystem, &layout)?;
        recovery::recover(&FileSystem, &layout)?;
        if layout.is_unfinished() {
            return Err(unfinished(&layout)?);
        }
        let finished = Finished::read_from(path)?.ok_or_else(nothing)?;
        let Manifest { version, work, files, .. } = finished.manifest().clone();
        let (unfinished, version) = (Unfinished { layout, work }, Some(version));
        Ok(Directory { disk: FileSystem, unfinished, finished: Some(finished), files, version, _lock: lock })
    }
}

impl<D: Disk> Directory<D> {
    /// The same as [`Directory::open`], on a given disk.
    pub fn open_on(disk: D, path: &Path, work: Work, mode: Mode) -> Result<Directory<D>, StoreError> {
        let layout = Layout { root: path.to_owned() };
        if mode != Mode::Force && !layout.inner().exists() {
            refuse_foreign(&layout)?; // before anything is created there
        }
        let lock = enter(&disk, &layout)?;
        match recovery::recover(&disk, &layout) {
            Err(StoreError::Damaged { .. }) if mode == Mode::Force => recovery::abandon(&disk, &layout)?,
            other => other?,
        }
        let gate = Lock::wait(&layout.gate())?;
        let finished = match mode {
            Mode::New => refuse_any(&layout).map(|()| None)?,
            Mode::Resume => found(&layout, &work)?,
            Mode::Force => recovery::discard(&disk, &layout).map(|()| None)?,
        };
        let unfinished = Unfinished { layout, work };
        let directory = Directory { disk, unfinished, finished, files: Vec::new(), version: None, _lock: lock };
        if directory.finished.is_none() {
            let path = directory.layout().work();
            directory.replace(&path, &WORK.close_json(&path, directory.unfinished.work())?)?;
        }
        drop(gate);
        Ok(directory)
    }

    /// The directory itself.
    pub fn path(&self) -> &Path {
        self.unfinished.path()
    }

    fn layout(&self) -> &Layout {
        &self.unfinished.layout
    }

    /// The work in progress, as other processes see it.
    pub fn shared(&self) -> &Unfinished {
        &self.unfinished
    }

    /// Earlier finished results in [`Mode::Resume`]; each file has been checked.
    pub fn finished(&self) -> Option<&Finished> {
        self.finished.as_ref()
    }

    /// Replaces the checkpoint by `state` atomically, and returns its size in bytes. Fails if a number is not finite.
    pub fn write_checkpoint<T: Serialize + DeserializeOwned>(&self, state: &T) -> Result<usize, StoreError> {
        let path = self.layout().checkpoint();
        let bytes = self.unfinished.checkpoint_seal().close_json(&path, state)?;
        self.replace(&path, &bytes)?;
        Ok(bytes.len())
    }

    /// The same as [`Unfinished::read_checkpoint`].
    pub fn read_checkpoint<T: DeserializeOwned>(&self) -> Result<Option<T>, StoreError> {
        self.unfinished.read_checkpoint()
    }

    /// Stores data beside the checkpoint until the commit. The key is one word; storing the same key again replaces the
    /// data.
    ///
    /// A piece that no checkpoint refers to, after a kill in between, is replaced when it is stored again.
    pub fn keep(&self, key: &str, bytes: &[u8]) -> Result<Piece, StoreError> {
        let (folder, path) = (self.layout().pieces(), self.unfinished.piece(key)?);
        self.disk.create_folder(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
        self.replace(&path, &Seal { kind: "piece", key: &self.unfinished.piece_key(key) }.close(bytes))?;
        Ok(Piece { key: key.to_owned(), sha256: sha256(bytes) })
    }

    /// The same as [`Unfinished::kept`].
    pub fn kept(&self, key: &str) -> Result<Option<Vec<u8>>, StoreError> {
        self.unfinished.kept(key)
    }

    /// The same as [`Unfinished::read_piece`].
    pub fn read_piece(&self, piece: &Piece) -> Result<Vec<u8>, StoreError> {
        self.unfinished.read_piece(piece)
    }

    /// Writes a file of the next results, which is not visible before the commit. `/` separates folders in its name.
    pub fn stage(&mut self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        self.stage_as(FileRecord { name: name.to_owned(), sha256: Some(sha256(bytes)) }, bytes)
    }

    /// The same for a file that differs between equal runs, such as timings: the manifest has no hash of it.
    pub fn stage_changing(&mut self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        self.stage_as(FileRecord { name: name.to_owned(), sha256: None }, bytes)
    }

    /// Replaces the old results by the staged files atomically, and ends the unfinished work.
    pub fn commit(self) -> Result<Finished, StoreError> {
        let _gate = Lock::wait(&self.layout().gate())?;
        let manifest = Manifest::new(self.version.as_deref(), self.unfinished.work.clone(), self.files.clone());
        self.replace(&self.layout().intent(), &manifest.bytes())?;
        recovery::finish(&self.disk, self.layout(), &manifest)?;
        Ok(Finished::new(self.layout().root.clone(), manifest))
    }

    fn stage_as(&mut self, record: FileRecord, bytes: &[u8]) -> Result<(), StoreError> {
        let path = self.layout().staging().join(&record.name);
        if !is_inside(&record.name) {
            return Err(StoreError::unwritable(&path, "the name is not valid for a result"));
        }
        let folder = path.parent().map_or_else(|| self.layout().staging(), PathBuf::from);
        let written = self.disk.create_folder(&folder).and_then(|()| self.disk.write(&path, bytes));
        let durable = written.and_then(|()| self.disk.sync_folder(&folder));
        durable.map_err(|cause| StoreError::io(&path, "write", cause))?;
        self.files.retain(|file| file.name != record.name);
        self.files.push(record);
        Ok(())
    }

    fn replace(&self, path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
        replace(&self.disk, path, &part(path), bytes)
    }
}

/// Creates the folders of a directory and takes its lock.
pub(super) fn enter(disk: &impl Disk, layout: &Layout) -> Result<Lock, StoreError> {
    if layout.root.is_file() {
        let cause = std::io::Error::from(ErrorKind::NotADirectory);
        return Err(StoreError::io(&layout.root, "use as a directory", cause));
    }
    disk.create_folder(&layout.inner()).map_err(|cause| StoreError::io(&layout.root, "create", cause))?;
    Lock::take(&layout.lock(), &layout.root)
}

/// Finished results for work that is resumed. Unfinished work has priority, because it was started after the finished
/// work.
fn found(layout: &Layout, work: &Work) -> Result<Option<Finished>, StoreError> {
    if layout.is_unfinished() {
        return same(layout, work, &Unfinished::work_in(layout)?).map(|()| None);
    }
    let Some(finished) = Finished::read_from(&layout.root)? else {
        return refuse_foreign(layout).map(|()| None);
    };
    same(layout, work, &finished.manifest().work)?;
    finished.verify()?;
    Ok(Some(finished))
}

fn same(layout: &Layout, expected: &Work, found: &Work) -> Result<(), StoreError> {
    let path = layout.root.clone();
    if expected.name != found.name {
        let (expected, found) = (expected.name.clone(), found.name.clone());
        return Err(StoreError::OtherWork { path, expected, found });
    }
    if expected.scene_sha256 != found.scene_sha256 {
        let (expected, found) = (expected.scene_sha256.clone(), found.scene_sha256.clone());
        return Err(StoreError::OtherScene { path, expected, found });
    }
    Ok(())
}

/// Fails if the directory has any content.
fn refuse_any(layout: &Layout) -> Result<(), StoreError> {
    let path = layout.root.clone();
    if layout.is_unfinished() {
        return Err(unfinished(layout)?);
    }
    match Finished::read_from(&path)? {
        Some(finished) => Err(StoreError::Finished { path, work: finished.manifest().work.name.clone() }),
        None => refuse_foreign(layout),
    }
}

/// The error for unfinished work in the directory.
fn unfinished(layout: &Layout) -> Result<StoreError, StoreError> {
    let work = match Unfinished::work_in(layout) {
        Ok(work) => work.name,
        Err(StoreError::Io { path, action, cause }) => return Err(StoreError::Io { path, action, cause }),
        Err(_) => "work".to_owned(),
    };
    Ok(StoreError::Unfinished { path: layout.root.clone(), work })
}

/// Fails if there are files that are not in a manifest. Hidden files belong to tools and are ignored.
fn refuse_foreign(layout: &Layout) -> Result<(), StoreError> {
    let path = layout.root.clone();
    if layout.manifest().exists() || !path.is_dir() {
        return Ok(());
    }
    let entries = fs::read_dir(&path).map_err(|cause| StoreError::io(&path, "read", cause))?;
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|name| !name.starts_with('.')).collect();
    names.sort();
    match names.first() {
        Some(first) => Err(StoreError::Foreign { path, first: first.clone(), count: names.len() }),
        None => Ok(()),
    }
}
