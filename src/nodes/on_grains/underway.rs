//! A block of trains under way: the data needed in addition to the motion, so that another process can continue.

use super::extremes::Seen;
use super::reading::Watched;
use super::recording::Recording;
use super::rest::{AFTER, Resting};
use super::step::LISTEN;
use super::{BedUnderTrack, Books, Live, Stage, tell_stage_and_state};
use crate::nodes::{NodeError, PassageOutcome, Unloaded};
use crate::solvers::track::LeapfrogState;
use serde::{Deserialize, Serialize};
use std::ops::{ControlFlow, Range};

/// Reports while trains pass.
pub enum Told<'a> {
    /// The stage, and the share of this stage that is done.
    Stage(Stage, f64),
    /// The beds as the leading bogie of a recorded train passes the sleepers beside the structure.
    Beds(Vec<BedUnderTrack<'a>>),
    /// A run can continue from here; the function returns the state.
    State(&'a dyn Fn() -> Result<serde_json::Value, NodeError>),
}

/// Gets the reports while trains pass. A break ends the run.
pub type Following<'a> = dyn FnMut(Told<'_>) -> ControlFlow<()> + 'a;

impl Told<'_> {
    /// The same, as one part of several.
    pub(super) fn of_part(self, part: u64, parts: u64) -> Self {
        match self {
            Told::Stage(stage, share) => Told::Stage(stage, (part as f64 + share) / parts.max(1) as f64),
            state => state,
        }
    }
}

/// A block that has begun and is not done. Its trains come in runs: of one kind, in one direction, with one passage of
/// the plane track.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Underway {
    /// The books at the start of the block: other nodes get these values until the block is done.
    pub began: Books,
    /// Runs that are done, and passages of the run under way.
    pub runs: usize,
    pub passages: u64,
    /// Steps of the passage under way; not 0 until it is at rest after it.
    pub step: u64,
    /// The way to rest after the passage, once its trains have gone.
    pub resting: Option<Resting>,
    /// Settlement of every seat before the run under way, m.
    pub before: Vec<f64>,
    /// Each carried foot in the passage under way.
    pub watched: Vec<Watched>,
    /// Vehicles that ride on the rail of this model.
    pub ride: Option<RideUnderway>,
    /// Volumes in the first passage, where it is recorded.
    pub recording: Option<Recording>,
}

/// Data of vehicles that ride in a block under way.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct RideUnderway {
    /// The track as the block began.
    pub unloaded: Unloaded,
    /// The first passage of each run that is done, and of the one under way.
    pub outcomes: Vec<PassageOutcome>,
    pub first: Option<PassageOutcome>,
    /// Time of the rail as the passage under way began, s.
    pub since: f64,
    pub seen: Seen,
    /// Whether vehicles are on the rail.
    pub on_rail: bool,
    /// Whether the passage under way has its result, and the springs beyond the grains have settled by it.
    pub has_settled: bool,
    /// Motion of rail and vehicles, if it was stored in the middle of a passage. The vehicles must exist before the
    /// motion is restored.
    #[serde(skip)]
    pub motion: Option<LeapfrogState>,
}

impl RideUnderway {
    /// No vehicle has come yet.
    pub fn new(unloaded: Unloaded) -> RideUnderway {
        let (outcomes, first, motion) = (Vec::new(), None, None);
        RideUnderway {
            unloaded,
            outcomes,
            first,
            since: 0.0,
            seen: Seen::default(),
            on_rail: false,
            has_settled: false,
            motion,
        }
    }
}

impl Live {
    /// The block of trains under way; begins one where there is none.
    pub(super) fn block(&mut self) -> &mut Underway {
        let books = &self.books;
        self.underway.get_or_insert_with(|| Underway {
            began: books.clone(),
            runs: 0,
            passages: 0,
            step: 0,
            resting: None,
            before: books.settlement.clone(),
            watched: Vec::new(),
            ride: None,
            recording: None,
        })
    }

    /// Ends a run of trains, so many of them.
    pub fn end_of_run(&mut self, trains: u64) {
        let Some(underway) = &mut self.underway else { return };
        let before = std::mem::replace(&mut underway.before, self.books.settlement.clone());
        (underway.runs, underway.passages) = (underway.runs + 1, 0);
        self.note_rate(&before, trains);
    }

    /// The values of the ground that other nodes get.
    pub fn told(&self) -> &Books {
        self.underway.as_ref().map_or(&self.books, |underway| &underway.began)
    }

    /// The next steps of a passage of so many, of `all` with those to rest. Tells the state before them.
    pub fn next_steps(
        &self,
        from: u64,
        (steps, all): (u64, u64),
        follow: &mut Following<'_>,
    ) -> Result<Range<u64>, NodeError> {
        let share = from as f64 / all.max(1) as f64;
        tell_stage_and_state((Stage::Passage, share), &|| self.save(), follow)?;
        Ok(from..steps.min(from + LISTEN))
    }

    /// Comes to rest after a passage, or goes on with it. So many steps of the passage are `done`, of `all` with those
    /// to rest.
    pub(super) fn come_to_rest(
        &mut self,
        (done, all): (u64, u64),
        follow: &mut Following<'_>,
    ) -> Result<(), NodeError> {
        let begun = self.block().resting.take();
        let begun = begun.map_or_else(|| self.coupled.begin_rest(), Ok)?;
        let mut steps = begun.steps;
        self.block().resting = Some(begun);
        loop {
            let share = (done + steps) as f64 / all.max(1) as f64;
            tell_stage_and_state((Stage::Passage, share), &|| self.save(), follow)?;
            let Live { coupled, underway, .. } = self;
            let Some(underway) = underway else { return Ok(()) };
            let Some(resting) = &mut underway.resting else { return Ok(()) };
            if coupled.go_to_rest(resting, AFTER)? {
                underway.resting = None;
                return Ok(());
            }
            steps = resting.steps;
        }
    }
}
