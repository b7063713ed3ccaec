//! A value with its origin.

use crate::diag::Span;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// The origin of a value of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// A literal in one of the user's files.
    Written(Span),
    /// A literal in the standard library.
    Library(Span),
    /// A default of the schema.
    Default,
    /// Computed from other values of the scene.
    Derived,
}

impl Origin {
    /// The place in the text, if there is one.
    pub fn span(self) -> Option<Span> {
        match self {
            Origin::Written(span) | Origin::Library(span) => Some(span),
            Origin::Default | Origin::Derived => None,
        }
    }
}

/// A value in SI units and its origin. It dereferences to the bare value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Given<T = f64> {
    pub value: T,
    pub origin: Origin,
}

impl<T> Given<T> {
    pub fn derived(value: T) -> Self {
        Given { value, origin: Origin::Derived }
    }
}

impl<T> Deref for Given<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}
