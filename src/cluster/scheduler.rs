//! The interface of a scheduler.

use super::{ClusterError, Request};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Tasks with consecutive numbers and the same request: one job of a scheduler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Array {
    /// Number of the first task.
    pub first: usize,
    pub count: usize,
    pub request: Request,
}

/// The state of a task in the scheduler.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum State {
    /// In the queue, with the reason.
    Waiting(String),
    Running,
    Ended(Ending),
}

/// The end of a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    Done,
    /// The program has failed.
    Failed,
    TimedOut,
    OutOfMemory,
    /// The machine failed, the task was preempted, or the scheduler no longer knows it.
    Lost,
    /// Cancelled by a user.
    Cancelled,
}

impl Ending {
    /// The end of the last attempt, as a verb.
    pub fn words(self) -> &'static str {
        match self {
            Ending::Done => "ended without a result",
            Ending::Failed => "failed",
            Ending::TimedOut => "exceeded its time limit",
            Ending::OutOfMemory => "exceeded its memory limit",
            Ending::Lost => "was lost with its machine",
            Ending::Cancelled => "was cancelled",
        }
    }
}

/// States of tasks, by the name of their job and their index in its array.
pub type States = BTreeMap<(String, usize), State>;

/// A program that starts tasks on other machines.
pub trait Scheduler {
    /// Submits tasks. Returns the name of their job.
    fn submit(&self, array: &Array) -> Result<String, ClusterError>;

    /// The states of its tasks. A task that the scheduler no longer knows is missing.
    fn states(&self) -> Result<States, ClusterError>;

    /// Largest number of tasks in an array.
    fn largest_array(&self) -> usize;

    /// Minutes of the longest task with the memory of a request; `None` if there is no limit.
    fn longest(&self, request: Request) -> Option<u64>;
}
