//! What passes decided, and what a run will take: the plan's own account of itself.

use serde::{Deserialize, Serialize};

/// What a pass did and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    pub pass: String,
    pub what: String,
    pub why: String,
    /// What was possible and not taken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rejected: Vec<Rejected>,
}

/// A way that a pass did not take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rejected {
    pub what: String,
    pub why: String,
    /// What it would have cost on two cores, s, where that is known.
    pub seconds: Option<f64>,
}

/// What a run will take: an estimate from counts of unknowns and steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// On one core, s.
    pub seconds: f64,
    /// On two cores, s; that of one core where a second one is not counted on.
    pub seconds_on_two_cores: f64,
    pub bytes: u64,
    pub work: Work,
}

/// The work that the cost counts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    Passages(PassageWork),
    Tests(TestWork),
}

/// Passages of trains. Blocks that are prescribed are counted as if none overshot.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PassageWork {
    pub unknowns: usize,
    pub blocks: u64,
    /// Axles of the shortest and of the longest block.
    pub block_axles: [u64; 2],
    pub passages: u64,
    pub steps: u64,
}

/// Tests of packed beds; good to a factor of two.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TestWork {
    pub grains: f64,
    pub pebbles: f64,
    /// s.
    pub time_step: f64,
    pub packing_steps: f64,
    /// Steps of the test, setting down included.
    pub test_steps: f64,
    pub packings: u32,
}

impl Cost {
    /// The work of passages; none of a test.
    pub fn passages(&self) -> PassageWork {
        match self.work {
            Work::Passages(work) => work,
            Work::Tests(_) => PassageWork::default(),
        }
    }
}
