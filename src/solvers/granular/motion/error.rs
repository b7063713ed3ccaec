//! A number of a motion that is out of its range.

use std::fmt;

/// A number of a motion that is out of its range, and its valid range.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionError {
    pub name: &'static str,
    pub value: f64,
    pub expected: &'static str,
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {} {}, found {}", self.name, self.expected, self.value)
    }
}

impl std::error::Error for MotionError {}

pub(super) fn require(fine: bool, name: &'static str, value: f64, expected: &'static str) -> Result<(), MotionError> {
    if fine { Ok(()) } else { Err(MotionError { name, value, expected }) }
}
