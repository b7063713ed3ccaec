//! Runs the schedule: static state, passage, settlement, block by block, until the axles are done (paper, Fig. 3).

use super::control::{Control, largest_within};
use super::exchange::{Exchange, Work};
use super::oscillation::{amplification, sawtooth};
use super::substructure::{Substructure, SubstructureState};
use super::system::TrackSystem;
use super::track::{PassageOutcome, Unloaded};
use super::{Block, Blocks, Graph, Schedule};
use crate::scenario::{Direction, Update};
use crate::solvers::track::TrackError;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;

/// The state between two blocks: a run that starts from it gives the same bits as one that never stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Blocks done, and their axles.
    pub blocks: usize,
    pub axles: u64,
    pub substructure: SubstructureState,
    /// What the length of the next block hangs on.
    pub control: Control,
}

/// What the exchange of a block was worth, and what it took besides the passages at its start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measured {
    /// Estimate of the error of settlement that the block adds at the worst seat, m; 0 for a block of one train.
    pub error: f64,
    /// By how much a disturbance of the settlement comes back with the other sign: above 1 the exchange overshoots, above 2
    /// it grows. `None` where the track moved too evenly to tell.
    pub overshoot: Option<f64>,
    /// Amplitude of a sawtooth along x in what the block settled, as a share of the most that it settled anywhere.
    pub sawtooth: f64,
    /// Longer blocks that were tried from the same start and thrown away.
    pub rejected: u64,
    /// Those of them that overshot.
    pub overshot: u64,
    /// Work beyond the passages at the start.
    pub time_steps: u64,
    pub newton_iterations: u64,
}

/// Listens to a run. Nothing of what it is told is computed twice, so it must keep what it needs.
pub trait Recorder {
    /// The track without a train, at an axle count that is recorded.
    fn unloaded(&mut self, axles: u64, state: &Unloaded);
    /// The passage at a recorded count.
    fn passage(&mut self, axles: u64, direction: Direction, passage: &PassageOutcome);
    /// A block is done: the passages at its start, and the settlement of every seat before and after it, m. `block` is
    /// `None` for the passage after the last block.
    fn block(
        &mut self,
        axles: u64,
        block: Option<(&Block, &Measured)>,
        passages: &[&PassageOutcome],
        before: &[f64],
        after: &[f64],
    );
    /// Called after each block; a failure stops the run.
    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<(), String>;
    /// Blocks done and to be done in all; the latter is an estimate that changes while the run goes on.
    fn progress(&mut self, done: u64, all: u64);
    /// The state of a static check.
    fn equilibrium(&mut self, state: &Unloaded);
}

/// Why a run stopped.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    /// A solver found no answer after so many axles.
    Track { axles: u64, cause: TrackError },
    /// What the recorder said.
    Recorder(String),
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunError::Track { axles, cause } => write!(f, "after {axles} axles: {cause}"),
            RunError::Recorder(cause) => f.write_str(cause),
        }
    }
}

impl std::error::Error for RunError {}

/// Runs several graphs at once, each from its beginning, and keeps their order. The results are those of [`execute`], bit for
/// bit.
pub fn execute_all<R: Recorder + Send>(runs: &mut [(&Graph, R)]) -> Vec<Result<(), RunError>> {
    runs.par_iter_mut().map(|(graph, recorder)| execute(graph, recorder, None)).collect()
}

