//! The state of an unfinished run as `checkpoint.json` beside its results: sealed, and bound to its scene and to the program's
//! version, so that a resumed run either continues exactly or says why it cannot.

use super::directory::read as read_if_any;
use super::disk::{Disk, FileSystem};
use super::seal::Seal;
use super::{StoreError, write_atomically};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::Path;

const FILE: &str = "checkpoint.json";

/// Replaces the checkpoint of `directory` by `state`, atomically. `scene_sha256` names the scene that it belongs to.
pub fn write<T>(directory: &Path, scene_sha256: &str, state: &T) -> Result<(), StoreError>
where
    T: Serialize + DeserializeOwned,
{
    let path = directory.join(FILE);
    let bytes = seal(scene_sha256).close_json(&path, state)?;
    fs::create_dir_all(directory).map_err(|cause| StoreError::io(directory, "create", cause))?;
    write_atomically(&path, &bytes)
}

/// Reads the checkpoint of `directory`; `None` where there is none, an error where it is damaged or of another scene or version.
pub fn read<T: DeserializeOwned>(directory: &Path, scene_sha256: &str) -> Result<Option<T>, StoreError> {
    let path = directory.join(FILE);
    read_if_any(&path)?.map(|bytes| seal(scene_sha256).open_json(&path, &bytes)).transpose()
}

/// Removes the checkpoint of a run that has ended.
pub fn remove(directory: &Path) -> Result<(), StoreError> {
    let path = directory.join(FILE);
    FileSystem.remove_file(&path).map_err(|cause| StoreError::io(&path, "remove", cause))
}

fn seal(scene_sha256: &str) -> Seal<'_> {
    Seal { kind: "checkpoint", key: scene_sha256 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_bit_for_bit() {
        let directory = tempfile::tempdir().unwrap();
        let state = vec![0.1 + 0.2, -0.0, f64::MIN_POSITIVE / 3.0, 1e300];
        write(directory.path(), "abc", &state).unwrap();
        let back: Vec<f64> = read(directory.path(), "abc").unwrap().unwrap();
        assert!(state.iter().zip(&back).all(|(a, b)| a.to_bits() == b.to_bits()));
        remove(directory.path()).unwrap();
        assert_eq!(read::<Vec<f64>>(directory.path(), "abc").unwrap(), None);
    }

    #[test]
    fn another_scene_and_a_missing_number_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        write(directory.path(), "abc", &vec![1.0]).unwrap();
        let error = read::<Vec<f64>>(directory.path(), "abd").unwrap_err().to_string();
        assert!(error.contains("checkpoint.json` belongs to another scene: expected abd, found abc"), "{error}");
        let error = write(directory.path(), "abc", &vec![f64::NAN]).unwrap_err().to_string();
        assert!(error.contains("not finite"), "{error}");
        assert_eq!(read::<Vec<f64>>(directory.path(), "abc").unwrap(), Some(vec![1.0]), "the old one stays");
    }
}
