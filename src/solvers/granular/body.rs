//! What a body is, beside its pebbles.

use serde::{Deserialize, Serialize};

/// Number of a body in the order of its making.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BodyId(pub u32);

/// The state of a body that its contacts do not read.
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
    /// Mass that has weight, without what mass scaling added \[kg\].
    pub mass: f64,
    /// Cell of the domain, not wrapped.
    pub cell: [i32; 3],
    /// In the order of making.
    pub id: u32,
    /// Its number among its equals: the same for copies of a body in other bays.
    pub rank: u32,
    /// First pebble, in the order of the bed.
    pub first: u32,
    pub pebbles: u16,
    pub surface: u16,
    /// Place in the bed's clumps, `u32::MAX` for a sphere.
    pub clump: u32,
}

pub(super) const SPHERE: u32 = u32::MAX;

/// What a clump has beside a sphere.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Clump {
    /// Offset of the centroid in the body's cell \[m\].
    pub centre: [f64; 3],
    /// Unit quaternion w, x, y, z: body frame to world.
    pub attitude: [f64; 4],
    /// Angular velocity of the last half step \[rad/s\].
    pub turning: [f64; 3],
    /// Principal, of inertia \[1/(kg m2)\].
    pub inverse_inertia: [f64; 3],
    /// First of its pebbles' places in the body frame.
    pub arms: u32,
}
