//! What a person who waits answers to a word of how far a bed is: go on, or stop.

use std::ops::ControlFlow;

/// The answer of a function that hears how far a bed is. One that answers nothing lets it go on.
pub trait Answer {
    /// A break ends the work on the bed, which is lost.
    fn flow(self) -> ControlFlow<()>;
}

impl Answer for () {
    fn flow(self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl Answer for ControlFlow<()> {
    fn flow(self) -> ControlFlow<()> {
        self
    }
}

/// Fails with an error where the answer was to stop.
pub(super) fn unless_stopped<E>(answer: ControlFlow<()>, stopped: E) -> Result<(), E> {
    match answer {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(stopped),
    }
}
