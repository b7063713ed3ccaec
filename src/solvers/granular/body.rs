//! The data of a body besides its pebbles.

use serde::{Deserialize, Serialize};

/// Number of a body in the order of creation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BodyId(pub u32);

/// The part of the state of a body that its contacts do not read.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Body {
    /// At half steps \[m/s\].
    pub velocity: [f64; 3],
    /// Angular velocity of a sphere at half steps \[rad/s\]; of a clump, angular momentum \[kg m2/s\].
    pub spin: [f64; 3],
    /// Inverse of its inertia \[1/kg\]; 0 for a body that keeps its velocity.
    pub inverse_mass: f64,
    /// Inverse moment of inertia of a sphere \[1/(kg m2)\].
    pub inverse_inertia: f64,
    /// Mass that has weight, without the mass added by mass scaling \[kg\].
    pub mass: f64,
    /// Cell of the domain, not wrapped.
    pub cell: [i32; 3],
    /// Number in the order of creation.
    pub id: u32,
    /// Number of the body in its bay: the same for its copies in other bays.
    pub rank: u32,
    /// First pebble, in the order of the bed.
    pub first: u32,
    pub pebbles: u16,
    pub surface: u16,
    /// Index in the clumps of the bed, `u32::MAX` for a sphere.
    pub clump: u32,
}

pub(super) const SPHERE: u32 = u32::MAX;

/// The data of a clump in addition to those of a sphere.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Clump {
    /// Offset of the centroid in the cell of the body \[m\].
    pub centre: [f64; 3],
    /// Unit quaternion w, x, y, z: body frame to world.
    pub attitude: [f64; 4],
    /// Angular velocity of the last half step \[rad/s\].
    pub turning: [f64; 3],
    /// Inverse principal moments of inertia \[1/(kg m2)\].
    pub inverse_inertia: [f64; 3],
    /// Index of the first pebble position in the body frame.
    pub arms: u32,
}
