//! What is asked of a scheduler, whatever its name.

use super::{ClusterError, Request};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Tasks that follow each other by number and ask for the same: one job for a scheduler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Array {
    /// Number of the first task.
    pub first: usize,
    pub count: usize,
    pub request: Request,
}

/// What a scheduler says of a task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum State {
    /// In the queue, and why.
    Waiting(String),
    Running,
    Ended(Ending),
}

/// How a task has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    Done,
    /// Its program has failed.
    Failed,
    TimedOut,
    OutOfMemory,
    /// With its machine, or by another job that came first, or the scheduler does not know it any more.
    Lost,
    /// By a person.
    Cancelled,
}

impl Ending {
    /// What the last attempt did, as a verb.
    pub fn words(self) -> &'static str {
        match self {
            Ending::Done => "ended without a result",
            Ending::Failed => "failed",
            Ending::TimedOut => "took longer than it had asked for",
            Ending::OutOfMemory => "needed more memory than it had asked for",
            Ending::Lost => "was lost with its machine",
            Ending::Cancelled => "was cancelled",
        }
    }
}

/// States of tasks, by the name of their job and their place in its array.
pub type States = BTreeMap<(String, usize), State>;

/// A program that starts tasks on other machines.
pub trait Scheduler {
    /// Gives it tasks. Gives the name of their job.
    fn submit(&self, array: &Array) -> Result<String, ClusterError>;

    /// What it says of its tasks. One that it has forgotten is missing.
    fn states(&self) -> Result<States, ClusterError>;

    /// Most tasks of one array.
    fn largest_array(&self) -> usize;

    /// Minutes of the longest task that it takes with the memory of a request; `None` where it has no limit.
    fn longest(&self, request: Request) -> Option<u64>;
}
