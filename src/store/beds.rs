//! Packed beds from earlier runs, by the hash of their recipe.

use super::{Shelf, StoreError, sha256};
use crate::solvers::granular::packing::{METHOD, Packed, PackingError, Progress, Recipe, StoredBed, pack};
use crate::solvers::granular::{Answer, RestoreError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt;
use std::path::{Path, PathBuf};

/// Hash of a recipe: the same recipe gives the same bed, bit by bit, for one version of the program.
pub fn bed_hash(recipe: &Recipe) -> String {
    recipe_hash(recipe)
}

/// Hash of `what`, together with the current method of packing and reading beds.
pub fn recipe_hash(what: &impl Serialize) -> String {
    sha256(format!("{METHOD} {}", serde_json::to_string(what).unwrap_or_default()).as_bytes())
}

/// The store of beds. If several threads or processes need the same bed, one packs it and the others wait.
#[derive(Debug, Default)]
pub struct Beds {
    shelf: Option<Shelf>,
}

/// The reason why there is no bed.
#[derive(Debug, Clone, PartialEq)]
pub enum BedsError {
    Packing(PackingError),
    /// The packed bed cannot be restored from its stored form.
    Restore(RestoreError),
}

impl fmt::Display for BedsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BedsError::Packing(error) => error.fmt(f),
            BedsError::Restore(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for BedsError {}

/// A bed, and whether it was stored.
pub struct FoundBed {
    pub packed: Packed<f32>,
    /// Whether it was already stored.
    pub was_kept: bool,
    /// Damage of the stored bed, which was deleted and packed again.
    pub damage: Option<StoreError>,
    /// The reason why the new bed is not stored.
    pub loss: Option<StoreError>,
}

impl Beds {
    /// Beds in a folder, which is created if it does not exist.
    pub fn kept_in(folder: impl Into<PathBuf>) -> Beds {
        Beds { shelf: Some(Shelf::new(folder, "bed")) }
    }

    /// Beds that are not stored: each bed is packed again.
    pub fn not_kept() -> Beds {
        Beds::default()
    }

    /// The folder of the beds; `None` if beds are not stored.
    pub fn folder(&self) -> Option<&Path> {
        self.shelf.as_ref().map(Shelf::folder)
    }

    /// The bed of a recipe, from the store or packed and stored. `tell` receives the progress of packing and may end
    /// it. Fails if the bed cannot be packed; a bed that cannot be read or stored is packed anyway.
    pub fn bed<A: Answer>(&self, recipe: &Recipe, tell: impl FnMut(&Progress) -> A) -> Result<FoundBed, BedsError> {
        let Some(shelf) = &self.shelf else { return packed(recipe, tell, |_| None) };
        let hash = bed_hash(recipe);
        // a stored bed is read without a lock: the folder may be read-only
        if let Ok(Some(packed)) = kept(shelf, &hash) {
            return Ok(FoundBed { packed, was_kept: true, damage: None, loss: None });
        }
        let turn = match shelf.lock(&hash) {
            Ok(turn) => turn,
            Err(loss) => return packed(recipe, tell, |_| Some(loss)),
        };
        let damage = match kept(shelf, &hash) {
            Ok(Some(packed)) => return Ok(FoundBed { packed, was_kept: true, damage: None, loss: None }),
            Ok(None) => None,
            Err(damage) => Some(damage),
        };
        let found = packed(recipe, tell, |bed| shelf.put(&hash, &bed.store()).err())?;
        drop(turn);
        Ok(FoundBed { damage, ..found })
    }

    /// A value built on beds, by its hash, from the store or built and stored. A value that cannot be read or stored is
    /// built anyway. A track of forty bays takes 0.2 GB, so only the newest few are stored.
    pub fn built<T: Serialize + DeserializeOwned, E>(
        &self,
        hash: &str,
        build: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        self.found(BUILT, BUILT_KEPT, hash, build)
    }

    /// A measurement on a bed, by its hash, in the same way. It is a few numbers, so many are stored.
    pub fn measured<T: Serialize + DeserializeOwned, E>(
        &self,
        hash: &str,
        measure: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        self.found(MEASURED, MEASURED_KEPT, hash, measure)
    }

    fn found<T: Serialize + DeserializeOwned, E>(
        &self,
        kind: &'static str,
        newest: usize,
        hash: &str,
        make: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let Some(shelf) = self.folder().map(|folder| Shelf::new(folder, kind)) else { return make() };
        // without a lock two processes may make the same
        let _turn = shelf.lock(hash);
        if let Ok(Some(there)) = shelf.get(hash) {
            return Ok(there);
        }
        let made = make()?;
        let _ = shelf.put(hash, &made).and_then(|()| shelf.keep_newest(newest, hash));
        Ok(made)
    }
}

/// The kind of values that are built on beds, and the number of stored values.
const BUILT: &str = "track";
const BUILT_KEPT: usize = 4;
const MEASURED: &str = "curve";
const MEASURED_KEPT: usize = 1000;

/// Packs a bed and stores it. In both cases the run continues from the stored form, so the result does not depend on
/// whether the bed was stored before.
fn packed<A: Answer>(
    recipe: &Recipe,
    tell: impl FnMut(&Progress) -> A,
    keep: impl FnOnce(&Packed<f32>) -> Option<StoreError>,
) -> Result<FoundBed, BedsError> {
    let packed = pack::<f32, A>(recipe, tell).map_err(BedsError::Packing)?;
    let loss = keep(&packed);
    let packed = Packed::restore(packed.store()).map_err(BedsError::Restore)?;
    Ok(FoundBed { packed, was_kept: false, damage: None, loss })
}

/// A stored bed; `None` if there is none. Fails if it is damaged.
fn kept(shelf: &Shelf, hash: &str) -> Result<Option<Packed<f32>>, StoreError> {
    let Some(stored) = shelf.get::<StoredBed<f32>>(hash)? else { return Ok(None) };
    Packed::restore(stored).map(Some).map_err(|error| StoreError::damaged(&shelf.path(hash), error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{self, File};
    use std::time::{Duration, SystemTime};

    /// If the clock was set back, the last built value has the oldest date.
    #[test]
    fn what_was_built_last_is_kept_whatever_its_date() {
        let folder = tempfile::tempdir().unwrap();
        let beds = Beds::kept_in(folder.path());
        let build = |hash: &str| beds.built::<_, ()>(hash, || Ok(hash.to_owned())).unwrap();
        for number in 0..BUILT_KEPT {
            build(&format!("old-{number}"));
            let file = File::options().write(true).open(folder.path().join(format!("old-{number}.{BUILT}"))).unwrap();
            file.set_modified(SystemTime::now() + Duration::from_secs(86_400)).unwrap();
        }
        build("new");
        assert!(folder.path().join(format!("new.{BUILT}")).exists());
        let kept = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        assert_eq!(kept.filter(|path| path.extension().is_some_and(|kind| kind == BUILT)).count(), BUILT_KEPT);
    }
}
