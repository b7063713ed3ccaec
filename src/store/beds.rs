//! Packed beds that were built before, by what made them.

use super::{Shelf, StoreError, sha256};
use crate::solvers::granular::packing::{METHOD, Packed, PackingError, Progress, Recipe, StoredBed, pack};
use crate::solvers::granular::{Answer, RestoreError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt;
use std::path::{Path, PathBuf};

/// Names what a recipe makes: the same recipe gives the same bed, bit by bit, for one version of the program.
pub fn bed_hash(recipe: &Recipe) -> String {
    recipe_hash(recipe)
}

/// Names what is made of `what` by the way in which beds are packed and read today.
pub fn recipe_hash(what: &impl Serialize) -> String {
    sha256(format!("{METHOD} {}", serde_json::to_string(what).unwrap_or_default()).as_bytes())
}

/// Where beds are kept. Of threads and processes that want the same bed one packs it, and the others wait for it.
#[derive(Debug, Default)]
pub struct Beds {
    shelf: Option<Shelf>,
}

/// Why there is no bed.
#[derive(Debug, Clone, PartialEq)]
pub enum BedsError {
    Packing(PackingError),
    /// What was packed does not come back from what is kept of it.
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

/// A bed, and how it came about.
pub struct FoundBed {
    pub packed: Packed<f32>,
    /// Whether it was there already.
    pub was_kept: bool,
    /// What was wrong with the one that was there: it has been thrown away, and packed anew.
    pub damage: Option<StoreError>,
    /// Why a new one is not kept.
    pub loss: Option<StoreError>,
}

impl Beds {
    /// Beds in a folder, which is made where it does not exist.
    pub fn kept_in(folder: impl Into<PathBuf>) -> Beds {
        Beds { shelf: Some(Shelf::new(folder, "bed")) }
    }

    /// Beds that are kept nowhere: each is packed anew.
    pub fn not_kept() -> Beds {
        Beds::default()
    }

    /// The folder of the beds; `None` where they are kept nowhere.
    pub fn folder(&self) -> Option<&Path> {
        self.shelf.as_ref().map(Shelf::folder)
    }

    /// The bed of a recipe: as it was kept, or packed and kept. `tell` hears how far packing is, and may end it. Fails where it cannot be
    /// packed; a bed that cannot be read or kept is packed all the same.
    pub fn bed<A: Answer>(&self, recipe: &Recipe, tell: impl FnMut(&Progress) -> A) -> Result<FoundBed, BedsError> {
        let Some(shelf) = &self.shelf else { return packed(recipe, tell, |_| None) };
        let hash = bed_hash(recipe);
        // what is there is read without a lock: a folder may be there to be read only
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

    /// What is built on beds, by the hash of what makes it: as it was kept, or built and kept. What cannot be read or kept is built all the
    /// same. A track of forty bays takes 0.2 GB, so only the newest few are kept.
    pub fn built<T: Serialize + DeserializeOwned, E>(
        &self,
        hash: &str,
        build: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let Some(shelf) = self.folder().map(|folder| Shelf::new(folder, BUILT)) else { return build() };
        // without a lock two processes may build the same
        let _turn = shelf.lock(hash);
        if let Ok(Some(there)) = shelf.get(hash) {
            return Ok(there);
        }
        let built = build()?;
        let _ = shelf.put(hash, &built).and_then(|()| shelf.keep_newest(BUILT_KEPT, hash));
        Ok(built)
    }
}

/// The word for what is built on beds, and how many of them are kept.
const BUILT: &str = "track";
const BUILT_KEPT: usize = 4;

/// Packs a bed and keeps it. What comes later must not know whether it was kept: it goes on from what is stored in both cases.
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

/// A bed that was kept; `None` where there is none. Fails where it is damaged.
fn kept(shelf: &Shelf, hash: &str) -> Result<Option<Packed<f32>>, StoreError> {
    let Some(stored) = shelf.get::<StoredBed<f32>>(hash)? else { return Ok(None) };
    Packed::restore(stored).map(Some).map_err(|error| StoreError::damaged(&shelf.path(hash), error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{self, File};
    use std::time::{Duration, SystemTime};

    /// Where the clock has gone back, what was built last is the oldest by its date.
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
