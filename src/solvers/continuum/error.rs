//! Errors of a soil, its boundaries and its steps.

use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum SoilError {
    /// An invalid property of a material; materials count from 0.
    Material { number: usize, what: &'static str, value: f64, expected: &'static str },
    /// An invalid number of the soil or of its settings.
    Value { what: &'static str, value: f64, expected: &'static str },
    /// The soil has no element.
    Empty,
    /// An element names a node or a material that does not exist.
    Missing { element: usize, what: &'static str, number: usize },
    /// A node belongs to no element.
    Loose { node: usize },
    /// An element without volume, or turned inside out.
    Turned { element: usize, volume: f64 },
    /// Grid lines must increase.
    Lines { axis: usize, at: usize },
    /// No face of an element lies on that side of the soil.
    NoFace { side: &'static str },
    /// A step beyond the limit \[s\].
    Step { dt: f64, limit: f64 },
    /// The motion of a node is not a finite number.
    Lost { node: usize, step: u64 },
    /// The boundaries allow the soil to move as a whole.
    NotHeld,
    /// The factor of the stiffness matrix does not fit into memory.
    TooLarge { unknowns: usize },
    /// No state of rest of plastic soil was found; `left` is the share of the load out of balance after the iterations.
    NoRest { iterations: usize, left: f64 },
    /// A state that belongs to another soil.
    OtherSoil { what: &'static str, expected: usize, found: usize },
}

impl fmt::Display for SoilError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SoilError::Material { number, what, value, expected } => {
                write!(f, "soil material {number}: expected {what} to be {expected}, found {value}")
            }
            SoilError::Value { what, value, expected } => write!(f, "expected {what} to be {expected}, found {value}"),
            SoilError::Empty => f.write_str("the soil has no element"),
            SoilError::Missing { element, what, number } => {
                write!(f, "soil element {element} names {what} {number}, which does not exist")
            }
            SoilError::Loose { node } => write!(f, "node {node} of the soil belongs to no element"),
            SoilError::Turned { element, volume } => write!(
                f,
                "soil element {element} is turned inside out or too distorted (its volume is {volume:.3e} m^3); number its four lower nodes counterclockwise, seen from above, then its four upper nodes"
            ),
            SoilError::Lines { axis, at } => {
                write!(
                    f,
                    "the coordinates of the grid lines of the soil along {} must increase; line {at} does not",
                    ["x", "y", "z"][*axis]
                )
            }
            SoilError::NoFace { side } => write!(f, "no face of a soil element lies on the side {side}"),
            SoilError::Step { dt, limit } => write!(
                f,
                "the time step of {dt:.3e} s is above the limit of the soil, {limit:.3e} s; take a shorter step or larger elements"
            ),
            SoilError::Lost { node, step } => write!(
                f,
                "the motion of node {node} of the soil is not a finite number in step {step}; the forces on the node are not finite or grow without bound"
            ),
            SoilError::NotHeld => f.write_str(
                "the soil has no state of rest because it can move as a whole; fix a face or put a face on rollers",
            ),
            SoilError::TooLarge { unknowns } => write!(
                f,
                "the factored stiffness matrix of the soil ({unknowns} unknowns) does not fit into memory; take larger elements or a shorter box"
            ),
            SoilError::NoRest { iterations, left } => write!(
                f,
                "no state of rest of the soil was found: after {iterations} iterations a share of {:.2e} of the load is out of balance; the load is near or above the bearing capacity",
                left
            ),
            SoilError::OtherSoil { what, expected, found } => {
                write!(f, "this state belongs to another soil: it has {found} {what}, the soil has {expected}")
            }
        }
    }
}

impl std::error::Error for SoilError {}

pub(super) fn number(what: &'static str, value: f64) -> Result<(), SoilError> {
    if value.is_finite() { Ok(()) } else { Err(SoilError::Value { what, value, expected: "a number" }) }
}

pub(super) fn within(what: &'static str, value: f64, fine: bool, expected: &'static str) -> Result<(), SoilError> {
    if fine && value.is_finite() { Ok(()) } else { Err(SoilError::Value { what, value, expected }) }
}