/// Runs a graph, from its beginning or from a checkpoint. May be called from several threads at once; passages that do not
/// need each other run in the thread pool of rayon, and the result does not depend on the number of its threads.
pub fn execute(graph: &Graph, recorder: &mut dyn Recorder, from: Option<Checkpoint>) -> Result<(), RunError> {
    let at = |cause: TrackError| RunError::Track { axles: 0, cause };
    match &graph.schedule {
        Schedule::Static { loads } => {
            let system = TrackSystem::new(graph).map_err(at)?;
            recorder.equilibrium(&system.equilibrium(loads).map_err(at)?);
            recorder.progress(1, 1);
            Ok(())
        }
        Schedule::Blocks(blocks) => {
            let mut substructure = Substructure::new(&graph.substructure, &graph.track);
            let (mut done, mut axles, mut control) = (0, 0, Control::default());
            if let Some(checkpoint) = from {
                substructure.state = checkpoint.substructure;
                (done, axles, control) = (checkpoint.blocks, checkpoint.axles, checkpoint.control);
            }
            let system = TrackSystem::new(graph).map_err(at)?;
            Run { blocks, system, substructure, control, done, runs: settling(graph), recorder }.go(axles)
        }
    }
}

/// Stretches of neighbouring seats that can settle.
fn settling(graph: &Graph) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, _) in graph.track.track.seats.iter().enumerate().filter(|(_, seat)| seat.is_ballasted()) {
        match runs.last_mut() {
            Some(run) if run.end == i => run.end += 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

struct Run<'a> {
    blocks: &'a Blocks,
    system: TrackSystem<'a>,
    substructure: Substructure<'a>,
    control: Control,
    /// Blocks done.
    done: usize,
    runs: Vec<Range<usize>>,
    recorder: &'a mut dyn Recorder,
}

/// A block as it was accepted: what it leaves behind, and the exchange at its end where that has been computed.
struct Done<'a> {
    block: Block,
    measured: Measured,
    after: Substructure<'a>,
    next: Option<Exchange>,
}

impl<'a> Run<'a> {
    fn go(&mut self, axles: u64) -> Result<(), RunError> {
        let mut here = self.arrive(axles, &self.substructure)?;
        while here.axles < self.blocks.total {
            self.show(&here);
            let done = match self.blocks.update {
                Update::Adaptive { tolerance, cap } => self.adaptive(&mut here, tolerance, cap)?,
                Update::Fixed { .. } | Update::Geometric { .. } => self.prescribed(&mut here)?,
            };
            let after = done.after.settlement();
            let used = self.blocks.passages(&done.block);
            let passages: Vec<&PassageOutcome> = used.iter().filter_map(|(d, _)| here.of(*d)).collect();
            let block = Some((&done.block, &done.measured));
            self.recorder.block(here.axles, block, &passages, &here.settlement, &after);
            self.substructure = done.after;
            self.done += 1;
            let axles = here.axles + done.block.axles;
            let (blocks, substructure, control) = (self.done, self.substructure.state.clone(), self.control);
            let checkpoint = Checkpoint { blocks, axles, substructure, control };
            self.recorder.checkpoint(&checkpoint).map_err(RunError::Recorder)?;
            self.recorder.progress(self.done as u64, self.done as u64 + self.blocks_left(axles, done.block.axles) + 1);
            here = match done.next {
                Some(next) => next,
                None => self.arrive(axles, &self.substructure)?,
            };
        }
        self.show(&here);
        let passages: Vec<&PassageOutcome> = here.passages().collect();
        self.recorder.block(here.axles, None, &passages, &here.settlement, &here.settlement);
        self.recorder.progress(self.done as u64 + 1, self.done as u64 + 1);
        Ok(())
    }

    /// The track after so many axles, with the passages that the next block is expected to need.
    fn arrive(&self, axles: u64, substructure: &Substructure<'_>) -> Result<Exchange, RunError> {
        let directions: Vec<Direction> = if axles == self.blocks.total {
            vec![self.blocks.leading_direction()]
        } else {
            let wanted = self.blocks.wanted(axles).map(|wanted| self.control.bounded(wanted));
            let block = self.blocks.block(axles, wanted.unwrap_or_else(|| self.blocks.trains_left(axles)));
            self.blocks.passages(&block).into_iter().map(|(direction, _)| direction).collect()
        };
        // a block of one train decides which direction comes first
        let leading = if axles == self.blocks.total || directions.len() > 1 {
            self.blocks.leading_direction()
        } else {
            directions.first().copied().unwrap_or(Direction::Forward)
        };
        let recorded = self.blocks.recorded.contains(&axles);
        let mut exchange = Exchange::new(axles, substructure.settlement(), recorded, leading);
        self.ensure(&mut exchange, &directions)?;
        Ok(exchange)
    }

