//! Systems of equations; knows no physics.

pub mod banded;
pub mod skyline;
pub mod sparse;
pub mod twisted;
pub mod vector;
