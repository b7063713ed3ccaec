//! The schedule of blocks: static state, passage, settlement, block by block, until the axles are done (paper, Fig. 3).

use super::event::{Between, Checkpoint, Event, Listener, ScheduleState};
use super::exchange::{Exchange, Work};
use super::machine::{Ending, Machine, RunError};
use super::step::Measured;
use crate::graph::{Block, Blocks, Clock, Control, Graph, Runner, TrackNode, Update};
use crate::nodes::{
    Builders, Forces, Kept, Load, NodeError, PassageOutcome, Request, Substructure, Superstructure, TrackSystem,
};
use std::ops::{ControlFlow, Range};

/// Runs the blocks of a graph, from the beginning or from a checkpoint.
pub(super) fn run(
    machine: &Machine<'_>,
    blocks: &Blocks,
    listener: &mut dyn Listener,
    from: Option<Checkpoint>,
) -> Result<Ending, RunError> {
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let (mut track, mut ground) = machine.track_on_ground().map_err(at)?;
    let (mut done, mut axles, mut control) = (0, 0, Control::default());
    if let Some(checkpoint) = from {
        let (Clock::Axles(count), ScheduleState::Blocks { blocks, control: kept, ground: state }) =
            (checkpoint.clock, checkpoint.state)
        else {
            return Err(RunError::ForeignCheckpoint);
        };
        ground.restore(&state).map_err(at)?;
        track.stand_on(ground.responses()).map_err(at)?;
        (done, axles, control) = (blocks, count, kept);
    }
    let runs = machine.graph.track().map(settling).unwrap_or_default();
    Run { blocks, track, ground, control, done, runs, listener }.go(axles)
}

/// The first passage of a graph, over the track as the scene starts it; `None` where no train runs.
pub fn passage_as_built(graph: &Graph) -> Result<Option<PassageOutcome>, RunError> {
    let Some(blocks) = graph.blocks() else { return Ok(None) };
    let executor = super::Executor::default().with_builders(Builders::default());
    let machine = Machine { graph, executor: &executor };
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let (track, ground) = machine.track_on_ground().map_err(at)?;
    let runner = Runner { kind: 0, direction: blocks.leading_direction() };
    let settlement = ground.settlement();
    let request = Request { axles: 0, settlement: &settlement, runner, kept: Kept::Nothing, forces: Forces::Peaks };
    let (_, passage) = track.passage(request).map_err(at)?;
    Ok(Some(passage))
}

