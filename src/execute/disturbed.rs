//! What becomes of a disturbance of the settlement from block to block: an exchange of forces and settlement is
//! explicit, so a block that is too long lets the disturbance grow.
//!
//! A sawtooth is added to the settlement that the track sees. Sleepers that are higher carry more and settle more, so a
//! block returns the sawtooth multiplied by 1 - A, where A = dN lambda if every train settles the track by as much. It
//! grows where A is above 2. In theory A follows from statics: from the forces of standing bogies on the track with and
//! without the sawtooth, and from the law. The measurement runs whole passages over both tracks, block after block.

use super::blocks::restored;
use super::event::{Checkpoint, Event, Listener};
use super::exchange::Exchange;
use super::executor::Executor;
use super::machine::{Machine, RunError};
use super::oscillation::bends;
use super::pair::{Pair, settling};
use crate::graph::{Block, Blocks, Clock, Control, Graph, Responses, TrackSeat, Update};
use crate::nodes::{Builders, Forces, Load, Mark, NodeError, PassageOutcome, Substructure};
use crate::solvers::settlement::Peak;
use crate::store::Beds;
use serde::Serialize;
use std::ops::ControlFlow;

/// A disturbance over some blocks of equal length.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Disturbance {
    /// Axles that had passed, and axles of a block.
    pub axles: u64,
    pub block_axles: u64,
    /// The largest A of the first block over all shapes of a disturbance, and growth of the sawtooth per block over
    /// [`BLOCKS`] blocks, in theory.
    pub amplification: f64,
    pub in_theory: f64,
    /// Growth per block where the forces stay over the block, measured over [`BLOCKS`] blocks.
    pub stays: f64,
    /// Growth per block where the forces follow the settlement within the block, as in adaptive blocks.
    pub follows: f64,
}

/// Blocks over which growth is taken.
pub const BLOCKS: u32 = 3;
/// Amplitude of the sawtooth / largest deflection of a support under the train: too small to lift a sleeper.
const AMPLITUDE: f64 = 2e-3;

/// Disturbances at the first exchange after each of `counts` axles, in blocks of each of these numbers of trains. A
/// block that would pass the end of the traffic is left out. `tell` hears of each disturbance that is measured. Fails
/// for a track on grains, whose settlement cannot be predicted.
pub fn disturbances(
    graph: &Graph,
    counts: &[u64],
    trains: &[u64],
    tell: &mut dyn FnMut(),
) -> Result<Vec<Disturbance>, RunError> {
    let at = |cause| RunError::node(Clock::Axles(0), cause);
    if graph.has_grains_under_track() {
        let why = "the settlement of grains after a block cannot be predicted".to_owned();
        return Err(at(NodeError::Other { node: "grains".into(), why }));
    }
    let Some(blocks) = graph.blocks() else { return Ok(Vec::new()) };
    let (builders, beds) = (Builders::default(), Beds::default());
    let mut found = Vec::new();
    for state in states(graph, counts)? {
        let here = Here { machine: Machine { graph, builders: &builders, beds: &beds }, blocks, state };
        let axles = here.axles();
        let added = here.added()?;
        for trains in trains {
            let length = blocks.block(axles, *trains).axles;
            if axles + u64::from(BLOCKS) * length > blocks.total {
                continue;
            }
            let [amplification, in_theory] = here.in_theory(&added, *trains)?;
            let [stays, follows] = [here.growth(&added, *trains, false)?, here.growth(&added, *trains, true)?];
            found.push(Disturbance { axles, block_axles: length, amplification, in_theory, stays, follows });
            tell();
        }
    }
    Ok(found)
}

/// The states of a run at its first exchanges after these counts.
fn states(graph: &Graph, counts: &[u64]) -> Result<Vec<Option<Checkpoint>>, RunError> {
    let mut states = Vec::new();
    if counts.contains(&0) {
        states.push(None);
    }
    let mut wanted: Vec<u64> = counts.iter().copied().filter(|count| *count > 0).collect();
    wanted.sort_unstable();
    let mut keeper = Keeper { wanted, kept: Vec::new(), failed: None };
    Executor::default().run(graph, &mut keeper, None)?;
    match keeper.failed {
        Some(cause) => Err(RunError::node(Clock::Axles(0), cause)),
        None => Ok(states.into_iter().chain(keeper.kept.into_iter().map(Some)).collect()),
    }
}

/// Keeps the states after some counts of axles, and ends the run after the last.
struct Keeper {
    wanted: Vec<u64>,
    kept: Vec<Checkpoint>,
    failed: Option<NodeError>,
}

impl Listener for Keeper {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        let Event::Between(between) = event else { return ControlFlow::Continue(()) };
        match between.checkpoint() {
            Ok(checkpoint) => {
                let Clock::Axles(axles) = checkpoint.clock else { return ControlFlow::Break(()) };
                if self.wanted.first().is_some_and(|wanted| axles >= *wanted) {
                    self.wanted.retain(|wanted| axles < *wanted);
                    self.kept.push(checkpoint);
                }
            }
            Err(cause) => self.failed = Some(cause),
        }
        if self.wanted.is_empty() || self.failed.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A graph in one state.
struct Here<'a> {
    machine: Machine<'a>,
    blocks: &'a Blocks,
    state: Option<Checkpoint>,
}

