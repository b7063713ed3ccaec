//! The state of an unfinished run as `checkpoint.json`: bound to its scene and to the program's version, so that a
//! resumed run either continues exactly or says why it cannot.

use super::{ResultsError, atomic};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

const FILE: &str = "checkpoint.json";

#[derive(Serialize, Deserialize)]
struct Checkpoint<T> {
    version: String,
    scene_sha256: String,
    state: T,
}

/// What can be said about a checkpoint without understanding its state.
#[derive(Deserialize)]
struct Label {
    version: String,
    scene_sha256: String,
}

/// Replaces the checkpoint of `directory` by `state`, atomically. `scene_sha256` names the scene that it belongs to.
pub fn write<T>(directory: &Path, scene_sha256: &str, state: &T) -> Result<(), ResultsError>
where
    T: Serialize + DeserializeOwned,
{
    let path = directory.join(FILE);
    let checkpoint = Checkpoint { version: version().to_owned(), scene_sha256: scene_sha256.to_owned(), state };
    let bytes = serde_json::to_vec(&checkpoint).map_err(|cause| ResultsError::unwritable(&path, cause))?;
    // A number that is not finite becomes null, which would only be noticed when the run is resumed.
    serde_json::from_slice::<Checkpoint<T>>(&bytes).map_err(|cause| {
        ResultsError::unwritable(&path, format!("the state would not come back: a number is not finite ({cause})"))
    })?;
    fs::create_dir_all(directory).map_err(|cause| ResultsError::io(directory, "create", cause))?;
    atomic::write(&path, &bytes)
}

/// Reads the checkpoint of `directory`; `None` where there is none, an error where it is of another scene or version.
pub fn read<T: DeserializeOwned>(directory: &Path, scene_sha256: &str) -> Result<Option<T>, ResultsError> {
    let path = directory.join(FILE);
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(cause) if cause.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(cause) => return Err(ResultsError::io(&path, "read", cause)),
    };
    let label: Label = serde_json::from_slice(&bytes).map_err(|cause| ResultsError::malformed(&path, cause))?;
    if label.version != version() {
        return Err(ResultsError::OtherVersion { path, expected: version().to_owned(), found: label.version });
    }
    if label.scene_sha256 != scene_sha256 {
        let expected = scene_sha256.to_owned();
        return Err(ResultsError::OtherScene { path, expected, found: label.scene_sha256 });
    }
    let checkpoint: Checkpoint<T> =
        serde_json::from_slice(&bytes).map_err(|cause| ResultsError::malformed(&path, cause))?;
    Ok(Some(checkpoint.state))
}

/// Removes the checkpoint of a run that has ended.
pub fn remove(directory: &Path) -> Result<(), ResultsError> {
    let path = directory.join(FILE);
    match fs::remove_file(&path) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(ResultsError::io(&path, "remove", cause)),
        _ => Ok(()),
    }
}

fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
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
