//! The store: what a program keeps on a disk comes back whole, or is refused by name.
//!
//! A [`Directory`] of results is a transaction: its files are staged, and [`Directory::commit`] puts all of them in place at once, so
//! that a kill at any instant leaves the old results or the new ones. While work is under way it keeps a checkpoint and pieces
//! beside it, and a lock that keeps others out. [`Finished`] reads such a directory and checks every file; [`Unfinished`] reads
//! what work under way has kept so far, and adds pieces to it from any number of processes. [`Beds`] are packed beds
//! by the hash of their recipe.
//!
//! The store knows bytes, hashes and recipes of solvers, and no scene.

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

/// What a directory is of: a kind of work, and the scene that it is done for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// What a person calls it: `run`, or "study \`pads\`".
    pub name: String,
    pub scene_sha256: String,
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
