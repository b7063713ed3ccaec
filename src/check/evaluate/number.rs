//! Numbers: results of arithmetic, and values of fields.

use crate::diag::Span;
use crate::units::Dimension;

/// An evaluated number, before it is checked against a field.
#[derive(Debug, Clone)]
pub struct Raw {
    pub value: f64,
    pub dimension: Dimension,
    /// The name after `per`, and its place.
    pub basis: Option<(String, Span)>,
    /// The place of its literal, even behind a `let`.
    pub span: Span,
    /// A literal without a unit; perhaps the unit was forgotten.
    pub bare: bool,
}

impl Raw {
    /// Its basis.
    pub(super) fn basis_name(&self) -> Option<&str> {
        self.basis.as_ref().map(|(name, _)| name.as_str())
    }

    /// `a stiffness per seat`
    pub fn describe(&self) -> String {
        match self.basis_name() {
            Some(basis) => format!("{} per {basis}", self.dimension.describe()),
            None => self.dimension.describe(),
        }
    }
}

impl From<Raw> for Number {
    fn from(raw: Raw) -> Number {
        Number { value: raw.value, dimension: raw.dimension, basis: None, factor: 1.0 }
    }
}

/// A number in SI as written, with its basis.
#[derive(Debug, Clone, Copy)]
pub struct Number {
    pub value: f64,
    pub dimension: Dimension,
    pub basis: Option<&'static str>,
    /// Factor from the basis to one rail.
    pub factor: f64,
}

impl Number {
    /// The value of one rail, SI.
    pub fn of_rail(self) -> f64 {
        self.value * self.factor
    }
}
