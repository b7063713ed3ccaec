//! One exchange: the track after so many axles, and the passages of trains over it, each computed once.

use crate::graph::{Block, Runner};
use crate::nodes::{
    Forces, Kept, Load, NodeError, PassageOutcome, Request, StandingForces, Superstructure, TrackSystem, Unloaded,
};
use rayon::prelude::*;
use std::sync::OnceLock;

/// The track at an axle count.
pub(super) struct Exchange {
    pub axles: u64,
    /// Settlement of every seat, m.
    pub settlement: Vec<f64>,
    /// Passages that are recorded, one of each kind of train, the leading one first; empty if nothing is.
    shown: Vec<Runner>,
    pub unloaded: Option<Unloaded>,
    /// In the order of the kinds of trains, forward before backward.
    passages: Vec<(Runner, PassageOutcome)>,
    /// Forces of standing bogies on its settlement, from the first time that a block asks for them.
    standing: OnceLock<StandingForces>,
}

impl Exchange {
    /// The settled track, before any train runs over it. The passages `shown` are recorded.
    pub fn new(axles: u64, settlement: Vec<f64>, shown: Vec<Runner>) -> Self {
        Exchange { axles, settlement, shown, unloaded: None, passages: Vec::new(), standing: OnceLock::new() }
    }

    /// Computes the missing passages, all at once, with the forces that the ground needs.
    pub fn ensure(&mut self, track: &impl Superstructure, runners: &[Runner], forces: Forces) -> Result<(), NodeError> {
        let missing: Vec<Runner> = runners.iter().copied().filter(|runner| self.passage(*runner).is_none()).collect();
        let run = |runner: &Runner| {
            let kept = match self.shown.iter().position(|shown| shown == runner) {
                Some(0) => Kept::Profile,
                Some(_) => Kept::Histories,
                None => Kept::Nothing,
            };
            let (axles, settlement) = (self.axles, self.settlement.as_slice());
            track.passage(Request { axles, settlement, runner: *runner, kept, forces })
        };
        let done: Vec<Result<(Unloaded, PassageOutcome), NodeError>> = missing.par_iter().map(run).collect();
        for (runner, passage) in missing.into_iter().zip(done) {
            let (unloaded, passage) = passage?;
            // the same for all but the profile: no train stands on it
            if self.unloaded.is_none() || self.shown.first() == Some(&runner) {
                self.unloaded = Some(unloaded);
            }
            self.passages.push((runner, passage));
        }
        self.passages.sort_by_key(|(runner, _)| (runner.kind, runner.direction));
        Ok(())
    }

    /// Forces of standing bogies on its settlement.
    pub fn standing(&self, track: &TrackSystem<'_>, with_voids: bool) -> Result<&StandingForces, NodeError> {
        if let Some(known) = self.standing.get() {
            return Ok(known);
        }
        let forces = track.standing(&self.settlement, with_voids)?;
        Ok(self.standing.get_or_init(|| forces))
    }

    /// The passage of a runner, where it has been computed.
    pub fn passage(&self, runner: Runner) -> Option<&PassageOutcome> {
        self.passages.iter().find(|(other, _)| *other == runner).map(|(_, passage)| passage)
    }

    /// The passages that a record shows, with the track before them; `None` if nothing is recorded.
    pub fn recorded(&self) -> Option<(&Unloaded, Vec<(Runner, &PassageOutcome)>)> {
        let shown: Vec<(Runner, &PassageOutcome)> =
            self.shown.iter().filter_map(|runner| Some((*runner, self.passage(*runner)?))).collect();
        Some((self.unloaded.as_ref()?, shown)).filter(|(_, shown)| !shown.is_empty())
    }

    /// Cost of its passages.
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

    /// The trains of these blocks, one after the other, as loads of the ground with the forces computed here; those
    /// without a passage load nothing.
    pub fn loads(&self, blocks: &[Block]) -> Vec<Load<'_>> {
        let runs = blocks.iter().flat_map(|block| &block.runs);
        runs.filter_map(|(runner, trains)| Some(Load::new(self.passage(*runner)?, *trains))).collect()
    }
}

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Work {
    pub passages: u64,
    pub time_steps: u64,
    pub newton_iterations: u64,
}
