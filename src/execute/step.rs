//! One block: its length is prescribed by the scene, unless the exchange overshoots, or limited by its error.

use super::exchange::{Exchange, Work};
use super::machine::RunError;
use super::oscillation::{amplification, beside_neighbours, sawtooth};
use super::pair::{Pair, loads};
use crate::graph::{Block, UNEVEN};
use crate::nodes::{Bonds, Following, Load};
use std::ops::{ControlFlow, Range};

/// Accuracy and cost of the exchange of a block.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BlockMeasures {
    /// Estimate of the error of settlement that the block adds at the worst seat, m: the error from constant forces
    /// over the block (0 for a block of one train), and the error from trains that the ground does not compute.
    pub error: f64,
    /// Factor by which a disturbance of the settlement comes back with the opposite sign: above 1 the exchange
    /// overshoots, above 2 it grows. `None` if the track moved too evenly to tell.
    pub overshoot: Option<f64>,
    /// Sawtooth amplitude of the block's settlement along x, relative to its largest settlement.
    pub sawtooth: f64,
    /// Largest settlement of the block at a seat beside the mean of its two neighbours, relative to the largest
    /// displacement of the rail under a train: from about 1 a sleeper has lost or gained its load within the block. 0
    /// for a block of one train, for adaptive blocks, whose forces follow the settlement, and where nothing is
    /// exchanged.
    pub unevenness: f64,
    /// Longer blocks that were tried from the same start and rejected.
    pub rejected: u64,
    /// Number of rejected blocks that overshot.
    pub overshot: u64,
    /// Bonds of glued grains after it.
    pub bonds: Bonds,
    /// All passages for this block, including rejected blocks, and their work.
    pub passages: u64,
    pub time_steps: u64,
    pub newton_iterations: u64,
}

/// A block that has passed, and the exchange at its end where that has been computed.
pub(super) struct Done {
    pub block: Block,
    pub measured: BlockMeasures,
    pub next: Option<Exchange>,
}

/// Largest amplification at which a disturbance keeps its sign, and the target for a block that is shortened.
const MONOTONE: f64 = 1.0;
const CALM: f64 = 0.5;

