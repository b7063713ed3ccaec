//! Work that several processes do in one directory, on one machine or on several machines with a shared disk. One
//! process holds the directory; the others add pieces to its work. A piece has the same bytes from every process.
//!
//! There are two locks. The claim of a piece means that a process is computing it. The gate is a shared lock for
//! processes that add a piece, and an exclusive lock for the process that starts or ends the work, so that no piece is
//! added after the end. On a disk without locks a piece may be computed twice.

use super::lock::Lock;
use super::seal::Seal;
use super::unfinished::Unfinished;
use super::{StoreError, write_atomically};
use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

/// The right to compute a piece, until it is dropped or its process ends.
#[derive(Debug)]
pub struct Claim {
    _lock: Lock,
}

impl Unfinished {
    /// Claims a piece; `None` if another process is computing it.
    pub fn claim(&self, key: &str) -> Result<Option<Claim>, StoreError> {
        self.piece(key)?; // refuses a key that is not a valid name
        let folder = self.layout.claims();
        fs::create_dir_all(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
        Ok(Lock::claim(&folder.join(key))?.map(|lock| Claim { _lock: lock }))
    }

    /// Adds a piece to the work. Returns `false`, and stores nothing, if the work has ended meanwhile or if the
    /// directory has other work.
    pub fn add(&self, key: &str, bytes: &[u8]) -> Result<bool, StoreError> {
        let _gate = Lock::share(&self.layout.gate())?;
        let path = self.piece(key)?;
        match Unfinished::work_in(&self.layout) {
            Ok(work) if work == self.work => {}
            Ok(_) | Err(StoreError::Damaged { .. }) => return Ok(false),
            Err(error) => return Err(error),
        }
        let folder = self.layout.pieces();
        fs::create_dir_all(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
        write_atomically(&path, &Seal { kind: "piece", key: &self.piece_key(key) }.close(bytes))?;
        Ok(true)
    }

    /// Keys of all stored pieces.
    pub fn keys(&self) -> Result<BTreeSet<String>, StoreError> {
        let folder = self.layout.pieces();
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(BTreeSet::new()),
            Err(cause) => return Err(StoreError::io(&folder, "read", cause)),
        };
        let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
        Ok(names.filter(|name| !name.starts_with('.') && !name.ends_with(".part")).collect())
    }

    /// The folder for the output of processes on other machines; removed with the work.
    pub fn logs(&self) -> Result<PathBuf, StoreError> {
        let folder = self.layout.logs();
        fs::create_dir_all(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
        Ok(folder)
    }
}

#[cfg(test)]
mod tests {
    use crate::store::{Directory, Mode, Unfinished, Work};
    use std::path::Path;

    fn study() -> Work {
        Work { name: "study `a`".into(), scene_sha256: "abc".into() }
    }

    fn begun(path: &Path) -> Directory {
        let directory = Directory::open(path, study(), Mode::New).unwrap();
        directory.keep("task-0", b"what to do").unwrap();
        directory
    }

    #[test]
    fn pieces_of_others_are_those_of_the_work() {
        let folder = tempfile::tempdir().unwrap();
        let directory = begun(folder.path());
        let worker = Unfinished::open(folder.path()).unwrap().unwrap();
        assert!(worker.add("point", b"42").unwrap());
        assert_eq!(directory.kept("point").unwrap().unwrap(), b"42");
        assert_eq!(worker.keys().unwrap().into_iter().collect::<Vec<_>>(), ["point", "task-0"]);
        assert!(worker.add("../point", b"42").is_err() && worker.claim("a/b").is_err());
    }

    #[test]
    fn a_piece_is_claimed_once_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let _directory = begun(folder.path());
        let [one, other] = [(); 2].map(|()| Unfinished::open(folder.path()).unwrap().unwrap());
        let claim = one.claim("point").unwrap();
        assert!(claim.is_some() && other.claim("point").unwrap().is_none() && other.claim("second").unwrap().is_some());
        drop(claim);
        assert!(other.claim("point").unwrap().is_some());
    }

    #[test]
    fn a_piece_that_comes_late_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let mut directory = begun(folder.path());
        let worker = Unfinished::open(folder.path()).unwrap().unwrap();
        directory.stage("answer", b"42").unwrap();
        directory.commit().unwrap();
        assert!(!worker.add("point", b"42").unwrap());
        assert!(Unfinished::open(folder.path()).unwrap().is_none(), "the directory is as it was");
        let other = Work { scene_sha256: "abd".into(), ..study() };
        let directory = Directory::open(folder.path(), other, Mode::Force).unwrap();
        directory.keep("task-0", b"what to do").unwrap();
        assert!(!worker.add("point", b"42").unwrap(), "the work is of another scene now");
    }
}
