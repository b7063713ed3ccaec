//! The data of a bed kept between two checks.

use super::super::vector::Vec3;

/// The last stable state of the bed, and the motion one step ago.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Watch {
    /// The last stable state of the bed.
    pub(super) good: Good,
    /// Velocity and spin of every body one step ago, and the number of their lists.
    pub(super) before: Vec<[f32; 6]>,
    pub(super) lists: u64,
    /// Number of checks in a row with a suspect body.
    pub(super) suspected: u32,
    /// Largest energy of a reversing motion \[J\] and time step for which the network is known to be stable.
    pub(super) cleared: (f64, f64),
}

/// Positions of the last stable state, in the order of creation.
#[derive(Debug, Clone, Default)]
pub(super) struct Good {
    pub(super) cells: Vec<[i32; 3]>,
    /// Offsets of pebbles \[m\].
    pub(super) pebbles: Vec<Vec3>,
    pub(super) clumps: Vec<(Vec3, [f64; 4])>,
    /// Gap up to which contacts open and close \[m\].
    pub(super) gap: f64,
}
