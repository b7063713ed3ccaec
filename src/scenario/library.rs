//! What of the standard library a scene uses, and how far it can be relied on.

use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// An entry of the standard library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LibraryEntry {
    /// With its module: `pads.medium`.
    pub name: String,
    /// Where its data comes from.
    pub source: String,
    pub evidence: Evidence,
    /// Where the scene names it; `None` for a default.
    pub span: Option<Span>,
}

/// How the data of an entry was taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Evidence {
    /// From its source.
    Read,
    /// Computed from other data.
    Derived,
    /// Common knowledge, to be checked before it is relied on.
    Unchecked,
}
