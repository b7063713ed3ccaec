//! A passage from its start to its finish: steps of one length or of a ladder, each shown to an observer.

use super::counters::Counters;
use super::error::TrackError;
use super::passage::Passage;
use super::view::{Observer, StepView};

impl Passage<'_> {
    /// The present state.
    pub fn view(&self) -> StepView<'_> {
        StepView { passage: self }
    }

    /// Runs to the finish; `observer` gets the start and every step.
    pub fn run(&mut self, observer: &mut impl Observer) -> Result<Counters, TrackError> {
        observer.observe(&self.view());
        while self.tick < self.planned_ticks {
            self.step()?;
            observer.observe(&self.view());
        }
        Ok(self.counters)
    }

    /// One time step; after an error the state must not be used.
    ///
    /// Fails if the contacts do not converge, or if a value is beyond its limit.
    pub fn step(&mut self) -> Result<(), TrackError> {
        match self.choice.take() {
            Some(mut choice) => {
                let outcome = self.chosen_step(&mut choice);
                self.choice = Some(choice);
                outcome
            }
            None => self.step_once(),
        }
    }
}
