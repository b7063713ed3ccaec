//! The kinds of results that are compared.

use std::fmt;

/// Type of the results in a directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Run,
    Tests,
    Study,
}

impl fmt::Display for Kind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Kind::Run => "a run",
            Kind::Tests => "tests of a rig",
            Kind::Study => "a study",
        })
    }
}
