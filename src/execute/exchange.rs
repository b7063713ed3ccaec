//! One exchange: the track as it lies after so many axles, and the passages of trains over it, each computed once.

use super::substructure::Substructure;
use super::system::{Kept, TrackSystem};
use super::track::{PassageOutcome, Unloaded};
use super::{Block, Runner};
use crate::scenario::Direction;
use crate::solvers::track::TrackError;
use rayon::prelude::*;

/// The track at an axle count.
pub(super) struct Exchange {
    pub axles: u64,
    /// Of every seat, m.
    pub settlement: Vec<f64>,
    /// Passages that are recorded, one of each kind of train, the leading one first; empty where nothing is.
    shown: Vec<Runner>,
    pub unloaded: Option<Unloaded>,
    /// In the order of the kinds of trains, forward before backward.
    passages: Vec<(Runner, PassageOutcome)>,
}

impl Exchange {
    /// The settled track, before any train runs over it. The passages `shown` are recorded.
    pub fn new(axles: u64, settlement: Vec<f64>, shown: Vec<Runner>) -> Self {
        Exchange { axles, settlement, shown, unloaded: None, passages: Vec::new() }
    }

    /// Computes the passages that are missing, all at once.
    pub fn ensure(&mut self, system: &TrackSystem<'_>, runners: &[Runner]) -> Result<(), TrackError> {
        let missing: Vec<Runner> = runners.iter().copied().filter(|runner| self.of(*runner).is_none()).collect();
        let run = |runner: &Runner| {
            let kept = match self.shown.iter().position(|shown| shown == runner) {
                Some(0) => Kept::Profile,
                Some(_) => Kept::Histories,
                None => Kept::Nothing,
            };
            system.passage(self.axles, &self.settlement, *runner, kept)
        };
        let done: Vec<Result<(Unloaded, PassageOutcome), TrackError>> = missing.par_iter().map(run).collect();
        for (runner, passage) in missing.into_iter().zip(done) {
            let (unloaded, passage) = passage?;
            // the same for all but the profile: no train stands on it
            if self.unloaded.is_none() || self.shown.first() == Some(&runner) {
                self.unloaded = Some(unloaded);
            }
            self.passages.push((runner, passage));
        }
        self.passages.sort_by_key(|(runner, _)| (runner.kind, runner.direction == Direction::Backward));
        Ok(())
    }

    /// A passage, where it has been computed.
    pub fn of(&self, runner: Runner) -> Option<&PassageOutcome> {
        self.passages.iter().find(|(of, _)| *of == runner).map(|(_, passage)| passage)
    }

    /// The passages that a record shows, with the track before them; `None` where nothing is recorded.
    pub fn recorded(&self) -> Option<(&Unloaded, Vec<(Runner, &PassageOutcome)>)> {
        let shown: Vec<(Runner, &PassageOutcome)> =
            self.shown.iter().filter_map(|runner| Some((*runner, self.of(*runner)?))).collect();
        Some((self.unloaded.as_ref()?, shown)).filter(|(_, shown)| !shown.is_empty())
    }

    /// What its passages took.
    pub fn work(&self) -> Work {
        self.passages().fold(Work::default(), |work, passage| Work {
            passages: work.passages + 1,
            time_steps: work.time_steps + passage.time_steps,
            newton_iterations: work.newton_iterations + passage.newton_iterations,
        })
    }

    pub fn passages(&self) -> impl Iterator<Item = &PassageOutcome> {
        self.passages.iter().map(|(_, passage)| passage)
    }

    /// What the substructure becomes when the trains of these blocks pass one after the other with the forces computed here;
    /// those without a passage settle nothing.
    pub fn load<'a>(&self, from: &Substructure<'a>, blocks: &[Block]) -> Substructure<'a> {
        let mut loaded = from.clone();
        for (runner, count) in blocks.iter().flat_map(|block| &block.runs) {
            if let Some(passage) = self.of(*runner) {
                loaded.load(&passage.peaks, *count);
            }
        }
        loaded
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Work {
    pub passages: u64,
    pub time_steps: u64,
    pub newton_iterations: u64,
}
