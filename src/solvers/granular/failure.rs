//! Why a run cannot continue: the limits that it must keep, and the message if it breaks one.

use super::body::BodyId;
use super::fault::Fault;
use super::search::CellTooSmall;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Limits that stop a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Largest overlap, divided by the smaller radius.
    pub overlap: f64,
    /// Largest displacement of a pebble in one step, divided by its radius.
    pub stride: f64,
    /// Number of steps between checks of overlaps and of bodies that reverse their motion.
    pub every: u64,
    /// Whether a run stops if its step is above the limit of its contacts and a body reverses its motion in every step.
    pub growth: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { overlap: 0.2, stride: 0.1, every: 64, growth: true }
    }
}

/// Why a run cannot continue.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// No time step has been set.
    NoTimeStep,
    /// A value in the bed is invalid; nothing was moved.
    Fault(Fault),
    /// The state of a body is not a finite number.
    Lost(Culprit),
    /// A body moves too far in one step.
    Stride { culprit: Culprit, share: f64 },
    /// Two bodies overlap too much.
    Overlap { culprit: Culprit, share: f64 },
    /// A body reverses its motion in every step, and the step is above the limit of the contacts.
    Growth(Culprit),
    /// Neighbours more than one cell apart: a period or a bay is too short for its bodies.
    CellTooSmall,
}

/// The body at which a failure was found, and a stable time step.
#[derive(Debug, Clone, PartialEq)]
pub struct Culprit {
    pub body: BodyId,
    /// \[m\]
    pub place: [f64; 3],
    pub step: u64,
    pub time: f64,
    pub dt: f64,
    /// A stable time step \[s\]: the present limit of the contact network if growth was found, otherwise the limit
    /// before the failure.
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
