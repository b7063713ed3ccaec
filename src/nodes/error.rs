//! Errors of a node.

use crate::graph::{BedError, LawBounds};
use crate::solvers::continuum::SoilError;
use crate::solvers::granular::Failure;
use crate::solvers::granular::packing::PackingError;
use crate::solvers::granular::rig::RigError;
use crate::solvers::track::TrackError;
use crate::store::BedsError;
use std::fmt;

/// A failure of a node, by its kind.
#[derive(Debug, Clone, PartialEq)]
pub enum NodeError {
    /// The track or a passage over it.
    Track(TrackError),
    /// A bed that has no recipe.
    Bed(BedError),
    /// Packing, or a stored bed that cannot be read.
    Packing(BedsError),
    /// A test.
    Rig(RigError),
    /// The motion of grains under a track.
    Grains(Failure),
    /// The soil below them.
    Soil(SoilError),
    /// A track without ground yet.
    NoGround,
    /// A passage of a schedule without trains.
    NoTrain,
    /// A stored state of another node.
    Foreign { node: &'static str, why: String },
    /// A node of the graph without a builder.
    NoBuilder { node: String, kind: String },
    /// A seat whose settlement (m) is larger than the thickness of the ballast below it.
    Sunk { seat: usize, settlement: f64 },
    /// A fitted law at a seat whose peak force (N) or void (m) is outside its range.
    BeyondLaw { law: String, seat: usize, found: LawBounds, bounds: LawBounds },
    /// A listener has ended the run, before its first step or in the middle of a block. The run can continue from the
    /// state stored before.
    Stopped,
    /// Error of a node of another program.
    Other { node: String, why: String },
}

impl fmt::Display for NodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NodeError::Track(cause) => cause.fmt(f),
            NodeError::Bed(cause) => cause.fmt(f),
            NodeError::Packing(cause) => cause.fmt(f),
            NodeError::Rig(cause) => cause.fmt(f),
            NodeError::Grains(cause) => write!(f, "the grains under the track: {cause}"),
            NodeError::Soil(cause) => write!(f, "the soil below the grains: {cause}"),
            NodeError::NoGround => f.write_str("the track has no ground below it"),
            NodeError::NoTrain => f.write_str("no train runs over the track"),
            NodeError::Sunk { settlement, .. } => {
                write!(f, "a sleeper has settled by {settlement:.2} m, more than the thickness of the ballast below it")
            }
            NodeError::BeyondLaw { law, found, bounds, .. } if found.force > bounds.force => write!(
                f,
                "a wheel loads a support by {:.1} kN, and law `{law}` was fitted up to {:.1} kN",
                found.force / 1e3,
                bounds.force / 1e3
            ),
            NodeError::BeyondLaw { law, found, bounds, .. } => write!(
                f,
                "the void under a sleeper is {:.2} mm, and law `{law}` was fitted up to {:.2} mm",
                found.void * 1e3,
                bounds.void * 1e3
            ),
            NodeError::Stopped => f.write_str("the run was stopped"),
            NodeError::Foreign { node, why } => write!(f, "the kept state of the {node} cannot be used: {why}"),
            NodeError::NoBuilder { node, kind } => {
                write!(f, "node `{node}` has kind `{kind}`, which this program cannot run")
            }
            NodeError::Other { node, why } => write!(f, "node `{node}`: {why}"),
        }
    }
}

impl std::error::Error for NodeError {}

impl From<TrackError> for NodeError {
    fn from(cause: TrackError) -> NodeError {
        NodeError::Track(cause)
    }
}

impl From<Failure> for NodeError {
    fn from(cause: Failure) -> NodeError {
        NodeError::Grains(cause)
    }
}

impl From<SoilError> for NodeError {
    fn from(cause: SoilError) -> NodeError {
        NodeError::Soil(cause)
    }
}

impl From<BedsError> for NodeError {
    fn from(cause: BedsError) -> NodeError {
        match cause {
            BedsError::Packing(PackingError::Stopped) => NodeError::Stopped,
            cause => NodeError::Packing(cause),
        }
    }
}

impl From<PackingError> for NodeError {
    fn from(cause: PackingError) -> NodeError {
        BedsError::Packing(cause).into()
    }
}

impl From<RigError> for NodeError {
    fn from(cause: RigError) -> NodeError {
        match cause {
            RigError::Stopped => NodeError::Stopped,
            cause => NodeError::Rig(cause),
        }
    }
}
