//! Why a run cannot go on: the bounds that it must keep, and what is said when it breaks one.

use super::body::BodyId;
use super::fault::Fault;
use super::search::CellTooSmall;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Bounds that stop a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Overlap over the smaller radius.
    pub overlap: f64,
    /// Way of a pebble in one step over its radius.
    pub stride: f64,
    /// Steps between looks at overlaps and at bodies that turn round.
    pub every: u64,
    /// Whether a run stops where its step is above the limit of its contacts and a body turns round in every step.
    pub growth: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { overlap: 0.2, stride: 0.1, every: 64, growth: true }
    }
}

/// Why a run cannot go on.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// No time step has been set.
    NoTimeStep,
    /// Something in the bed cannot be; nothing was moved.
    Fault(Fault),
    /// The state of a body is no number any more.
    Lost(Culprit),
    /// A body goes too far in a step.
    Stride { culprit: Culprit, share: f64 },
    /// Two bodies are too deep in each other.
    Overlap { culprit: Culprit, share: f64 },
    /// A body turns round in every step, and the step is above the limit of the contacts.
    Growth(Culprit),
    /// Neighbours more than one cell apart: a period or a bay is too short for its bodies.
    CellTooSmall,
}

/// The body at which a failure showed, and what would have been stable.
#[derive(Debug, Clone, PartialEq)]
pub struct Culprit {
    pub body: BodyId,
    /// \[m\]
    pub place: [f64; 3],
    pub step: u64,
    pub time: f64,
    pub dt: f64,
    /// A stable time step \[s\]: the limit of the network of contacts now where growth was found, else when all was well.
    pub stable_dt: f64,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Failure::NoTimeStep => write!(f, "no time step has been set; take 0.9 times the limit of the contacts"),
            Failure::Fault(fault) => fault.fmt(f),
            Failure::CellTooSmall => {
                write!(f, "a period or bay is too short for its bodies; make it longer than twice the largest body")
            }
            Failure::Lost(c) => write!(f, "the motion of {c} is not a finite number{}", c.advice()),
            Failure::Stride { culprit, share } => {
                write!(f, "{culprit} moves by {share:.2} of its radius in one step{}", culprit.advice())
            }
            Failure::Overlap { culprit, share } => {
                write!(f, "{culprit} overlaps its neighbour by {share:.2} of the smaller radius{}", culprit.advice())
            }
            Failure::Growth(c) => write!(f, "{c} reverses its motion in every step{}", c.advice()),
        }
    }
}

impl std::error::Error for Failure {}

impl fmt::Display for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.place;
        write!(f, "body {} at ({x:.4}, {y:.4}, {z:.4}) m, step {}, {:.4e} s", self.body.0, self.step, self.time)
    }
}

impl Culprit {
    fn advice(&self) -> String {
        let (dt, stable) = (self.dt, self.stable_dt);
        if dt > stable {
            format!(
                ": the time step of {dt:.3e} s is above the stable step of its contacts, {stable:.3e} s; take 0.9 times the stable step, or scale masses"
            )
        } else {
            format!(
                ": the time step of {dt:.3e} s is stable, so the load on the body or its first overlap is too large; start with less overlap, or load more slowly"
            )
        }
    }
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Failure {
        Failure::Fault(fault)
    }
}

impl From<CellTooSmall> for Failure {
    fn from(_: CellTooSmall) -> Failure {
        Failure::CellTooSmall
    }
}
