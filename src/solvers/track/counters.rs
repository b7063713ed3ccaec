//! The computing effort of a passage.

/// The computing effort of a passage so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    pub steps: usize,
    /// Newton iterations of the contacts.
    pub iterations: usize,
    /// The most iterations of one step.
    pub most_iterations: usize,
    /// The most supports of one step that were not closed.
    pub most_open_supports: usize,
    /// Steps that were taken back and replaced by shorter steps.
    pub rejected: usize,
    /// Steps kept although their error was above the tolerance, because the ladder has no shorter step.
    pub beyond_tolerance: usize,
}