/// Stretches of neighbouring seats that can settle.
fn settling(track: &TrackNode) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, _) in track.seats.iter().enumerate().filter(|(_, seat)| seat.is_ballasted()) {
        match runs.last_mut() {
            Some(run) if run.end == i => run.end += 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

/// A run of blocks on its way.
pub(super) struct Run<'a, 'l> {
    pub blocks: &'a Blocks,
    track: TrackSystem<'a>,
    ground: Box<dyn Substructure + 'a>,
    pub control: Control,
    /// Blocks done.
    done: usize,
    /// Stretches of neighbouring seats that can settle.
    pub runs: Vec<Range<usize>>,
    listener: &'l mut dyn Listener,
}

/// Ends a function where a listener has ended the run.
macro_rules! tell {
    ($run:expr, $event:expr) => {
        if let ControlFlow::Break(()) = $run.listener.hear(&$event) {
            return Ok(Ending::Stopped);
        }
    };
}

impl Run<'_, '_> {
    fn go(mut self, axles: u64) -> Result<Ending, RunError> {
        let mut here = self.arrive(axles, self.ground.settlement())?;
        if self.done == 0 {
            tell!(self, Event::Laws { axles: 0, settlement: &self.ground.settlement_by_law() });
        }
        loop {
            if let Some((state, passages)) = here.recorded() {
                tell!(self, Event::Rest { axles: here.axles, state });
                for (runner, passage) in passages {
                    tell!(self, Event::Passage { axles: here.axles, runner, passage });
                }
            }
            if here.axles >= self.blocks.total {
                break;
            }
            let mut work = Measured::default();
            if self.blocks.tamped_after(here.axles).next().is_some() {
                work.add(&here, Work::default());
                let Some(tamped) = self.tamp(here.axles)? else { return Ok(Ending::Stopped) };
                here = tamped;
            }
            let revision = self.ground.responses().revision;
            let done = match self.blocks.adaptive() {
                Some((tolerance, cap)) => self.adaptive(&mut here, tolerance, cap)?,
                None => self.prescribed(&mut here)?,
            };
            let after = self.ground.settlement();
            let passages: Vec<&PassageOutcome> =
                done.block.runs.iter().filter_map(|(runner, _)| here.passage(*runner)).collect();
            work.add(&here, Work::default());
            // what the ground did may differ from what it predicted, and it may answer otherwise: the passages ahead are lost then
            let (next, lost) = match done.next {
                Some(next) if next.settlement == after && self.ground.responses().revision == revision => {
                    (Some(next), None)
                }
                lost => (None, lost),
            };
            lost.iter().for_each(|lost| work.add(lost, Work::default()));
            let measured = done.measured.with(&work);
            let (block, before) = (Some((&done.block, &measured)), &here.settlement);
            tell!(self, Event::Block { axles: here.axles, block, passages: &passages, before, after: &after });
            self.done += 1;
            let axles = here.axles + done.block.axles;
            tell!(self, Event::Laws { axles, settlement: &self.ground.settlement_by_law() });
            let (blocks, control, ground) = (self.done, self.control, &self.ground);
            let state = || {
                let state = ScheduleState::Blocks { blocks, control, ground: ground.save()? };
                Ok(Checkpoint { clock: Clock::Axles(axles), state })
            };
            tell!(self, Event::Between(Between { is_last: false, state: &state }));
            let all = self.done as u64 + self.blocks_left(axles, done.block.axles) + 1;
            tell!(self, Event::Progress { done: self.done as u64, all });
            here = match next {
                Some(next) => next,
                None => self.arrive(axles, after)?,
            };
        }
        let passages: Vec<&PassageOutcome> = here.passages().collect();
        let (before, after) = (&here.settlement, &here.settlement);
        tell!(self, Event::Block { axles: here.axles, block: None, passages: &passages, before, after });
        tell!(self, Event::Progress { done: self.done as u64 + 1, all: self.done as u64 + 1 });
        Ok(Ending::Finished)
    }

    /// The track after so many axles on this settlement (m), with the passages that the next block is expected to need.
    pub fn arrive(&self, axles: u64, settlement: Vec<f64>) -> Result<Exchange, RunError> {
        let due = self.blocks.due(axles, self.expected(axles));
        let mut exchange = Exchange::new(axles, settlement, due.shown);
        self.ensure(&mut exchange, &due.passages)?;
        Ok(exchange)
    }

    /// Trains that the next block is expected to have at most.
    fn expected(&self, axles: u64) -> u64 {
        let wanted = self.blocks.wanted(axles).map(|wanted| self.control.bounded(wanted));
        wanted.unwrap_or_else(|| self.blocks.trains_left(axles))
    }

    /// Tamps what is due, and arrives at the same count on the track as it lies then; `None` where a listener ended the run.
    fn tamp(&mut self, axles: u64) -> Result<Option<Exchange>, RunError> {
        let before = self.ground.settlement();
        let mut seats = Vec::new();
        for tamping in self.blocks.tamped_after(axles) {
            let tamped = self.ground.tamp(&tamping.seats, tamping.left);
            tamped.map_err(|cause| RunError::node(Clock::Axles(axles), cause))?;
            seats.extend(&tamping.seats);
        }
        self.stand(axles)?;
        let after = self.ground.settlement();
        let tamped = self.listener.hear(&Event::Tamped { axles, seats: &seats, before: &before, after: &after });
        let laws = self.listener.hear(&Event::Laws { axles, settlement: &self.ground.settlement_by_law() });
        if tamped.is_break() || laws.is_break() {
            return Ok(None);
        }
        let mut exchange = Exchange::new(axles, after, Vec::new());
        self.ensure(&mut exchange, &self.blocks.block(axles, self.expected(axles)).runners())?;
        Ok(Some(exchange))
    }

    pub fn ensure(&self, exchange: &mut Exchange, runners: &[Runner]) -> Result<(), RunError> {
        let clock = Clock::Axles(exchange.axles);
        let done = exchange.ensure(&self.track, runners, self.ground.forces());
        done.map_err(|cause| RunError::node(clock, cause))
    }

    /// The settlement of every seat that these loads would leave, m.
    pub fn predict(&self, axles: u64, loads: &[Load<'_>]) -> Result<Vec<f64>, RunError> {
        self.ground.predict(loads).map_err(|cause| RunError::node(Clock::Axles(axles), cause))
    }

    /// Settlement of every seat, m.
    pub fn settlement(&self) -> Vec<f64> {
        self.ground.settlement()
    }

    /// Lets a block pass, after which the track stands on what the ground answers then. A ground that fails is left as it was.
    pub fn advance(&mut self, axles: u64, loads: &[Load<'_>]) -> Result<(), RunError> {
        let mark = self.ground.mark();
        if let Err(cause) = self.ground.advance(loads) {
            self.ground.roll_back(mark);
            return Err(RunError::node(Clock::Axles(axles), cause));
        }
        self.stand(axles)
    }

    /// Lets the track take the responses of the ground.
    fn stand(&mut self, axles: u64) -> Result<(), RunError> {
        let stood = self.track.stand_on(self.ground.responses());
        stood.map_err(|cause| RunError::node(Clock::Axles(axles), cause))
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

    /// Trains of a block of each kind, in a direction for which both exchanges have a passage.
    pub fn of_both(&self, here: &Exchange, there: &Exchange, block: &Block) -> Vec<(Runner, u64)> {
        use crate::solvers::track::Direction::{Backward, Forward};
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