impl Pair<'_> {
    /// A block of the prescribed length, with the forces of its start. If it overshoots, it is repeated with half the
    /// length until it is far below the limit, down to one train. If sleepers settled too unevenly for constant forces,
    /// the next block is shorter: grains cannot repeat a block, and their settlement is not known before.
    pub fn prescribed(&mut self, here: &mut Exchange, follow: &mut Following<'_>) -> Result<Done, RunError> {
        let wanted = self.blocks.wanted(here.axles).unwrap_or(1);
        let mut measured = BlockMeasures::default();
        loop {
            let trains = self.control.bounded(wanted);
            let block = self.blocks.block(here.axles, trains);
            self.ensure(here, &block.runners())?;
            let loads = here.loads(&self.blocks.parts(&block));
            let after = self.predict(here.axles, &loads)?;
            let settled = difference(&after, &here.settlement);
            let next = self.arrive(here.axles + block.axles, after)?;
            let change = self.change(here, &next, &block)?;
            measured.overshoot = change.as_ref().and_then(|change| amplification(&settled, change));
            measured.sawtooth = sawtooth(&self.runs, &settled);
            // with the mean of the forces of both ends the settlement would be larger by half the change
            measured.error = if trains > 1 { change.map_or(0.0, |change| largest(&change) / 2.0) } else { 0.0 };
            let bound = if self.control.limit.is_some() { CALM } else { MONOTONE };
            if trains > 1 && measured.overshoot.is_some_and(|a| a > bound) && self.blocks.cure {
                measured.rejected += 1;
                measured.overshot += 1;
                measured.add(&next, Work::default());
                self.control.shorten(trains);
                continue;
            }
            self.control.lengthen(trains, wanted);
            let block = self.advance_evenly(here, &block, &loads, follow)?;
            measured.error += self.ground.error_added();
            let settled = difference(&self.settlement(), &here.settlement);
            let uneven = unevenness(&self.runs, &loads, &settled);
            if !self.ground.foresees() {
                self.control.level(block.trains(), uneven);
            }
            measured.unevenness = if block.trains() > 1 { uneven } else { 0.0 };
            return Ok(Done { block, measured, next: Some(next) });
        }
    }

    /// Lets the trains of a block pass, and returns the part of the block that has passed: trains of one kind and
    /// direction stop before the sleepers settle too unevenly for their forces, if the ground can stop.
    fn advance_evenly(
        &mut self,
        here: &Exchange,
        block: &Block,
        loads: &[Load<'_>],
        follow: &mut Following<'_>,
    ) -> Result<Block, RunError> {
        let [load] = loads else {
            self.advance(here.axles, loads, follow)?;
            return Ok(block.clone());
        };
        let runs = self.runs.clone();
        let even = |settlement: &[f64], trains: u64| {
            // the next train is expected to add as much as each train so far
            let next = (trains + 1) as f64 / trains as f64;
            next * unevenness(&runs, loads, &difference(settlement, &here.settlement)) <= UNEVEN
        };
        let passed = self.advance_while(here.axles, load, &even, follow)?;
        Ok(self.blocks.block(here.axles, passed))
    }

    /// Additional settlement of the trains of a block from `here` with the forces of `there`, m. All trains of each
    /// type take a direction that was computed at both. `None` if none was.
    fn change(&self, here: &Exchange, there: &Exchange, block: &Block) -> Result<Option<Vec<f64>>, RunError> {
        let runs = self.runs_of_both(here, there, block);
        if runs.is_empty() {
            return Ok(None);
        }
        let block = [Block { runs, ..block.clone() }];
        let after = |exchange: &Exchange| self.predict(here.axles, &exchange.loads(&block));
        Ok(Some(difference(&after(there)?, &after(here)?)))
    }

    /// A block as long as its error allows.
    ///
    /// Within the block the forces follow the settlement as the forces of standing bogies do ([`Pair::followed`]). The
    /// block is done with the forces of its start, and in two halves with forces computed anew between them; the
    /// difference is the error of the first. The result that is kept is of second order: the first train passes with
    /// the forces of the start, all others with the forces of the middle. Two trains are therefore exact.
    pub fn adaptive(
        &mut self,
        here: &mut Exchange,
        tolerance: f64,
        cap: Option<f64>,
        follow: &mut Following<'_>,
    ) -> Result<Done, RunError> {
        let mut measured = BlockMeasures::default();
        let mut most = self.blocks.trains_left(here.axles);
        let mut middle: Option<Exchange> = None;
        loop {
            let left = self.blocks.trains_left(here.axles);
            let trains = self.chosen(here, most, left)?;
            let block = self.blocks.block(here.axles, trains);
            self.ensure(here, &block.runners())?;
            if trains == 1 {
                let loads = here.loads(std::slice::from_ref(&block));
                let settled = difference(&self.predict(here.axles, &loads)?, &here.settlement);
                measured.sawtooth = sawtooth(&self.runs, &settled);
                self.advance(here.axles, &loads, follow)?;
                return Ok(Done { block, measured, next: None });
            }
            let (_, whole) = self.followed(here, &[], &block)?;
            let half = self.blocks.block(here.axles, trains / 2);
            let (first_half, halfway) = self.followed(here, &[], &half)?;
            let axles = half.before + half.axles;
            // a shorter block after a rejected one may have the same middle
            let mut between = match middle.take().filter(|middle| middle.axles == axles) {
                Some(middle) => middle,
                None => Exchange::new(axles, halfway, Vec::new()),
            };
            let known = between.work();
            self.ensure(&mut between, &block.runners())?;
            measured.add(&between, known);
            let rest = self.blocks.block(axles, trains.div_ceil(2));
            let (_, halves) = self.followed(&between, &first_half, &rest)?;
            let error = largest(&difference(&whole, &halves));
            self.control.learn(error, largest(&difference(&whole, &here.settlement)), tolerance, cap);
            if trains > 2 && error > tolerance {
                measured.rejected += 1;
                most = (trains / 2).max(2);
                middle = Some(between);
                continue;
            }
            measured.error = if trains > 2 { error } else { 0.0 };
            self.second_order(here, &between, trains, follow)?;
            measured.sawtooth = sawtooth(&self.runs, &difference(&self.settlement(), &here.settlement));
            return Ok(Done { block, measured, next: None });
        }
    }

    /// Lets a block of so many trains pass as an adaptive block does, whatever its error.
    pub fn second_order_of(&mut self, here: &mut Exchange, trains: u64) -> Result<(), RunError> {
        let half = self.blocks.block(here.axles, trains / 2);
        let (_, halfway) = self.followed(here, &[], &half)?;
        let mut between = Exchange::new(half.before + half.axles, halfway, Vec::new());
        self.ensure(&mut between, &self.blocks.block(here.axles, trains).runners())?;
        self.second_order(here, &between, trains, &mut |_| ControlFlow::Continue(()))
    }

    /// Lets a block pass: its first train with the forces of the start, the others with those of the middle, which
    /// follow the settlement.
    fn second_order(
        &mut self,
        here: &Exchange,
        between: &Exchange,
        trains: u64,
        follow: &mut Following<'_>,
    ) -> Result<(), RunError> {
        let one = self.blocks.block(here.axles, 1);
        let others = self.blocks.block(here.axles + one.axles, trains - 1);
        let (first, _) = self.followed(here, &[], &one)?;
        let (all, _) = self.followed(between, &first, &others)?;
        self.advance(here.axles, &loads(&all), follow)
    }

    /// Trains of the next block: the number whose settlement with the forces of the start equals the target of the
    /// control. The order of different trains does not matter here.
    fn chosen(&self, here: &Exchange, most: u64, left: u64) -> Result<u64, RunError> {
        let mut failure = None;
        let trains = self.control.choose(most, left, |trains| {
            let block = [self.blocks.block(here.axles, trains)];
            match self.predict(here.axles, &here.loads(&block)) {
                Ok(settlement) => largest(&difference(&settlement, &here.settlement)),
                Err(error) => {
                    failure.get_or_insert(error);
                    f64::INFINITY
                }
            }
        });
        failure.map_or(Ok(trains), Err)
    }
}

impl BlockMeasures {
    /// The same, with more work.
    pub(super) fn with(self, more: &BlockMeasures) -> BlockMeasures {
        BlockMeasures {
            passages: self.passages + more.passages,
            time_steps: self.time_steps + more.time_steps,
            newton_iterations: self.newton_iterations + more.newton_iterations,
            ..self
        }
    }

    /// Counts the work of an exchange beyond the work `known` before.
    pub(super) fn add(&mut self, exchange: &Exchange, known: Work) {
        let work = exchange.work();
        self.passages += work.passages - known.passages;
        self.time_steps += work.time_steps - known.time_steps;
        self.newton_iterations += work.newton_iterations - known.newton_iterations;
    }
}

/// The unevenness of a block with these loads and this settlement, see [`BlockMeasures::unevenness`].
fn unevenness(runs: &[Range<usize>], loads: &[Load<'_>], settled: &[f64]) -> f64 {
    let displacement = loads.iter().map(|load| load.passage.max_rail_displacement).fold(0.0, f64::max);
    if displacement > 0.0 { beside_neighbours(runs, settled) / displacement } else { 0.0 }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The largest amount of any value.
pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}
