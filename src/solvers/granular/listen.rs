//! The answer of a caller to a progress report: continue or stop.

use std::ops::ControlFlow;

/// The answer of a function that receives progress reports. A function that returns nothing lets the work continue.
pub trait Answer {
    /// A break ends the work on the bed; the work done is lost.
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

/// Fails with an error if the answer was to stop.
pub(super) fn unless_stopped<E>(answer: ControlFlow<()>, stopped: E) -> Result<(), E> {
    match answer {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(stopped),
    }
}
