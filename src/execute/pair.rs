//! The track and the ground under it during the blocks: the operations that a block needs, independent of the control
//! of its length.

use super::exchange::Exchange;
use super::machine::RunError;
use crate::graph::{Block, Blocks, Clock, Control, Runner, TrackNode};
use crate::nodes::{
    CheckingCells, Even, Following, Forces, Joined, Load, NodeError, PassageOutcome, StandingForces, Substructure,
    Superstructure, TrackSystem,
};
use crate::solvers::settlement::Peak;
use crate::solvers::track::Direction::{Backward, Forward};
use std::ops::Range;
use std::sync::Arc;

/// Stretches of neighbouring seats that can settle.
pub(super) fn settling(track: &TrackNode) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, _) in track.seats.iter().enumerate().filter(|(_, seat)| seat.is_ballasted()) {
        match runs.last_mut() {
            Some(run) if run.end == i => run.end += 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

/// Trains of one kind and direction with forces that have followed the settlement since their passage.
#[derive(Clone)]
pub(super) struct Followed<'e> {
    passage: &'e PassageOutcome,
    /// Index by seat, then by wheel.
    peaks: Arc<[Vec<Peak>]>,
    trains: u64,
}

/// The same as loads of the ground.
pub(super) fn loads<'f>(followed: &'f [Followed<'_>]) -> Vec<Load<'f>> {
    let load = |one: &'f Followed<'_>| Load { followed: Some(&one.peaks), ..Load::new(one.passage, one.trains) };
    followed.iter().map(load).collect()
}

/// Runs of trains after so many axles, each with what runs ahead of it and behind it.
fn joined<'f>(blocks: &Blocks, axles: u64, loads: &[Load<'f>]) -> Vec<Load<'f>> {
    let mut ends = axles;
    let of_train = blocks.train.axles();
    let join = |load: &Load<'f>| {
        let begins = ends;
        ends += of_train * load.trains;
        Load { joined: Joined { ahead: !blocks.is_gap(begins), behind: !blocks.is_gap(ends) }, ..*load }
    };
    loads.iter().map(join).collect()
}

/// A track on its ground.
pub(super) struct Pair<'a> {
    pub blocks: &'a Blocks,
    pub track: TrackSystem<'a>,
    pub ground: Box<dyn Substructure + 'a>,
    /// Cells of grains that get the same trains as the ground.
    pub check: Option<CheckingCells<'a>>,
    pub control: Control,
    /// Stretches of neighbouring seats that can settle.
    pub runs: Vec<Range<usize>>,
}