impl Here<'_> {
    fn axles(&self) -> u64 {
        match self.state.as_ref().map(|state| state.clock) {
            Some(Clock::Axles(axles)) => axles,
            _ => 0,
        }
    }

    /// The largest A of the first block of so many trains, and growth of the sawtooth per block, from statics and the
    /// law.
    fn in_theory(&self, added: &[f64], trains: u64) -> Result<[f64; 2], RunError> {
        let (mut pair, mut here) = self.begun(None)?;
        let (mut wave, mut amplification) = (added.to_vec(), None);
        for _ in 0..BLOCKS {
            let block = pair.blocks.block(here.axles, trains);
            pair.ensure(&mut here, &block.runners())?;
            let parts = pair.blocks.parts(&block);
            if amplification.is_none() {
                amplification = Some(largest_amplification(&pair, &here, &parts, added)?);
            }
            let change = changed(&pair, &here, &parts, &wave)?;
            wave.iter_mut().zip(change).for_each(|(wave, change)| *wave += change);
            pair.advance(here.axles, &here.loads(&parts), &mut |_| ControlFlow::Continue(()))?;
            here = Exchange::new(here.axles + block.axles, pair.settlement(), Vec::new());
        }
        Ok([amplification.unwrap_or(0.0), growth_per_block(added, &wave)])
    }

    /// Growth of the sawtooth per block, measured over [`BLOCKS`] blocks.
    fn growth(&self, added: &[f64], trains: u64, follows: bool) -> Result<f64, RunError> {
        let level = self.after(None, trains, follows)?;
        let disturbed = self.after(Some(added.to_vec()), trains, follows)?;
        let end: Vec<f64> = disturbed.iter().zip(&level).map(|(a, b)| a - b).collect();
        Ok(growth_per_block(added, &end))
    }

    /// A sawtooth at the seats that settle and that every wheel passes, m; on a track shorter than that at all that
    /// settle.
    fn added(&self) -> Result<Vec<f64>, RunError> {
        let (pair, mut here) = self.begun(None)?;
        let runners = self.blocks.block(here.axles, 1).runners();
        pair.ensure(&mut here, &runners)?;
        let peaks = here.passages().flat_map(|passage| passage.peaks.iter().flatten());
        let deflection = peaks.map(|peak| peak.deflection).fold(0.0, f64::max);
        let (track, passed) = (self.machine.graph.track(), self.blocks.passed());
        let seats = track.map_or(&[] as &[_], |track| &track.seats);
        let moves = |seat: &&TrackSeat| seat.is_ballasted() && passed.contains(&seat.x);
        let any = seats.iter().any(|seat| moves(&seat));
        let tooth = |(number, seat): (usize, &TrackSeat)| {
            let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
            if moves(&seat) || !any && seat.is_ballasted() { sign * AMPLITUDE * deflection } else { 0.0 }
        };
        Ok(seats.iter().enumerate().map(tooth).collect())
    }

    /// Settlement of every seat after [`BLOCKS`] blocks of so many trains, m.
    fn after(&self, added: Option<Vec<f64>>, trains: u64, follows: bool) -> Result<Vec<f64>, RunError> {
        let (mut pair, mut here) = self.begun(added)?;
        for _ in 0..BLOCKS {
            let block = pair.blocks.block(here.axles, trains);
            pair.ensure(&mut here, &block.runners())?;
            if follows && trains > 1 {
                pair.second_order_of(&mut here, trains)?;
            } else {
                let loads = here.loads(&pair.blocks.parts(&block));
                pair.advance(here.axles, &loads, &mut |_| ControlFlow::Continue(()))?;
            }
            here = Exchange::new(here.axles + block.axles, pair.settlement(), Vec::new());
        }
        Ok(here.settlement)
    }

    /// The track in this state, with a settlement that it sees besides.
    fn begun(&self, added: Option<Vec<f64>>) -> Result<(Pair<'_>, Exchange), RunError> {
        let at = |cause| RunError::node(Clock::Axles(self.axles()), cause);
        let text = self.state.as_ref().map(|state| serde_json::to_value(state).and_then(serde_json::from_value));
        let copied = text
            .transpose()
            .map_err(|cause| at(NodeError::Foreign { node: "settlement laws", why: cause.to_string() }))?;
        let from = restored(copied, self.blocks)?;
        let begun = self.machine.track_on_ground_that(|ground| match &from.ground {
            Some(state) => ground.restore(state),
            None => ground.prepare(&mut |_, _| ControlFlow::Continue(())),
        });
        let (track, ground) = begun.map_err(at)?;
        let ground: Box<dyn Substructure + '_> = match added {
            Some(added) => Box::new(Shifted { ground, added }),
            None => ground,
        };
        let runs = self.machine.graph.track().map(settling).unwrap_or_default();
        let settlement = ground.settlement();
        let pair = Pair { blocks: self.blocks, track, ground, check: None, control: Control::default(), runs };
        Ok((pair, Exchange::new(self.axles(), settlement, Vec::new())))
    }
}

