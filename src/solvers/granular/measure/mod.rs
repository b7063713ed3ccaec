//! Measurements of a bed: porosity, coordination, stress, fabric, forces and motion.
//!
//! Most are functions of plain numbers: positions (m) and radii (m), without state. In a periodic bed the caller passes
//! the images that reach into the region. A [`Survey`] does this for a whole bed.

mod balance;
mod ball;
mod clump;
mod contacts;
mod fabric;
mod forces;
mod line;
#[cfg(test)]
pub(super) mod packed;
mod region;
mod survey;
#[cfg(test)]
mod tests;

pub use balance::{ForceBalance, balance, unbalance};
pub use contacts::{Contact, Coordination, coordination, neighbours, stress};
pub use fabric::{Fabric, Rose};
pub use forces::{ContactPush, ForceSpread};
pub use region::{Ball, NoRegion, Region};
pub use survey::{Reading, Survey};
