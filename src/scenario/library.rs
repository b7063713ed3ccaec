//! Entries of the standard library that a scene uses, and the reliability of their data.

use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// An entry of the standard library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LibraryEntry {
    /// Name with its module: `pads.medium`.
    pub name: String,
    /// Source of its data.
    pub source: String,
    pub evidence: Evidence,
    /// Place in the text that names it; `None` for a default.
    pub span: Option<Span>,
}

/// How the data of an entry was obtained.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Evidence {
    /// Taken from the source.
    Read,
    /// Computed from other data.
    Derived,
    /// Common knowledge; to be checked before use.
    Unchecked,
}
