//! Test rigs: sleepers that are set down on a packed bed and loaded by actuators.
//!
//! A sleeper is a block that moves up and down under its own mass, weight, the force of its actuator and the forces of the grains
//! below; it does not tilt. It is set down where it touches the first grain and comes to rest under its own weight, by the forces that
//! are out of balance. The space between sleepers is empty, or [`fill`]ed with grains once they rest. From there settlement counts,
//! downwards.
//!
//! A cycle goes from the lower force to the upper one and back. What is read of it: the settlement at its end, the resilient
//! stiffness, range of force / rebound from the deepest place to the end, and the work that the bed keeps.
//!
//! A plate over the whole bed may be driven down instead of loaded, and the sides of a bed that is a box may give way under a
//! pressure: see [`Specimen`]. Forces on the plate are then on top of that pressure.

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
