//! What a run tells of the comparison of a passage with a finer one.

use serde::{Deserialize, Serialize};

/// A passage as planned beside one with twice the elements and shorter steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Axles that had passed.
    pub axles: u64,
    /// Largest difference of the settlement that one train adds / its largest settlement.
    pub difference: f64,
    /// The largest difference with which the run goes on as planned.
    pub limit: f64,
    /// Whether no block was left: the passages of a run with long blocks are compared after its last one.
    pub at_the_end: bool,
}

impl Comparison {
    /// Whether both differ by more than the limit.
    pub fn exceeds(&self) -> bool {
        self.difference > self.limit
    }

    /// Whether the run goes on with the finer passages.
    pub fn refines(&self) -> bool {
        self.exceeds() && !self.at_the_end
    }
}
