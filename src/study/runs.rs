//! Runs of a study as plain data, which any process with access to the study's directory can compute.

use super::{PlannedPoint, Repeat};
use crate::check::Override;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Some runs of a study, for one process.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Runs {
    /// The file of the scene.
    pub scene: PathBuf,
    /// Edits of every run, from the command line.
    pub set: Vec<Override>,
    /// The study by its name in that file.
    pub study: String,
    /// The folder of packed beds.
    pub cache: Option<PathBuf>,
    pub runs: Vec<TaskRun>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TaskRun {
    /// Its name in messages: `point 12`.
    pub name: String,
    /// Names it among the pieces of the study.
    pub key: String,
    pub overrides: Vec<Override>,
}

impl TaskRun {
    pub fn new(point: &PlannedPoint, repeat: u32) -> TaskRun {
        let further = if repeat > 0 { format!(", run {}", repeat + 1) } else { String::new() };
        let name = if point.number == 0 { "the scene as it is".into() } else { format!("point {}", point.number) };
        TaskRun { name: name + &further, key: point.key(repeat), overrides: point.overrides_of(repeat) }
    }
}

impl Repeat {
    /// The stored run.
    pub fn bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        serde_json::to_vec_pretty(self).map(|mut text| {
            text.push(b'\n');
            text
        })
    }
}
