//! Why a test has no result.

use super::super::failure::Failure;
use super::super::grains::GradingError;
use std::fmt;

/// Why a test on a rig has no result.
#[derive(Debug, Clone, PartialEq)]
pub enum RigError {
    /// Forces are not in balance after the longest time of a stage.
    Restless {
        stage: Resting,
        unbalance: f64,
        limit: f64,
        /// Share of the force on the sleepers that the bed does not carry.
        uncarried: f64,
        time: f64,
    },
    /// A sleeper sinks into the bed without resistance.
    Sunk { sleeper: usize, depth: f64, cycle: u64 },
    /// There is no room for a grain of the cribs beside the sleepers.
    NoRoom { layer: String },
    /// A grading that gives no grains for the cribs.
    Grading(GradingError),
    /// The caller has stopped the test.
    Stopped,
    /// The motion of the grains failed.
    Failure { cycle: u64, failure: Failure },
}

/// The part that comes to rest before a test begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resting {
    /// The sleepers under their own weight.
    Sleepers,
    /// The grains poured between and beside the sleepers.
    Crib,
    /// A specimen under the pressure on its sides.
    Specimen,
}

impl fmt::Display for Resting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Resting::Sleepers => "sleepers set down",
            Resting::Crib => "grains poured into the cribs",
            Resting::Specimen => "specimen under the pressure on its sides",
        })
    }
}

impl fmt::Display for RigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RigError::Restless { stage, unbalance, limit, uncarried, time } => write!(
                f,
                "{stage}: forces are out of balance by {:.2} % after {time:.2} s, above the limit of {:.2} %; the bed does not \
                 carry {:.1} % of the force on the sleepers",
                100.0 * unbalance,
                100.0 * limit,
                100.0 * uncarried
            ),
            RigError::Sunk { sleeper, depth, cycle } => write!(
                f,
                "sleeper {} has sunk {:.0} mm into the bed in cycle {cycle}: the bed does not carry it",
                sleeper + 1,
                1e3 * depth
            ),
            RigError::NoRoom { layer } => write!(
                f,
                "a grain of `{layer}` is too large for the space between the sleepers and beside them: write a wider sleeper \
                 spacing, or remove the largest sizes from the grading"
            ),
            RigError::Grading(cause) => write!(f, "grains for the cribs: {cause}"),
            RigError::Stopped => f.write_str("the test was stopped"),
            RigError::Failure { cycle: 0, failure } => write!(f, "while the sleepers are set down: {failure}"),
            RigError::Failure { cycle, failure } => write!(f, "in cycle {cycle}: {failure}"),
        }
    }
}

impl std::error::Error for RigError {}

/// A failure in a cycle.
pub(super) fn in_cycle(cycle: u64) -> impl Fn(Failure) -> RigError {
    move |failure| RigError::Failure { cycle, failure }
}
