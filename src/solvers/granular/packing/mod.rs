//! A compacted bed from gradings: lifts of loose grains fall and are pressed by a plate, without friction, until they are at
//! rest; then the plate is eased, friction comes back and the plate goes (Ahmadi et al. 2026, section 2.1.2).
//!
//! The bed is one periodic cell along x or a box with ends, between walls across or periodic there too, on a floor at z = 0. Every stage ends when
//! forces are in balance, never by a count of steps; one that does not get there is told with what it reached.

mod check;
mod describe;
mod error;
mod filling;
mod pace;
mod pack;
mod packed;
mod place;
mod press;
mod progress;
mod recipe;
mod store;
#[cfg(test)]
pub(super) mod tests;
mod track;

pub use check::{GRAIN, widest};
pub use describe::{BedState, LayerState, Stage, StageKind};
pub use error::PackingError;
pub use pack::pack;
pub use packed::Packed;
pub(super) use place::{Room, put, set_loose};
pub use progress::Progress;
pub use recipe::{GrainLayer, Packing, Recipe, Rest, Restored, lifts_that_fit};
pub use store::StoredBed;
pub use track::{Order, TrackAccount, TrackBed, lay};

/// Counts the ways in which beds have been packed and read: another one makes another bed of the same recipe.
pub const METHOD: u32 = 6;