impl Pair<'_> {
    /// The track after so many axles on this settlement (m), with the passages that the next block is expected to need.
    pub fn arrive(&self, axles: u64, settlement: Vec<f64>) -> Result<Exchange, RunError> {
        let due = self.blocks.due(axles, self.expected(axles));
        let mut exchange = Exchange::new(axles, settlement, due.shown);
        self.ensure(&mut exchange, &due.passages)?;
        Ok(exchange)
    }

    /// Trains that the next block is expected to have at most.
    pub fn expected(&self, axles: u64) -> u64 {
        let wanted = self.blocks.wanted(axles).map(|wanted| self.control.bounded(wanted));
        wanted.unwrap_or_else(|| self.blocks.trains_left(axles))
    }

    /// The forces of a passage that ground and cells need.
    pub fn forces(&self) -> Forces {
        if self.check.is_some() { Forces::Histories } else { self.ground.forces() }
    }

    pub fn ensure(&self, exchange: &mut Exchange, runners: &[Runner]) -> Result<(), RunError> {
        let clock = Clock::Axles(exchange.axles);
        let done = exchange.ensure(&self.track, runners, self.forces());
        done.map_err(|cause| RunError::node(clock, cause))
    }

    /// The settlement of every seat that these loads would leave, m.
    pub fn predict(&self, axles: u64, loads: &[Load<'_>]) -> Result<Vec<f64>, RunError> {
        self.ground.predict(loads).map_err(|cause| RunError::node(Clock::Axles(axles), cause))
    }

    /// Lets the trains of a block pass in thought, after those of `before`: in steps, with the forces of an exchange
    /// that follow the settlement as the forces of standing bogies do. All trains of a step meet the mean of the forces
    /// at its start and of those predicted for its end. Also returns the settlement of every seat after them, m.
    pub fn followed<'e>(
        &self,
        exchange: &'e Exchange,
        before: &[Followed<'e>],
        block: &Block,
    ) -> Result<(Vec<Followed<'e>>, Vec<f64>), RunError> {
        let at = |cause: NodeError| RunError::node(Clock::Axles(exchange.axles), cause);
        let with_voids = self.ground.sees_voids();
        let standing = |settlement: &[f64]| self.track.standing(settlement, with_voids).map_err(at);
        let reference = exchange.standing(&self.track, with_voids).map_err(at)?;
        let mut passed: Vec<Followed<'e>> = before.to_vec();
        let begun = self.predict(block.before, &loads(&passed))?;
        let mut here = if begun == exchange.settlement { reference.clone() } else { standing(&begun)? };
        for step in self.blocks.steps(block) {
            let with = |forces: &StandingForces| -> Result<Vec<Followed<'e>>, RunError> {
                let more = self.step_of(exchange, &step, [reference, forces]).map_err(at)?;
                Ok([passed.as_slice(), &more].concat())
            };
            let mut all = with(&here)?;
            if step.trains() > 1 {
                let end = standing(&self.predict(block.before, &loads(&all))?)?;
                all = with(&here.towards(&end, step.middle()))?;
                here = end;
            } else {
                here = standing(&self.predict(block.before, &loads(&all))?)?;
            }
            passed = all;
        }
        let settlement = self.predict(block.before, &loads(&passed))?;
        Ok((passed, settlement))
    }

    /// The trains of a step with the forces of an exchange, moved on from one set of standing forces to another.
    fn step_of<'e>(
        &self,
        exchange: &'e Exchange,
        step: &Block,
        from_to: [&StandingForces; 2],
    ) -> Result<Vec<Followed<'e>>, NodeError> {
        let runs = step.runs.iter().filter_map(|(runner, trains)| Some((runner, exchange.passage(*runner)?, *trains)));
        let one = |(runner, passage, trains): (&Runner, &'e PassageOutcome, u64)| {
            let peaks = self.track.follow(runner.kind, passage, from_to)?.into();
            Ok(Followed { passage, peaks, trains })
        };
        runs.map(one).collect()
    }

    /// Settlement of every seat, m.
    pub fn settlement(&self) -> Vec<f64> {
        self.ground.settlement()
    }

    /// Lets a block pass, after which the track stands on what the ground answers then. If the ground fails, its state
    /// does not change.
    pub fn advance(&mut self, axles: u64, loads: &[Load<'_>], follow: &mut Following<'_>) -> Result<(), RunError> {
        let loads = &joined(self.blocks, axles, loads);
        self.passing(axles, |ground| ground.advance_and_follow(loads, follow))?;
        self.check(axles, loads, follow)
    }

    /// The same for trains of one load, as long as the settlement of the seats is even. Returns the number of trains
    /// that have passed.
    pub fn advance_while(
        &mut self,
        axles: u64,
        load: &Load<'_>,
        even: &Even<'_>,
        follow: &mut Following<'_>,
    ) -> Result<u64, RunError> {
        let loads = joined(self.blocks, axles, std::slice::from_ref(load));
        let trains = self.passing(axles, |ground| ground.advance_while(&loads[0], even, follow))?;
        self.check(axles, &[Load { trains, ..loads[0] }], follow)?;
        Ok(trains)
    }

    /// Lets the ground do something after so many axles. If it fails, its state does not change.
    fn passing<T>(
        &mut self,
        axles: u64,
        step: impl FnOnce(&mut dyn Substructure) -> Result<T, NodeError>,
    ) -> Result<T, RunError> {
        let mark = self.ground.mark();
        step(self.ground.as_mut()).map_err(|cause| {
            self.ground.roll_back(mark);
            RunError::node(Clock::Axles(axles), cause)
        })
    }

    /// Lets the cells that check the ground do the same, and lets the track stand on what the ground answers.
    fn check(&mut self, axles: u64, loads: &[Load<'_>], follow: &mut Following<'_>) -> Result<(), RunError> {
        if let Some(check) = &mut self.check {
            check.advance(loads, follow).map_err(|cause| RunError::node(Clock::Axles(axles), cause))?;
        }
        self.stand(axles)
    }

    /// Lets the track take the responses of the ground.
    pub fn stand(&mut self, axles: u64) -> Result<(), RunError> {
        let stood = self.track.stand_on(self.ground.responses());
        stood.map_err(|cause| RunError::node(Clock::Axles(axles), cause))
    }

    /// Trains of a block of each kind, in a direction for which both exchanges have a passage.
    pub fn runs_of_both(&self, here: &Exchange, there: &Exchange, block: &Block) -> Vec<(Runner, u64)> {
        let mut runs: Vec<(Runner, u64)> = Vec::new();
        for kind in 0..=self.blocks.others.len() {
            let trains = block.runs.iter().filter(|(runner, _)| runner.kind == kind).map(|(_, trains)| trains).sum();
            let both = |runner: &Runner| here.passage(*runner).is_some() && there.passage(*runner).is_some();
            let runner = [Forward, Backward].into_iter().map(|direction| Runner { kind, direction }).find(both);
            runs.extend(runner.filter(|_| trains > 0).map(|runner| (runner, trains)));
        }
        runs
    }
}
