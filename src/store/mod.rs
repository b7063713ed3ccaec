//! The store: data that the program writes to a disk is read back complete, or refused with an error that names the
//! file.
//!
//! A [`Directory`] of results is a transaction: its files are staged, and [`Directory::commit`] puts all of them in
//! place atomically. A kill at any time leaves either the old or the new results. Work in progress has a checkpoint,
//! pieces beside it, and a lock that excludes other processes. [`Finished`] reads such a directory and checks every
//! file. [`Unfinished`] reads the stored data of work in progress, and any number of processes can add pieces to it.
//! [`Beds`] are packed beds by the hash of their recipe.
//!
//! The store handles bytes, hashes and recipes of solvers; it does not know scenes.

mod atomic;
mod beds;
mod directory;
mod disk;
mod error;
mod finished;
mod layout;
mod lock;
mod manifest;
mod recovery;
mod seal;
mod shared;
mod shelf;
#[cfg(test)]
mod tests;
mod unfinished;

pub use atomic::{rewrite_atomically, write_atomically};
pub use beds::{Beds, BedsError, FoundBed, bed_hash, recipe_hash};
pub use directory::{Directory, Mode};
pub use disk::{Disk, FileSystem};
pub use error::StoreError;
pub use finished::Finished;
pub use manifest::{FileRecord, Manifest};
pub use shared::Claim;
pub use shelf::Shelf;
pub use unfinished::{Piece, Unfinished};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The work of a directory: the kind of work, and its scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Name for the user: `run`, or "study \`pads\`".
    pub name: String,
    pub scene_sha256: String,
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
