//! Rigid spheres and clumps of spheres, in three dimensions.

pub mod rotation;
