//! The schedule of blocks: static state, passage, settlement, block by block, until the axles are done (paper, Fig. 3).

use super::comparison::Comparison;
use super::event::{Between, Checkpoint, Event, Listener, ScheduleState, tell_of_trains, tell_stage};
use super::exchange::{Exchange, Work};
use super::machine::{Ending, Machine, RunError};
use super::pair::{Pair, settling};
use super::step::{BlockMeasures, Done};
use crate::graph::{Blocks, Clock, Control, Graph, Runner, Update};
use crate::nodes::{
    Builders, CheckingCells, Forces, Kept, Load, NodeError, PassageOutcome, Request, Superstructure, Told, VolumeSample,
};
use crate::store::Beds;
use std::ops::ControlFlow;

/// Runs the blocks of a graph, from the beginning or from a checkpoint.
pub(super) fn run(
    machine: &Machine<'_>,
    blocks: &Blocks,
    listener: &mut dyn Listener,
    from: Option<Checkpoint>,
) -> Result<Ending, RunError> {
    let at = |axles: u64| move |cause: NodeError| RunError::node(Clock::Axles(axles), cause);
    let from = restored(from, blocks)?;
    let Restored { blocks: done, axles, control, compared, .. } = from;
    let begun = machine
        .track_on_ground_that(|ground| match &from.ground {
            Some(state) => ground.restore(state),
            None => ground.prepare(&mut |stage, share| tell_stage(listener, stage, share)),
        })
        .and_then(|(track, ground)| Ok((track, ground, checking(machine, &from, listener)?)));
    let (track, ground, check) = match begun {
        Err(NodeError::Stopped) => return Ok(Ending::Stopped),
        begun => begun.map_err(at(axles))?,
    };
    let runs = machine.graph.track().map(settling).unwrap_or_default();
    let pair = Pair { blocks, track, ground, check, control, runs };
    let mut run = Run { pair, done: done as usize, compared, listener };
    if compared.is_some_and(|compared| compared.refines()) {
        run.pair.track = run.pair.track.finer().map_err(at(axles))?;
    }
    Ok(match run.go(axles)? {
        ControlFlow::Continue(()) => Ending::Finished,
        ControlFlow::Break(()) => Ending::Stopped,
    })
}

/// The state of a schedule of blocks: from a checkpoint, or at the beginning.
#[derive(Default)]
pub(super) struct Restored {
    /// Blocks done, and axles that have passed.
    pub blocks: u64,
    pub axles: u64,
    /// The data for the length of the next block.
    pub control: Control,
    /// The state of the ground, and of the cells that check it; `None` at the beginning.
    pub ground: Option<serde_json::Value>,
    check: Option<serde_json::Value>,
    /// The comparison of a passage with a finer one, if it was due before.
    compared: Option<Comparison>,
}

/// The state in a checkpoint. A checkpoint beyond the end of the schedule belongs to another schedule.
pub(super) fn restored(from: Option<Checkpoint>, plan: &Blocks) -> Result<Restored, RunError> {
    match from.map(|checkpoint| (checkpoint.clock, checkpoint.state)) {
        None => Ok(Restored::default()),
        Some((Clock::Axles(axles), ScheduleState::Blocks { blocks, control, ground, check, compared }))
            if axles <= plan.total && blocks as u64 <= axles =>
        {
            Ok(Restored { blocks: blocks as u64, axles, control, ground: Some(ground), check, compared })
        }
        Some(_) => Err(RunError::ForeignCheckpoint),
    }
}

/// The cells that check the ground; `None` in a graph without them, and after tamping, which ends a check.
fn checking<'a>(
    machine: &Machine<'a>,
    from: &Restored,
    listener: &mut dyn Listener,
) -> Result<Option<CheckingCells<'a>>, NodeError> {
    let Some(mut cells) = machine.checking_cells() else { return Ok(None) };
    match (&from.ground, &from.check) {
        (None, _) => cells.prepare(&mut |stage, share| tell_stage(listener, stage, share))?,
        (Some(_), Some(state)) => cells.restore(state)?,
        (Some(_), None) => return Ok(None),
    }
    Ok(Some(cells))
}

/// The first passage of a graph, over the track as the scene starts it; `None` if no train runs, and where grains would
/// have to be packed for it.
pub fn passage_as_built(graph: &Graph) -> Result<Option<PassageOutcome>, RunError> {
    let Some(blocks) = graph.blocks() else { return Ok(None) };
    if graph.has_grains_under_track() {
        return Ok(None);
    }
    let machine = Machine { graph, builders: &Builders::default(), beds: &Beds::default() };
    let at = |cause: NodeError| RunError::node(Clock::Axles(0), cause);
    let (track, ground) = machine.track_on_ground().map_err(at)?;
    let runner = Runner { kind: 0, direction: blocks.leading_direction() };
    let settlement = ground.settlement();
    let request = Request { axles: 0, settlement: &settlement, runner, kept: Kept::Nothing, forces: Forces::Peaks };
    let (_, passage) = track.passage(request).map_err(at)?;
    Ok(Some(passage))
}

