//! Systems of equations; knows no physics.

pub mod banded;
pub mod dense;
pub mod skyline;
pub mod twisted;
