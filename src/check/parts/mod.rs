//! The parts of the scenario, each from complete records. Whatever is wrong goes to the findings; records and places stay as they
//! are.

pub mod asked;
pub mod force;
pub mod given;
pub mod grading;
pub mod ground;
pub mod groundwork;
pub mod law;
pub mod layers;
pub mod layout;
pub mod loads;
pub mod material;
pub mod plate;
pub mod rails;
pub mod records;
pub mod seats;
pub mod solve;
pub mod spring;
pub mod strata;
pub mod stretch;
pub mod support;
pub mod surface;
pub mod tamping;
pub mod tier;
pub mod track;
pub mod trackform;
pub mod traffic;
pub mod under_stretches;
pub mod vehicle;
