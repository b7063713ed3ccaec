//! Provenance of a result: its scene, its seed and the program.

use crate::results::Summary;

/// Provenance of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    pub title: String,
    pub version: String,
    pub file: String,
    pub sha256: String,
    pub seed: Option<u64>,
}

impl Made {
    pub(super) fn of_summary(title: &str, summary: &Summary) -> Made {
        let made = &summary.provenance;
        Made {
            title: title.to_owned(),
            version: made.version.clone(),
            file: made.file.clone(),
            sha256: made.source_sha256.clone(),
            seed: Some(made.seed),
        }
    }
}
