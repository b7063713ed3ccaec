//! Tasks: what a study or a run leaves to other processes, as plain data beside it.

use crate::check::Override;
use crate::store::{StoreError, Unfinished};
use crate::study::Runs;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What a process is given.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Task {
    Runs(Runs),
    Packings(Packings),
}

/// Packings of a run, which any process that sees the run's directory can compute.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Packings {
    /// The file of the scene.
    pub scene: PathBuf,
    pub set: Vec<Override>,
    /// Passes that are left out.
    pub without: Vec<String>,
    /// Where packed beds are kept.
    pub cache: Option<PathBuf>,
    /// Whether results of another scene are replaced.
    pub force: bool,
    /// By how much their seeds are above that of the scene; 0 is the run itself.
    pub packings: Vec<u32>,
}

/// What the keys of tasks begin with.
const KEY: &str = "task-";

impl Task {
    /// Names a task among the pieces of work.
    pub fn key(number: usize) -> String {
        format!("{KEY}{number}")
    }

    /// The numbers of all tasks, in their order.
    pub fn numbers(state: &Unfinished) -> Result<Vec<usize>, StoreError> {
        let keys = state.keys()?;
        let mut numbers: Vec<usize> = keys.iter().filter_map(|key| key.strip_prefix(KEY)?.parse().ok()).collect();
        numbers.sort_unstable();
        Ok(numbers)
    }

    /// A task by its number; `None` where there is none.
    pub fn read(state: &Unfinished, number: usize) -> Result<Option<Task>, StoreError> {
        let Some(bytes) = state.kept(&Task::key(number))? else { return Ok(None) };
        serde_json::from_slice(&bytes).map(Some).map_err(|cause| StoreError::damaged(state.path(), cause))
    }
}
