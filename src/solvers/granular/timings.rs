//! Where the time of steps goes, part by part.

use std::time::Duration;

/// Where the time of steps went.
#[derive(Debug, Clone, Copy, Default)]
pub struct Timings {
    /// Making lists.
    pub search: Duration,
    /// Forces between bodies.
    pub forces: Duration,
    /// Forces at walls.
    pub walls: Duration,
    /// Sums, bodies and walls in motion.
    pub motion: Duration,
}
