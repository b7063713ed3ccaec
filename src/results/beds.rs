//! Packed beds that were built before, by what made them: a folder with one folder for each recipe.

use super::{ResultsError, checkpoint};
use crate::solvers::granular::RestoreError;
use crate::solvers::granular::packing::{METHOD, Packed, PackingError, Progress, Recipe, StoredBed, pack};
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, PoisonError};

/// Names what a recipe makes: the same recipe gives the same bed, bit by bit, for one version of the program.
pub fn bed_hash(recipe: &Recipe) -> String {
    hash_of(recipe)
}

pub(super) fn hash_of(what: &impl Serialize) -> String {
    let text = format!("{METHOD} {}", serde_json::to_string(what).unwrap_or_default());
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Where beds are kept. Of threads that want the same bed one packs it, and the others wait for it.
#[derive(Debug, Default)]
pub struct Beds {
    folder: Option<PathBuf>,
    /// Hashes of those that are being packed.
    busy: Mutex<BTreeSet<String>>,
    changed: Condvar,
}

/// Why there is no bed.
#[derive(Debug, Clone, PartialEq)]
pub enum BedsError {
    Packing(PackingError),
    /// What was packed does not come back from what is kept of it.
    Restore(RestoreError),
}

impl std::fmt::Display for BedsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
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
    /// Why a new one is not kept.
    pub loss: Option<ResultsError>,
}

impl Beds {
    /// In a folder, which is made where it does not exist.
    pub fn kept_in(folder: impl Into<PathBuf>) -> Beds {
        Beds { folder: Some(folder.into()), ..Beds::default() }
    }

    /// Nowhere: each is packed anew.
    pub fn not_kept() -> Beds {
        Beds::default()
    }

    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The bed of a recipe: as it was kept, or packed and kept. `tell` hears how far packing is.
    pub fn bed(&self, recipe: &Recipe, tell: impl FnMut(&Progress)) -> Result<FoundBed, BedsError> {
        let Some(folder) = &self.folder else { return packed(recipe, tell, |_| None) };
        let _turn = self.turn(bed_hash(recipe));
        match kept(folder, recipe) {
            Some(packed) => Ok(FoundBed { packed, was_kept: true, loss: None }),
            None => packed(recipe, tell, |bed| keep(folder, recipe, bed).err()),
        }
    }

    /// Waits until nobody else packs that bed.
    fn turn(&self, hash: String) -> Turn<'_> {
        let mut busy = self.busy.lock().unwrap_or_else(PoisonError::into_inner);
        while !busy.insert(hash.clone()) {
            busy = self.changed.wait(busy).unwrap_or_else(PoisonError::into_inner);
        }
        Turn { beds: self, hash }
    }
}

/// A bed that is being packed; others may when it goes.
struct Turn<'a> {
    beds: &'a Beds,
    hash: String,
}

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.beds.busy.lock().unwrap_or_else(PoisonError::into_inner).remove(&self.hash);
        self.beds.changed.notify_all();
    }
}

/// Packs a bed and keeps it. What comes later must not know whether it was kept: it goes on from what is stored in both cases.
fn packed(
    recipe: &Recipe,
    tell: impl FnMut(&Progress),
    keep: impl FnOnce(&Packed<f32>) -> Option<ResultsError>,
) -> Result<FoundBed, BedsError> {
    let packed = pack::<f32>(recipe, tell).map_err(BedsError::Packing)?;
    let loss = keep(&packed);
    let packed = Packed::restore(packed.store()).map_err(BedsError::Restore)?;
    Ok(FoundBed { packed, was_kept: false, loss })
}

/// A bed of this recipe that was kept; `None` where there is none that can be used.
fn kept(folder: &Path, recipe: &Recipe) -> Option<Packed<f32>> {
    let hash = bed_hash(recipe);
    let stored: StoredBed<f32> = checkpoint::read(&folder.join(&hash), &hash).ok()??;
    Packed::restore(stored).ok()
}

/// Keeps a bed that is finished, whole or not at all.
fn keep(folder: &Path, recipe: &Recipe, bed: &Packed<f32>) -> Result<(), ResultsError> {
    let hash = bed_hash(recipe);
    checkpoint::write(&folder.join(&hash), &hash, &bed.store())
}
