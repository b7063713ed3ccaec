//! From any state in which a kill can leave a directory to one that has a name: the log that is done again.
//!
//! 1. Until `intent.json` has its name, results are the old ones; what is staged is thrown away.
//! 2. From then on the new results are certain. What is left to do can be read off the disk, and doing it twice is doing it once:
//!    each staged file is renamed to its place; files that only the old manifest names go; then the unfinished work and the staging
//!    folder go. The old manifest stays until all of this is done, because it says which files are old.
//! 3. `intent.json` is renamed to `manifest.json`: there is no intent any more, and the results are the new ones.
//!
//! So a directory without an intent is in order, and one with an intent is brought to order by [`finish`].

use super::StoreError;
use super::disk::Disk;
use super::layout::{Layout, part};
use super::manifest::Manifest;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Brings a directory to order. Only for the holder of its lock.
pub(super) fn recover(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    match Manifest::read(&layout.intent())? {
        Some(intent) => finish(disk, layout, &intent),
        None => remove_staged(disk, layout),
    }
}

/// Puts what is staged in its place, from wherever an earlier attempt has got to.
pub(super) fn finish(disk: &impl Disk, layout: &Layout, intent: &Manifest) -> Result<(), StoreError> {
    let mut folders = BTreeSet::from([layout.root.clone()]);
    for file in &intent.files {
        let (staged, place) = (layout.staging().join(&file.name), layout.root.join(&file.name));
        let folder = place.parent().map_or_else(|| layout.root.clone(), PathBuf::from);
        if staged.exists() {
            disk.create_folder(&folder).map_err(|cause| StoreError::io(&folder, "create", cause))?;
            disk.rename(&staged, &place).map_err(|cause| StoreError::io(&place, "write", cause))?;
        } else if !place.exists() {
            return Err(StoreError::damaged(&place, "it is gone, and the manifest names it"));
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

/// Removes what the old manifest names and the new one does not; files that no manifest names are somebody else's.
fn remove_old(disk: &impl Disk, layout: &Layout, intent: &Manifest) -> Result<(), StoreError> {
    // of a damaged manifest nothing is known: its files stay, and no reader looks at them
    let Ok(Some(old)) = Manifest::read(&layout.manifest()) else { return Ok(()) };
    for file in old.files.iter().filter(|file| intent.file(&file.name).is_none()) {
        let path = layout.root.join(&file.name);
        disk.remove_file(&path).map_err(|cause| StoreError::io(&path, "remove", cause))?;
    }
    Ok(())
}

/// Removes unfinished work. The checkpoint goes first: pieces without one are whole by themselves.
pub(super) fn discard(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let file = |path: PathBuf| disk.remove_file(&path).map_err(|cause| StoreError::io(&path, "remove", cause));
    file(layout.checkpoint())?;
    // a kill leaves what was being written under its first name
    for written in [layout.checkpoint(), layout.work(), layout.so_far(), layout.intent()] {
        file(part(&written))?;
    }
    for folder in [layout.pieces(), layout.claims(), layout.logs()] {
        disk.remove_folder(&folder).map_err(|cause| StoreError::io(&folder, "remove", cause))?;
    }
    file(layout.so_far())?;
    file(layout.work())
}

fn remove_staged(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let staging = layout.staging();
    disk.remove_folder(&staging).map_err(|cause| StoreError::io(&staging, "remove", cause))
}

/// Removes an intent that cannot be read, where everything is to be replaced.
pub(super) fn abandon(disk: &impl Disk, layout: &Layout) -> Result<(), StoreError> {
    let intent = layout.intent();
    disk.remove_file(&intent).map_err(|cause| StoreError::io(&intent, "remove", cause))?;
    remove_staged(disk, layout)
}
