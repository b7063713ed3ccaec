//! Test rigs: sleepers that are set down on a packed bed and loaded by actuators.
//!
//! A sleeper is a block that moves up and down under its own mass, its weight, the force of its actuator and the forces
//! of the grains below; it does not tilt. It is set down where it touches the first grain and comes to rest under its
//! own weight; the end is decided by the forces out of balance. The space between sleepers is empty, or it is
//! [`fill`]ed with grains after the sleepers are at rest. Settlement is measured from this state, downwards.
//!
//! A cycle goes from the lower force to the upper force and back. Its results are the settlement at its end, the
//! resilient stiffness (range of force / rebound from the deepest position to the end), and the work that stays in the
//! bed.
//!
//! A plate over the whole bed may be driven down instead of loaded, and the sides of a box-shaped bed may move under a
//! pressure: see [`Specimen`]. Forces on the plate are then in addition to that pressure.

mod answer;
mod calm;
mod crib;
mod description;
mod error;
mod filling;
mod glued;
mod pocket;
mod sensor;
mod set_down;
mod specimen;
mod store;
#[cfg(test)]
mod tests;
mod trial;

pub use answer::{Cycle, CycleSample};
pub use crib::fill;
pub use description::{ADDED, Load, Rig, Sleeper};
pub use error::{Resting, RigError};
pub use filling::{Crib, Filling, SOLID};
pub use glued::{Glued, glue};
pub use sensor::{Sensor, SensorReading};
pub use set_down::stand;
pub use specimen::{Specimen, SpecimenState};
pub use store::StoredTrial;
pub use trial::Trial;
