//! Runs the schedule: static state, passage, settlement, block by block, until the axles are done (paper, Fig. 3).

use super::control::Control;
use super::exchange::{Exchange, Work};
use super::step::Measured;
use super::substructure::{Substructure, SubstructureState, initial_settlement};
use super::system::{Kept, TrackSystem};
use super::track::{PassageOutcome, Unloaded};
use super::{Block, Blocks, Graph, Runner, Schedule};
use crate::scenario::Update;
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

/// Listens to a run. Nothing of what it is told is computed twice, so it must keep what it needs.
pub trait Recorder {
    /// The track without a train, at an axle count that is recorded.
    fn unloaded(&mut self, axles: u64, state: &Unloaded);
    /// A passage at a recorded count; there is one of each kind of train, the leading one first.
    fn passage(&mut self, axles: u64, runner: Runner, passage: &PassageOutcome);
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
    /// Seats are tamped: the settlement of every seat before and after it, m. What is recorded at that count has been told, and
    /// shows the track before.
    fn tamped(&mut self, _axles: u64, _seats: &[usize], _before: &[f64], _after: &[f64]) {}
    /// Settlement of every seat by each law, the driving one first, m: as built, after each block and after each tamping.
    fn laws(&mut self, _axles: u64, _settlement: &[Vec<f64>]) {}
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

/// The first passage of a graph, over the track as the scene starts it; `None` where no train runs.
pub fn passage_as_built(graph: &Graph) -> Result<Option<PassageOutcome>, RunError> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Ok(None) };
    let at = |cause: TrackError| RunError::Track { axles: 0, cause };
    let level = initial_settlement(&graph.track.track);
    let system = TrackSystem::new(graph).map_err(at)?;
    let leading = Runner { kind: 0, direction: blocks.leading_direction() };
    let (_, passage) = system.passage(0, &level, leading, Kept::Nothing).map_err(at)?;
    Ok(Some(passage))
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

pub(super) struct Run<'a> {
    pub blocks: &'a Blocks,
    system: TrackSystem<'a>,
    pub substructure: Substructure<'a>,
    pub control: Control,
    /// Blocks done.
    done: usize,
    /// Stretches of neighbouring seats that can settle.
    pub runs: Vec<Range<usize>>,
    recorder: &'a mut dyn Recorder,
}

impl<'a> Run<'a> {
    fn go(&mut self, axles: u64) -> Result<(), RunError> {
        let mut here = self.arrive(axles, &self.substructure)?;
        if self.done == 0 {
            self.recorder.laws(0, &self.substructure.settlement_by_law());
        }
        loop {
            self.show(&here);
            if here.axles >= self.blocks.total {
                break;
            }
            let mut work = Measured::default();
            if self.blocks.tamped_after(here.axles).next().is_some() {
                work.add(&here, Work::default());
                here = self.tamp(here.axles)?;
            }
            let done = match self.blocks.update {
                Update::Adaptive { tolerance, cap } => self.adaptive(&mut here, tolerance, cap)?,
                Update::Fixed { .. } | Update::Geometric { .. } => self.prescribed(&mut here)?,
            };
            let after = done.after.settlement();
            let passages: Vec<&PassageOutcome> =
                done.block.runs.iter().filter_map(|(runner, _)| here.of(*runner)).collect();
            work.add(&here, Work::default());
            let measured = done.measured.with(&work);
            let block = Some((&done.block, &measured));
            self.recorder.block(here.axles, block, &passages, &here.settlement, &after);
            self.substructure = done.after;
            self.done += 1;
            let axles = here.axles + done.block.axles;
            self.recorder.laws(axles, &self.substructure.settlement_by_law());
            let (blocks, substructure, control) = (self.done, self.substructure.state.clone(), self.control);
            let checkpoint = Checkpoint { blocks, axles, substructure, control };
            self.recorder.checkpoint(&checkpoint).map_err(RunError::Recorder)?;
            self.recorder.progress(self.done as u64, self.done as u64 + self.blocks_left(axles, done.block.axles) + 1);
            here = match done.next {
                Some(next) => next,
                None => self.arrive(axles, &self.substructure)?,
            };
        }
        let passages: Vec<&PassageOutcome> = here.passages().collect();
        self.recorder.block(here.axles, None, &passages, &here.settlement, &here.settlement);
        self.recorder.progress(self.done as u64 + 1, self.done as u64 + 1);
        Ok(())
    }

    /// The track after so many axles, with the passages that the next block is expected to need.
    pub fn arrive(&self, axles: u64, substructure: &Substructure<'_>) -> Result<Exchange, RunError> {
        let due = self.blocks.due(axles, self.expected(axles));
        let mut exchange = Exchange::new(axles, substructure.settlement(), due.shown);
        self.ensure(&mut exchange, &due.passages)?;
        Ok(exchange)
    }

    /// Trains that the next block is expected to have at most.
    fn expected(&self, axles: u64) -> u64 {
        let wanted = self.blocks.wanted(axles).map(|wanted| self.control.bounded(wanted));
        wanted.unwrap_or_else(|| self.blocks.trains_left(axles))
    }

    /// Tamps what is due, and arrives at the same count on the track as it lies then.
    fn tamp(&mut self, axles: u64) -> Result<Exchange, RunError> {
        let before = self.substructure.settlement();
        let mut seats = Vec::new();
        for tamping in self.blocks.tamped_after(axles) {
            self.substructure.tamp(&tamping.seats, tamping.left);
            seats.extend(&tamping.seats);
        }
        let after = self.substructure.settlement();
        self.recorder.tamped(axles, &seats, &before, &after);
        self.recorder.laws(axles, &self.substructure.settlement_by_law());
        let mut exchange = Exchange::new(axles, after, Vec::new());
        self.ensure(&mut exchange, &self.blocks.block(axles, self.expected(axles)).runners())?;
        Ok(exchange)
    }

    pub fn ensure(&self, exchange: &mut Exchange, runners: &[Runner]) -> Result<(), RunError> {
        let axles = exchange.axles;
        exchange.ensure(&self.system, runners).map_err(|cause| RunError::Track { axles, cause })
    }

    fn show(&mut self, here: &Exchange) {
        let Some((unloaded, passages)) = here.recorded() else { return };
        self.recorder.unloaded(here.axles, unloaded);
        for (runner, passage) in passages {
            self.recorder.passage(here.axles, runner, passage);
        }
    }

    /// Blocks from an axle count to the end, as far as one can know.
    fn blocks_left(&self, axles: u64, last: u64) -> u64 {
        let left = self.blocks.total - axles;
        match self.blocks.update {
            Update::Fixed { axles } => left.div_ceil(axles.max(1)),
            // blocks grow with the axles so far, or keep their length if that is not so
            Update::Geometric { .. } | Update::Adaptive { .. } => {
                let growth = (last as f64 / axles as f64).min(1.0);
                let grown = ((self.blocks.total as f64 / axles as f64).ln() / growth.ln_1p()).ceil();
                (grown as u64).min(left.div_ceil(last))
            }
        }
    }
}
