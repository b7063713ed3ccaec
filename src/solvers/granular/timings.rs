//! Time spent in steps, part by part.

use std::time::Duration;

/// Time spent in steps.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timings {
    /// Making lists.
    pub search: Duration,
    /// Forces between bodies.
    pub forces: Duration,
    /// Forces at walls.
    pub walls: Duration,
    /// Sums, and motion of bodies and walls.
    pub motion: Duration,
}