    fn ensure(&self, exchange: &mut Exchange, directions: &[Direction]) -> Result<(), RunError> {
        let axles = exchange.axles;
        exchange.ensure(&self.system, directions).map_err(|cause| RunError::Track { axles, cause })
    }

    fn show(&mut self, here: &Exchange) {
        if let Some((unloaded, direction, passage)) = here.recorded() {
            self.recorder.unloaded(here.axles, unloaded);
            self.recorder.passage(here.axles, direction, passage);
        }
    }

    /// A block of the length that the scene prescribes, with the forces of its start. Where it overshoots it is done again
    /// in halves until it is far from that, down to one train.
    fn prescribed(&mut self, here: &mut Exchange) -> Result<Done<'a>, RunError> {
        let wanted = self.blocks.wanted(here.axles).unwrap_or(1);
        let mut measured = Measured::default();
        loop {
            let trains = self.control.bounded(wanted);
            let block = self.blocks.block(here.axles, trains);
            let shares = self.blocks.passages(&block);
            let directions: Vec<Direction> = shares.iter().map(|(direction, _)| *direction).collect();
            self.ensure(here, &directions)?;
            let after = here.load(&self.substructure, &shares);
            let next = self.arrive(here.axles + block.axles, &after)?;
            let settled = difference(&after.settlement(), &here.settlement);
            let change = self.change(here, &next, trains);
            measured.overshoot = change.as_ref().and_then(|change| amplification(&settled, change));
            measured.sawtooth = sawtooth(&self.runs, &settled);
            // the mean of the forces of both ends would settle half the change more
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
            return Ok(Done { block, measured, after, next: Some(next) });
        }
    }

    /// How much more a block of so many trains from `here` would settle with the forces of `there`, m; `None` where no
    /// direction was run at both.
    fn change(&self, here: &Exchange, there: &Exchange, trains: u64) -> Option<Vec<f64>> {
        let both = |direction: &Direction| here.of(*direction).is_some() && there.of(*direction).is_some();
        let direction = [Direction::Forward, Direction::Backward].into_iter().find(both)?;
        let after = |exchange: &Exchange| exchange.load(&self.substructure, &[(direction, trains)]).settlement();
        Some(difference(&after(there), &after(here)))
    }

    /// A block as long as its error allows.
    ///
    /// It is done in one piece with the forces of its start, and in two halves with forces computed anew between them; the
    /// difference is the error of the first. What is kept is of second order: the first train passes with the forces of the
    /// start, as it truly does, all others with those of the middle. Two trains are therefore exact.
    fn adaptive(&mut self, here: &mut Exchange, tolerance: f64, cap: Option<f64>) -> Result<Done<'a>, RunError> {
        let mut measured = Measured::default();
        let mut most = self.blocks.trains_left(here.axles);
        let mut middle: Option<Exchange> = None;
        loop {
            let trains = self.choose(here, most);
            let block = self.blocks.block(here.axles, trains);
            let shares = self.blocks.passages(&block);
            let directions: Vec<Direction> = shares.iter().map(|(direction, _)| *direction).collect();
            self.ensure(here, &directions)?;
            let whole = here.load(&self.substructure, &shares);
            let settled = difference(&whole.settlement(), &here.settlement);
            if trains == 1 {
                measured.sawtooth = sawtooth(&self.runs, &settled);
                return Ok(Done { block, measured, after: whole, next: None });
            }

            let half = self.blocks.block(here.axles, trains / 2);
            let begun = here.load(&self.substructure, &self.blocks.passages(&half));
            let axles = half.before + half.axles;
            // a shorter block after a rejected one may have the same middle
            let mut between = middle
                .take()
                .filter(|middle| middle.axles == axles)
                .unwrap_or_else(|| Exchange::new(axles, begun.settlement(), false, self.blocks.leading_direction()));
            let known = between.work();
            self.ensure(&mut between, &directions)?;
            measured.add(&between, known);
            let rest = self.blocks.block(axles, trains.div_ceil(2));
            let halves = between.load(&begun, &self.blocks.passages(&rest)).settlement();
            let error = largest(&difference(&whole.settlement(), &halves));
            let moved = difference(&between.settlement, &here.settlement);
            let change = self.change(here, &between, trains);
            measured.overshoot = change.and_then(|change| amplification(&moved, &change));
            self.control.learn(error, largest(&settled), tolerance, cap);
            if trains > 2 && (error > tolerance || measured.overshoot.is_some_and(|a| a > UNSTABLE)) {
                measured.rejected += 1;
                most = (trains / 2).max(2);
                middle = Some(between);
                continue;
            }
            measured.error = if trains > 2 { error } else { 0.0 };
            let one = self.blocks.block(here.axles, 1);
            let others = self.blocks.block(here.axles + one.axles, trains - 1);
            let first = here.load(&self.substructure, &self.blocks.passages(&one));
            let after = between.load(&first, &self.blocks.passages(&others));
            measured.sawtooth = sawtooth(&self.runs, &difference(&after.settlement(), &here.settlement));
            return Ok(Done { block, measured, after, next: None });
        }
    }

    /// Trains whose settlement, with the forces of the start, is the aim, and two at least where so many are left. What is
    /// left until the next stop is divided evenly where it would take two blocks.
    fn choose(&self, here: &Exchange, most: u64) -> u64 {
        let left = self.blocks.trains_left(here.axles);
        let Some(aim) = self.control.aim else { return left.min(2) };
        let trains = largest_within(aim, most, |trains| self.predicted(here, trains)).max(left.min(2));
        if trains == left {
            trains
        } else if left < 2 * trains {
            left.div_ceil(2)
        } else {
            trains / 2 * 2 // so that the middle is one
        }
    }

    /// The most that any seat settles under so many trains with the forces of the start, m.
    fn predicted(&self, here: &Exchange, trains: u64) -> f64 {
        let shares = self.blocks.passages(&self.blocks.block(here.axles, trains));
        let known: Vec<(Direction, u64)> = shares.into_iter().filter(|(d, _)| here.of(*d).is_some()).collect();
        largest(&difference(&here.load(&self.substructure, &known).settlement(), &here.settlement))
    }

    /// Blocks from an axle count to the end, as far as one can know.
    fn blocks_left(&self, axles: u64, last: u64) -> u64 {
        let left = self.blocks.total - axles;
        match self.blocks.update {
            Update::Fixed { axles } => left.div_ceil(axles),
            // blocks grow with the axles so far, or keep their length if that is not so
            Update::Geometric { .. } | Update::Adaptive { .. } => {
                let growth = (last as f64 / axles as f64).min(1.0);
                let grown = ((self.blocks.total as f64 / axles as f64).ln() / growth.ln_1p()).ceil();
                (grown as u64).min(left.div_ceil(last))
            }
        }
    }
}

/// Largest amplification at which a disturbance keeps its sign, and what a block that is shortened must come down to.
const MONOTONE: f64 = 1.0;
const CALM: f64 = 0.5;
/// Amplification from which the second-order step grows disturbances; it never turns their sign.
const UNSTABLE: f64 = 2.0;

impl Measured {
    /// Counts the work of an exchange beyond what was `known` of it before.
    fn add(&mut self, exchange: &Exchange, known: Work) {
        let work = exchange.work();
        self.time_steps += work.time_steps - known.time_steps;
        self.newton_iterations += work.newton_iterations - known.newton_iterations;
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}