/// Settlement at which a run stops, m: more than the thickness of ballast below a sleeper, so that no settlement law
/// and no linear track model is valid.
const SUNK: f64 = 0.5;

/// Fails if the settlement (m) of a seat is above the limit, or no number.
pub(super) fn bearable(axles: u64, settlement: &[f64]) -> Result<(), RunError> {
    match settlement.iter().position(|settled| !(-SUNK..=SUNK).contains(settled)) {
        Some(seat) => Err(RunError::node(Clock::Axles(axles), NodeError::Sunk { seat, settlement: settlement[seat] })),
        None => Ok(()),
    }
}

/// A run of blocks on its way.
pub(super) struct Run<'a, 'l> {
    pub pair: Pair<'a>,
    /// Blocks done.
    done: usize,
    /// The comparison of a passage with a finer one.
    pub compared: Option<Comparison>,
    listener: &'l mut dyn Listener,
}

/// Whether the run goes on; a break says that a listener has ended it.
type Going<T> = Result<ControlFlow<(), T>, RunError>;

/// Tells an event, and leaves the function where a listener ends the run.
macro_rules! tell {
    ($run:expr, $event:expr) => {
        if $run.listener.hear(&$event).is_break() {
            return Ok(ControlFlow::Break(()));
        }
    };
}

/// The value of a step that went on; leaves the function where a listener has ended the run.
macro_rules! going {
    ($step:expr) => {
        match $step? {
            ControlFlow::Continue(value) => value,
            ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
        }
    };
}

impl Run<'_, '_> {
    fn go(&mut self, axles: u64) -> Going<()> {
        let mut here = self.pair.arrive(axles, self.pair.ground.settlement())?;
        // a run that continues in the middle of a block has already reported everything before it
        let mut told = self.pair.ground.is_underway();
        if self.done == 0 && !told {
            tell!(self, Event::Laws { axles: 0, settlement: &self.pair.ground.settlement_by_law() });
        }
        loop {
            if !std::mem::take(&mut told) {
                going!(self.show(&here));
            }
            if here.axles >= self.pair.blocks.total {
                break;
            }
            here = going!(self.block(here));
        }
        if let Some(compared) = self.compare(&mut here, &mut BlockMeasures::default())? {
            tell!(self, Event::Compared(&compared));
        }
        going!(self.record_last(&here));
        let passages: Vec<&PassageOutcome> = here.passages().collect();
        let (before, after) = (&here.settlement, &here.settlement);
        tell!(self, Event::Block { axles: here.axles, block: None, passages: &passages, before, after });
        tell!(self, Event::Progress { done: self.done as u64 + 1, all: self.done as u64 + 1 });
        Ok(ControlFlow::Continue(()))
    }

