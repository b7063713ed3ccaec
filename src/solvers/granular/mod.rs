//! Rigid spheres and clumps of spheres, in three dimensions.

pub mod clump;
pub mod measure;
pub mod rotation;
mod union;
