//! Progress reports for callers that wait for a bed.

/// Progress of packing.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    pub stage: String,
    /// Share of all stages that is done, 0 .. 1; an estimate.
    pub share: f64,
    pub bodies: usize,
    pub steps: u64,
}
