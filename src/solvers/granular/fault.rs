//! Invalid values of a bed: a number out of its range, and the part that it belongs to.

use super::body::BodyId;
use super::motion::MotionError;
use super::shape::ShapeError;
use super::walls::WallId;
use std::fmt;

pub(super) const POSITIVE: &str = "a number above 0";
pub(super) const NOT_NEGATIVE: &str = "a number from 0";
const NUMBER: &str = "a number";

/// A number out of its range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    pub of: Subject,
    pub quantity: &'static str,
    pub value: f64,
    pub expected: &'static str,
}

/// The part that a fault belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    Body(BodyId),
    Wall(WallId),
    /// The law of two surfaces.
    ContactLaw(u16, u16),
    /// The domain, gravity, the time step and other settings.
    Bed,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.of {
            Subject::Body(id) => write!(f, "body {}: ", id.0)?,
            Subject::Wall(id) => write!(f, "wall {}: ", id.0)?,
            Subject::ContactLaw(a, b) => write!(f, "law of surfaces {a} and {b}: ")?,
            Subject::Bed => {}
        }
        write!(f, "expected {} to be {}, found {}", self.quantity, self.expected, self.value)
    }
}

impl std::error::Error for Fault {}

impl Subject {
    pub(super) fn want(
        self,
        fine: bool,
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    ) -> Result<(), Fault> {
        if fine { Ok(()) } else { Err(Fault { of: self, quantity, value, expected }) }
    }

    pub(super) fn positive(self, quantity: &'static str, value: f64) -> Result<(), Fault> {
        self.want(value.is_finite() && value > 0.0, quantity, value, POSITIVE)
    }

    pub(super) fn numbers(self, quantity: &'static str, values: &[f64]) -> Result<(), Fault> {
        values.iter().try_for_each(|&value| self.want(value.is_finite(), quantity, value, NUMBER))
    }

    pub(super) fn moves(self, MotionError { name, value, expected }: MotionError) -> Fault {
        Fault { of: self, quantity: name, value, expected }
    }

    pub(super) fn shape(self, error: ShapeError) -> Fault {
        let (quantity, value, expected) = match error {
            ShapeError::Normal { normal } => ("length of the normal", normal.norm(), "1"),
            ShapeError::HalfLength { half } => {
                let bad = half.iter().find(|h| !(h.is_finite() && **h > 0.0));
                ("half length of a block", bad.copied().unwrap_or(f64::NAN), POSITIVE)
            }
        };
        Fault { of: self, quantity, value, expected }
    }
}
