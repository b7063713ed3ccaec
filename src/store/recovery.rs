//! Recovery of a directory after a kill in any state, by repeating the logged commit.
//!
//! 1. Before `intent.json` exists, the old results are valid; staged files are deleted.
//! 2. After that the new results are certain. The remaining steps can be read from the disk and may be repeated:
//!    each staged file is renamed to its place; files that are only in the old manifest are removed; then the
//!    unfinished work and the staging folder are removed. The old manifest stays until all of this is done, because it
//!    lists the old files.
//! 3. `intent.json` is renamed to `manifest.json`: there is no intent any more, and the new results are valid.
//!
//! A directory without an intent is complete; a directory with an intent is completed by [`finish`].

use super::StoreError;
use super::disk::Disk;
use super::layout::{Layout, part};
use super::manifest::Manifest;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Recovers a directory. Only for the holder of its lock.
pub(super) fn recover(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    match Manifest::read(&layout.intent())? {
        Some(intent) => finish(disk, layout, &intent),
        None => remove_staged(disk, layout),
    }
}

/// Puts the staged files in place, continuing an earlier attempt.
pub(super) fn finish(disk: &impl Disk, layout: &Layout, intent: &Manifest) -> Result<(), StoreError> {
    let mut folders = BTreeSet::from([layout.root.clone()]);
    for file in &intent.files {
        let (staged, place) = (layout.staging().join(&file.name), layout.root.join(&file.name));
        let folder = place.parent().map_or_else(|| layout.root.clone(), PathBuf::from);
        if staged.exists() {
            disk.create_folder(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
            disk.rename(&staged, &place).map_err(|cause| StoreError::io(&place, "write", cause))?;
        } else if !place.exists() {
            return Err(StoreError::damaged(&place, "the file is missing, but the manifest names it"));
        }
        folders.insert(folder);
    }
    remove_old(disk, layout, intent)?;
    discard(disk, layout)?;
    remove_staged(disk, layout)?;
    let synced = folders.iter().try_for_each(|folder| disk.sync_folder(folder));
    let named = synced.and_then(|()| disk.rename(&layout.intent(), &layout.manifest()));
    named
        .and_then(|()| disk.sync_folder(&layout.root))
        .map_err(|cause| StoreError::io(&layout.manifest(), "write", cause))
}

/// Removes files that are in the old manifest but not in the new one; files in no manifest belong to others and stay.
fn remove_old(disk: &impl Disk, layout: &Layout, intent: &Manifest) -> Result<(), StoreError> {
    // the files of a damaged manifest are not known: they stay, and no reader uses them
    let Ok(Some(old)) = Manifest::read(&layout.manifest()) else { return Ok(()) };
    for file in old.files.iter().filter(|file| intent.file(&file.name).is_none()) {
        let path = layout.root.join(&file.name);
        disk.remove_file(&path).map_err(|cause| StoreError::io(&path, "remove", cause))?;
    }
    Ok(())
}

/// Removes unfinished work. The checkpoint is removed first: pieces are complete without a checkpoint.
pub(super) fn discard(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let file = |path: PathBuf| disk.remove_file(&path).map_err(|cause| StoreError::io(&path, "remove", cause));
    file(layout.checkpoint())?;
    // a kill can leave files under their temporary names
    for written in [layout.checkpoint(), layout.work(), layout.so_far(), layout.intent()] {
        file(part(&written))?;
    }
    for folder in [layout.pieces(), layout.claims(), layout.logs(), layout.parts()] {
        disk.remove_folder(&folder).map_err(|cause| StoreError::io(&folder, "remove", cause))?;
    }
    file(layout.so_far())?;
    file(layout.work())
}

fn remove_staged(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let staging = layout.staging();
    disk.remove_folder(&staging).map_err(|cause| StoreError::io(&staging, "remove", cause))
}

/// Removes an intent that cannot be read, if everything is to be replaced.
pub(super) fn abandon(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let intent = layout.intent();
    disk.remove_file(&intent).map_err(|cause| StoreError::io(&intent, "remove", cause))?;
    remove_staged(disk, layout)
}
