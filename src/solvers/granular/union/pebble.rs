//! A ball of a union.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One sphere of a clump.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pebble {
    /// m.
    pub centre: Vector3<f64>,
    /// m.
    pub radius: f64,
}
