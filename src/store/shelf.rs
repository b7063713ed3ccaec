//! A folder of values that can be computed again; each value is a sealed file, found by its key.

use super::lock::Lock;
use super::seal::Seal;
use super::unfinished::read;
use super::{StoreError, write_atomically};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Values of one kind in a folder, which is created with the first value.
#[derive(Debug, Clone)]
pub struct Shelf {
    folder: PathBuf,
    kind: &'static str,
}

impl Shelf {
    /// The values of a kind (one word) in a folder.
    pub fn new(folder: impl Into<PathBuf>, kind: &'static str) -> Shelf {
        Shelf { folder: folder.into(), kind }
    }

    /// The folder of the values.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The value of a key; `None` if there is no value of this version. Fails if it is damaged.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>, StoreError> {
        let path = self.path(key);
        let Some(bytes) = read(&path)? else { return Ok(None) };
        match self.seal(key).open_json(&path, &bytes) {
            Err(StoreError::OtherVersion { .. }) => Ok(None),
            other => other.map(Some),
        }
    }

    /// Stores a value atomically.
    pub fn put<T: Serialize + DeserializeOwned>(&self, key: &str, value: &T) -> Result<(), StoreError> {
        self.make()?;
        let path = self.path(key);
        write_atomically(&path, &self.seal(key).close_json(&path, value)?)
    }

    /// Removes all values except the newest and the value of `key`, independent of its age.
    pub(super) fn keep_newest(&self, count: usize, key: &str) -> Result<(), StoreError> {
        let io = |cause| StoreError::io(&self.folder, "read", cause);
        let mut found: Vec<(SystemTime, PathBuf)> = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(io)? {
            let path = entry.map_err(io)?.path();
            if path.extension().is_some_and(|kind| kind == self.kind) && path != self.path(key) {
                found.push((fs::metadata(&path).and_then(|data| data.modified()).map_err(io)?, path));
            }
        }
        found.sort();
        let old = found.len().saturating_sub(count - 1);
        found[..old]
            .iter()
            .try_for_each(|(_, path)| fs::remove_file(path).map_err(|cause| StoreError::io(path, "remove", cause)))
    }

    /// The file of a key.
    pub(super) fn path(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.{}", self.kind))
    }

    /// Waits until no other thread or process has the lock of a key.
    pub(super) fn lock(&self, key: &str) -> Result<Lock, StoreError> {
        self.make()?;
        Lock::wait(&self.folder.join(format!("{key}.lock")))
    }

    fn make(&self) -> Result<(), StoreError> {
        fs::create_dir_all(&self.folder).map_err(|cause| StoreError::io(&self.folder, "create", cause))
    }

    fn seal<'a>(&self, key: &'a str) -> Seal<'a> {
        Seal { kind: self.kind, key }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::sha256;

    /// Changes of a file, and whether each is reported as damage: a value of another version is not damage.
    fn changed(whole: &[u8]) -> Vec<(&'static str, Vec<u8>, bool)> {
        let text = String::from_utf8(whole.to_vec()).unwrap();
        let (_, sealed) = text.split_once('\n').unwrap();
        let older = sealed.replacen(env!("CARGO_PKG_VERSION"), "0.0.9", 1);
        let mut flipped = whole.to_vec();
        flipped[whole.len() / 2] ^= 1;
        vec![
            ("a bit is flipped", flipped, true),
            ("its end is missing", whole[..whole.len() / 2].to_vec(), true),
            ("it is empty", Vec::new(), true),
            ("it is of a later format", text.replacen("trackbed 1 ", "trackbed 2 ", 1).into_bytes(), true),
            (
                "it is of an older version",
                format!("trackbed 1 {}\n{older}", sha256(older.as_bytes())).into_bytes(),
                false,
            ),
        ]
    }

    #[test]
    fn what_cannot_be_read_is_never_taken_for_a_value() {
        let folder = tempfile::tempdir().unwrap();
        let shelf = Shelf::new(folder.path(), "bed");
        shelf.put("a", &[0.1, 0.2, 0.3]).unwrap();
        let whole = fs::read(shelf.path("a")).unwrap();
        for (how, bytes, is_damage) in changed(&whole) {
            fs::write(shelf.path("a"), bytes).unwrap();
            let found = shelf.get::<[f64; 3]>("a");
            assert_eq!(found.is_err(), is_damage, "{how}: {found:?}");
            assert!(found.map_or_else(|error| error.to_string().contains("a.bed"), |value| value.is_none()), "{how}");
            shelf.put("a", &[0.1, 0.2, 0.3]).unwrap();
            assert_eq!(shelf.get::<[f64; 3]>("a").unwrap(), Some([0.1, 0.2, 0.3]), "{how}");
        }
    }
}
