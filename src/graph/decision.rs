//! Decisions of the passes, and the estimated cost of a run.

use serde::{Deserialize, Serialize};

/// A decision of a pass and its reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    pub pass: String,
    pub what: String,
    pub why: String,
    /// Alternatives that were not taken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rejected: Vec<Rejected>,
}

/// An alternative that a pass did not take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rejected {
    pub what: String,
    pub why: String,
    /// Its cost on two cores, s, if known.
    pub seconds: Option<f64>,
    /// Its expected error / largest settlement, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
}

impl Rejected {
    /// An alternative of unknown cost and error.
    pub fn new(what: impl Into<String>, why: impl Into<String>) -> Rejected {
        Rejected { what: what.into(), why: why.into(), seconds: None, error: None }
    }
}

/// Expected error of a plan / largest settlement, as far as charts show it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ExpectedError {
    /// By blocks, mesh, steps and trains that are left out, against a fine run of the same models; `None` if only the
    /// run can tell.
    pub numerical: Option<f64>,
    /// By the tier, against grains under the whole window; `None` if the scene has no grains or no chart shows it.
    pub of_tier: Option<f64>,
    /// The evidence for the error of the tier.
    pub evidence: String,
}

impl ExpectedError {
    /// Both together, as far as they are known; `None` if neither is. They do not depend on each other, so their
    /// squares add up.
    pub fn share(&self) -> Option<f64> {
        match (self.numerical, self.of_tier) {
            (None, None) => None,
            (a, b) => Some(a.unwrap_or(0.0).hypot(b.unwrap_or(0.0))),
        }
    }
}

/// Cost of a run: an estimate from the number of unknowns and steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Time on one core, s.
    pub seconds: f64,
    /// Time on two cores, s; equal to the time on one core if the work is not parallel.
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

/// Passages of trains. The count assumes that no prescribed block overshoots.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PassageWork {
    pub unknowns: usize,
    pub blocks: u64,
    /// Axles of the shortest and of the longest block.
    pub block_axles: [u64; 2],
    pub passages: u64,
    pub steps: u64,
}

/// Tests of packed beds; an estimate within a factor of two.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TestWork {
    pub grains: f64,
    pub pebbles: f64,
    /// Time step, s.
    pub time_step: f64,
    pub packing_steps: f64,
    /// Time on two cores to make the beds that a cache keeps, s: a later run of the same beds does not need it.
    #[serde(default)]
    pub making: f64,
    /// Steps of the test, including the setting down.
    pub test_steps: f64,
    /// Packings at most; cost and steps are those of all.
    pub packings: u32,
    /// Packings at least: in an open range the results decide.
    #[serde(default)]
    pub least_packings: u32,
}

impl Cost {
    /// The cost of this work and of other work after it; the work that is counted stays this one.
    #[must_use]
    pub fn and(self, other: Cost) -> Cost {
        Cost {
            seconds: self.seconds + other.seconds,
            seconds_on_two_cores: self.seconds_on_two_cores + other.seconds_on_two_cores,
            bytes: self.bytes + other.bytes,
            ..self
        }
    }

    /// The work of passages; zero for a test.
    pub fn passages(&self) -> PassageWork {
        match self.work {
            Work::Passages(work) => work,
            Work::Tests(_) => PassageWork::default(),
        }
    }
}
