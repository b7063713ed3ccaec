//! What a passage costs.

/// What a passage has cost so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    pub steps: usize,
    /// Newton iterations of the contacts.
    pub iterations: usize,
    /// The most iterations of one step.
    pub most_iterations: usize,
    /// The most supports of one step that were not closed.
    pub most_open_supports: usize,
    /// Steps that were taken back for shorter ones.
    pub rejected: usize,
    /// Steps kept although their error was above the tolerance, as no shorter one was at hand.
    pub beyond_tolerance: usize,
}
