//! What is kept of a bed between two looks at it.

use super::super::vector::Vec3;

/// The bed when all was well, and the motion of a step ago.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Watch {
    /// The bed when all was still well.
    pub(super) good: Good,
    /// Velocity and spin of every body one step ago, and which lists they belong to.
    pub(super) before: Vec<[f32; 6]>,
    pub(super) lists: u64,
    /// Looks in a row with a suspect.
    pub(super) suspected: u32,
    /// Up to which energy of turning \[J\] and for which step the network is known to be stable.
    pub(super) cleared: (f64, f64),
}

/// Where everything was, in the order of making.
#[derive(Debug, Clone, Default)]
pub(super) struct Good {
    pub(super) cells: Vec<[i32; 3]>,
    /// Offsets of pebbles \[m\].
    pub(super) pebbles: Vec<Vec3>,
    pub(super) clumps: Vec<(Vec3, [f64; 4])>,
    /// Gap up to which contacts open and close \[m\].
    pub(super) gap: f64,
}
