//! Maintenance: tamping brings the level of the track back.

use serde::{Deserialize, Serialize};

/// Sleepers that are lifted and packed anew at some counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tamping {
    pub name: String,
    /// Axles that have passed before it, each once.
    pub after: Vec<u64>,
    /// Indices into [`super::Track::seats`], ascending, all of them on ballast.
    pub seats: Vec<usize>,
    /// Share of the settlement that stays, 0 .. 1.
    pub left: f64,
}