fn growth_per_block(start: &[f64], end: &[f64]) -> f64 {
    let [start, end] = [start, end].map(|values| length(&bends(values)));
    (end / start).powf(1.0 / f64::from(BLOCKS))
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Steps of the power iteration for the largest A.
const ITERATIONS: u32 = 10;

/// The largest A of a block over all shapes of a disturbance, by power iteration from a sawtooth. Sleepers beside a
/// structure and on stiff supports have more than the mean.
fn largest_amplification(pair: &Pair<'_>, here: &Exchange, parts: &[Block], added: &[f64]) -> Result<f64, RunError> {
    let size = length(added);
    let (mut wave, mut amplification) = (added.to_vec(), 0.0);
    for _ in 0..ITERATIONS {
        let change = changed(pair, here, parts, &wave)?;
        let product: f64 = wave.iter().zip(&change).map(|(wave, change)| wave * change).sum();
        amplification = -product / (size * size);
        let scale = size / length(&change);
        if !scale.is_finite() {
            return Ok(0.0);
        }
        wave = change.iter().map(|change| -scale * change).collect();
    }
    Ok(amplification)
}

/// Change of the settlement by a block if the track is moved (m), with the forces of standing bogies, m.
fn changed(pair: &Pair<'_>, here: &Exchange, parts: &[Block], moved: &[f64]) -> Result<Vec<f64>, RunError> {
    let at = |cause| RunError::node(Clock::Axles(here.axles), cause);
    let with_voids = pair.ground.sees_voids();
    let shifted: Vec<f64> = here.settlement.iter().zip(moved).map(|(settled, moved)| settled + moved).collect();
    let [from, to] = [&here.settlement, &shifted].map(|settlement| pair.track.standing(settlement, with_voids));
    let (from, to) = (from.map_err(at)?, to.map_err(at)?);
    let runs = parts.iter().flat_map(|part| &part.runs);
    let known = runs.filter_map(|(runner, trains)| Some((runner.kind, here.passage(*runner)?, *trains)));
    let peaks = known.map(|(kind, passage, trains)| {
        let followed = pair.track.follow(kind, passage, [&from, &to]).map_err(at)?;
        Ok((passage, followed, trains))
    });
    let peaks: Vec<(&PassageOutcome, Vec<Vec<Peak>>, u64)> = peaks.collect::<Result<_, RunError>>()?;
    let still: Vec<Load<'_>> = peaks.iter().map(|one| Load::new(one.0, one.2)).collect();
    let moved: Vec<Load<'_>> =
        still.iter().zip(&peaks).map(|(load, one)| Load { followed: Some(&one.1), ..*load }).collect();
    let [still, moved] = [pair.predict(here.axles, &still)?, pair.predict(here.axles, &moved)?];
    Ok(moved.iter().zip(&still).map(|(a, b)| a - b).collect())
}

/// A ground with a settlement on top of its own, m.
struct Shifted<'a> {
    ground: Box<dyn Substructure + 'a>,
    added: Vec<f64>,
}

impl Shifted<'_> {
    fn shifted(&self, settlement: Vec<f64>) -> Vec<f64> {
        settlement.iter().zip(&self.added).map(|(settled, added)| settled + added).collect()
    }
}

impl Substructure for Shifted<'_> {
    fn responses(&self) -> &Responses {
        self.ground.responses()
    }

    fn settlement(&self) -> Vec<f64> {
        self.shifted(self.ground.settlement())
    }

    fn forces(&self) -> Forces {
        self.ground.forces()
    }

    fn sees_voids(&self) -> bool {
        self.ground.sees_voids()
    }

    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError> {
        Ok(self.shifted(self.ground.predict(loads)?))
    }

    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError> {
        self.ground.advance(loads)
    }

    fn mark(&self) -> Mark {
        self.ground.mark()
    }

    fn roll_back(&mut self, mark: Mark) {
        self.ground.roll_back(mark);
    }

    fn tamp(&mut self, seats: &[usize], left: f64) -> Result<(), NodeError> {
        self.ground.tamp(seats, left)
    }

    fn save(&self) -> Result<serde_json::Value, NodeError> {
        self.ground.save()
    }

    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError> {
        self.ground.restore(state)
    }
}

/// Axles before each block of a plan, and its axles: as planned, or as a run takes them.
pub fn blocks_of_run(graph: &Graph) -> Result<Vec<[u64; 2]>, RunError> {
    let Some(blocks) = graph.blocks() else { return Ok(Vec::new()) };
    if let (Some(planned), false) = (blocks.planned(), matches!(blocks.update, Update::Adaptive { .. })) {
        return Ok(planned.iter().map(|block| [block.before, block.axles]).collect());
    }
    let mut found = Vec::new();
    let mut listener = |event: &Event<'_>| {
        if let Event::Block { block: Some((block, _)), .. } = event {
            found.push([block.before, block.axles]);
        }
        ControlFlow::Continue(())
    };
    Executor::default().run(graph, &mut listener, None)?;
    Ok(found)
}
