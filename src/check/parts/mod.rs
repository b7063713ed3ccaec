//! The parts of the scenario, each from complete records. Mistakes go to the findings; records and places are not
//! changed.

pub mod asked;
mod bed;
mod crib;
mod force;
mod given;
mod grading;
mod ground;
mod groundwork;
mod law;
mod layers;
pub mod layout;
pub mod loads;
mod material;
mod plate;
pub mod rails;
pub mod records;
pub mod repeats;
mod seats;
mod sides;
pub mod solve;
mod spring;
mod stack;
mod strata;
mod stretch;
mod surface;
pub mod tamping;
pub mod track;
mod trackform;
pub mod traffic;
mod under_stretches;
mod vehicle;
