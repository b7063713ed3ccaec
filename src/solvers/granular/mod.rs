//! Discrete elements: walls that spheres touch, and how walls move.

pub mod motion;
pub mod shape;
