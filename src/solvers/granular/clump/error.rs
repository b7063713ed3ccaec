//! Why pebbles do not form a clump.

use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum TemplateError {
    NoPebbles,
    /// A radius (m) that is not a finite number above 0, or so far from 1 m that its fifth power is out of range.
    Radius {
        pebble: usize,
        radius: f64,
    },
    /// A centre that is not a finite number.
    Centre {
        pebble: usize,
    },
    /// A pebble inside another pebble: it adds no volume and cannot touch anything.
    Swallowed {
        pebble: usize,
        inside: usize,
    },
    /// A pebble that no chain of touching pebbles joins to the first one.
    Apart {
        pebble: usize,
    },
}

impl fmt::Display for TemplateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TemplateError::NoPebbles => write!(f, "a clump needs at least one pebble"),
            TemplateError::Radius { pebble, radius } => {
                write!(f, "expected a finite radius above 0 m, found {radius} m at pebble {pebble}")
            }
            TemplateError::Centre { pebble } => write!(f, "the centre of pebble {pebble} is not a finite number"),
            TemplateError::Swallowed { pebble, inside } => {
                write!(f, "pebble {pebble} lies inside pebble {inside}")
            }
            TemplateError::Apart { pebble } => write!(f, "pebble {pebble} is not connected to pebble 0"),
        }
    }
}

impl std::error::Error for TemplateError {}