    /// Reports the state and the passages that a record shows.
    fn show(&mut self, here: &Exchange) -> Going<()> {
        let Some((state, passages)) = here.recorded() else { return Ok(ControlFlow::Continue(())) };
        tell!(self, Event::Rest { axles: here.axles, state });
        let beds = self.pair.ground.beds().map_err(|cause| RunError::node(Clock::Axles(here.axles), cause))?;
        if !beds.is_empty() {
            tell!(self, Event::Beds { axles: here.axles, under_train: false, beds: &beds });
        }
        for (runner, passage) in passages {
            tell!(self, Event::Passage { axles: here.axles, runner, passage });
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Records the passage after the last block, which settles nothing.
    fn record_last(&mut self, here: &Exchange) -> Going<()> {
        let leading = self.pair.blocks.leading();
        let Some(passage) = leading.first().and_then(|runner| here.passage(*runner)) else {
            return Ok(ControlFlow::Continue(()));
        };
        let (listener, load) = (&mut *self.listener, Load::new(passage, 1));
        let began = (here.axles, self.done, self.pair.control);
        let follow = &mut |told: Told<'_>| tell_of_trains(listener, began, told);
        let samples = match self.pair.ground.record_alone(here.axles, &load, follow) {
            Err(NodeError::Stopped) => return Ok(ControlFlow::Break(())),
            samples => samples.map_err(|cause| RunError::node(Clock::Axles(here.axles), cause))?,
        };
        self.tell_volumes(here.axles, &samples)
    }

    fn tell_volumes(&mut self, axles: u64, samples: &[VolumeSample]) -> Going<()> {
        if !samples.is_empty() {
            tell!(self, Event::Volumes { axles, samples });
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Tamps what is due, lets one block pass, and arrives at its end.
    fn block(&mut self, mut here: Exchange) -> Going<Exchange> {
        let mut work = BlockMeasures::default();
        if !self.pair.ground.is_underway() && self.pair.blocks.tamped_after(here.axles).next().is_some() {
            work.add(&here, Work::default());
            here = going!(self.tamp(here.axles));
        }
        if !self.pair.ground.is_underway()
            && let Some(compared) = self.compare(&mut here, &mut work)?
        {
            tell!(self, Event::Compared(&compared));
        }
        let revision = self.pair.ground.responses().revision;
        if self.pair.blocks.recorded.binary_search(&here.axles).is_ok() {
            self.pair.ground.record(here.axles);
        }
        let listener = &mut *self.listener;
        let began = (here.axles, self.done, self.pair.control);
        let follow = &mut |told: Told<'_>| tell_of_trains(listener, began, told);
        let done = match self.pair.blocks.adaptive() {
            Some((tolerance, cap)) => self.pair.adaptive(&mut here, tolerance, cap, follow),
            None => self.pair.prescribed(&mut here, follow),
        };
        let Done { block, measured, next } = match done {
            Err(RunError::Node { cause, .. }) if *cause == NodeError::Stopped => return Ok(ControlFlow::Break(())),
            done => done?,
        };
        work.add(&here, Work::default());
        let after = self.pair.ground.settlement();
        bearable(here.axles + block.axles, &after)?;
        // the settlement of the ground may differ from its prediction, and its responses may change: the passages
        // computed ahead are then discarded
        let same = |next: &Exchange| next.settlement == after && self.pair.ground.responses().revision == revision;
        let (next, lost) = if next.as_ref().is_some_and(same) { (next, None) } else { (None, next) };
        lost.iter().for_each(|lost| work.add(lost, Work::default()));
        let measured = BlockMeasures { bonds: self.pair.ground.bonds(), ..measured.with(&work) };
        let recorded = self.pair.ground.recorded();
        going!(self.tell_volumes(here.axles, &recorded));
        let passed = block.runs.iter().filter_map(|(runner, _)| here.passage(*runner));
        let passages: Vec<&PassageOutcome> = passed.collect();
        let (told, before) = (Some((&block, &measured)), &here.settlement);
        tell!(self, Event::Block { axles: here.axles, block: told, passages: &passages, before, after: &after });
        going!(self.between(here.axles + block.axles, block.axles));
        Ok(ControlFlow::Continue(match next {
            Some(next) => next,
            None => self.pair.arrive(here.axles + block.axles, after)?,
        }))
    }

    /// Ends a block of `last` axles: tells the settlement by each law, offers a checkpoint, and tells the progress.
    fn between(&mut self, axles: u64, last: u64) -> Going<()> {
        self.done += 1;
        tell!(self, Event::Laws { axles, settlement: &self.pair.ground.settlement_by_law() });
        going!(self.tell_check(axles));
        let (blocks, control, compared) = (self.done, self.pair.control, self.compared);
        let (ground, check) = (&self.pair.ground, &self.pair.check);
        let state = || {
            let check = check.as_ref().map(CheckingCells::save).transpose()?;
            let state = ScheduleState::Blocks { blocks, control, ground: ground.save()?, check, compared };
            Ok(Checkpoint { clock: Clock::Axles(axles), state })
        };
        tell!(self, Event::Between(Between { is_last: false, state: &state }));
        let all = self.done as u64 + self.blocks_left(axles, last) + 1;
        tell!(self, Event::Progress { done: self.done as u64, all });
        Ok(ControlFlow::Continue(()))
    }

    fn tell_check(&mut self, axles: u64) -> Going<()> {
        if let Some(check) = &self.pair.check {
            let (seats, settled) = (check.seats(), check.added(&self.pair.ground.settlement()));
            tell!(self, Event::Checked { axles, seats: &seats, settled: &settled, cells: &check.settled() });
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Tamps what is due, and arrives at the same count on the track as it lies then.
    fn tamp(&mut self, axles: u64) -> Going<Exchange> {
        let before = self.pair.ground.settlement();
        // the grains of the cells cannot be tamped
        self.pair.check = None;
        let mut seats = Vec::new();
        for tamping in self.pair.blocks.tamped_after(axles) {
            let tamped = self.pair.ground.tamp(&tamping.seats, tamping.left);
            tamped.map_err(|cause| RunError::node(Clock::Axles(axles), cause))?;
            seats.extend(&tamping.seats);
        }
        self.pair.stand(axles)?;
        let after = self.pair.ground.settlement();
        tell!(self, Event::Tamped { axles, seats: &seats, before: &before, after: &after });
        tell!(self, Event::Laws { axles, settlement: &self.pair.ground.settlement_by_law() });
        let mut exchange = Exchange::new(axles, after, Vec::new());
        self.pair.ensure(&mut exchange, &self.pair.blocks.block(axles, self.pair.expected(axles)).runners())?;
        Ok(ControlFlow::Continue(exchange))
    }

    /// Estimated number of blocks from an axle count to the end.
    fn blocks_left(&self, axles: u64, last: u64) -> u64 {
        let left = self.pair.blocks.total - axles;
        let even = self.pair.control.even.map_or(u64::MAX, |trains| trains * self.pair.blocks.train.axles());
        match self.pair.blocks.update {
            Update::Fixed { axles } => left.div_ceil(axles.min(even).max(1)),
            // blocks grow with the axles so far, or keep their length if that is not so
            Update::Geometric { .. } | Update::Adaptive { .. } => {
                let growth = (last as f64 / axles as f64).min(1.0);
                let grown = ((self.pair.blocks.total as f64 / axles as f64).ln() / growth.ln_1p()).ceil();
                (grown as u64).min(left.div_ceil(last))
            }
        }
    }
}
