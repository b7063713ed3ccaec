//! Results side by side: differences between runs, tests or studies, and between their scenes.
//!
//! [`Comparison::read`] takes their directories; the first one is what the others are compared with. Values are SI. A
//! difference of means over packings has a 95 % interval: of the differences seed by seed where both ran on the same
//! seeds, else Welch's.

mod error;
mod json;
mod kind;
mod made;
mod names;
mod numbers;
mod points;
mod sample;
mod scenes;
mod seats;
mod study_table;
mod subject;
mod tables;

pub use error::CompareError;
pub use kind::Kind;
pub use made::Made;
pub use numbers::{Number, NumberRow, is_named, numbers};
pub use points::{PointRow, points};
pub use sample::{Difference, Sample};
pub use scenes::{Edit, edits};
pub use seats::{Column, SeatDifference, seat_differences};
pub use study_table::{StudyPoint, StudyTable};
pub use subject::{Content, Subject};

use std::path::PathBuf;

/// Directories of one kind, read.
#[derive(Debug)]
pub struct Comparison {
    pub kind: Kind,
    /// The first is what the others are compared with.
    pub subjects: Vec<Subject>,
    /// Differences between their scenes; `None` if an older version did not store the whole scene.
    pub edits: Option<Vec<Edit>>,
    /// Scalars of runs and tests.
    pub numbers: Vec<NumberRow>,
    /// Largest differences along the track, of runs.
    pub seats: Vec<SeatDifference>,
    /// Points of studies.
    pub points: Vec<PointRow>,
}

impl Comparison {
    /// Reads two directories or more. Fails if one holds no finished results, or not of the kind of the first.
    pub fn read(directories: &[PathBuf]) -> Result<Comparison, CompareError> {
        let subjects: Vec<Subject> =
            names::of_paths(directories).into_iter().zip(directories).map(Subject::read).collect::<Result<_, _>>()?;
        let first = subjects.first().ok_or(CompareError::Alone)?;
        if subjects.len() < 2 {
            return Err(CompareError::Alone);
        }
        let kind = first.kind();
        if let Some(other) = subjects.iter().find(|other| other.kind() != kind) {
            let named = |subject: &Subject| (subject.path.clone(), subject.kind());
            return Err(CompareError::Kinds { first: named(first), other: named(other) });
        }
        let (numbers, seats, points) = (numbers(&subjects), seat_differences(&subjects), points(&subjects));
        Ok(Comparison { kind, edits: edits(&subjects), numbers, seats, points, subjects })
    }
}
