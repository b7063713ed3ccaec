//! Tasks: bodies that lie together in memory, with their contacts; one thread computes a task.

/// Bodies of one task. The number is fixed, so that the number of threads does not change the results.
pub(super) const TASK: usize = 512;

/// First indices of a task: bodies, pebbles, clumps, blocks of contacts, and groups of pebbles.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Task {
    pub body: u32,
    pub pebble: u32,
    pub clump: u32,
    pub block: u32,
    pub group: u32,
}
