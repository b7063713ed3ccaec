//! A compacted bed from gradings: lifts of loose grains fall and are pressed by a plate, without friction, until they
//! are at rest. Then the pressure is reduced, friction is restored and the plate is removed (Ahmadi et al. 2026,
//! section 2.1.2).
//!
//! The bed is one periodic cell along x or a box with ends; across, it lies between walls or is periodic too. The floor
//! is at z = 0. Every stage ends when forces are in balance, never after a number of steps. A stage that does not reach
//! balance is an error that reports the state reached.

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

/// Version of the methods of packing and reading beds: another version makes another bed from the same recipe.
pub const METHOD: u32 = 6;
