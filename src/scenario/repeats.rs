//! Runs that differ only by their seed.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Number of runs that differ only by their seed: packings of the grains. In an open range the results decide how many
/// are run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Stored", into = "Stored")]
pub struct Repeats {
    pub least: u32,
    pub most: u32,
}

impl Repeats {
    pub const ONCE: Repeats = Repeats::times(1);

    pub const fn times(count: u32) -> Repeats {
        Repeats { least: count, most: count }
    }

    /// Whether there may be more than one run.
    pub fn are_several(&self) -> bool {
        self.most > 1
    }

    /// Whether the results decide how many are run.
    pub fn are_open(&self) -> bool {
        self.least < self.most
    }
}

/// The form in files: `5`, or `[3, 12]`.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Stored {
    Times(u32),
    Range([u32; 2]),
}

impl From<Stored> for Repeats {
    fn from(stored: Stored) -> Repeats {
        match stored {
            Stored::Times(count) => Repeats::times(count),
            Stored::Range([least, most]) => Repeats { least, most },
        }
    }
}

impl From<Repeats> for Stored {
    fn from(repeats: Repeats) -> Stored {
        match repeats.are_open() {
            true => Stored::Range([repeats.least, repeats.most]),
            false => Stored::Times(repeats.least),
        }
    }
}

/// `5`, `3 to 12`
impl fmt::Display for Repeats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.are_open() {
            true => write!(f, "{} to {}", self.least, self.most),
            false => write!(f, "{}", self.least),
        }
    }
}
