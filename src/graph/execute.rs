//! Runs the schedule: static state, passage, settlement, block by block, until the axles are done (paper, Fig. 3).

use super::substructure::{Substructure, SubstructureState};
use super::system::TrackSystem;
use super::track::{PassageOutcome, Unloaded};
use super::{Block, Blocks, Graph, Schedule};
use crate::scenario::Direction;
use crate::solvers::track::TrackError;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The state between two blocks: a run that starts from it gives the same bits as one that never stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Blocks done.
    pub blocks: usize,
    pub substructure: SubstructureState,
}

/// Listens to a run. Nothing of what it is told is computed twice, so it must keep what it needs.
pub trait Recorder {
    /// The track without a train, at an axle count that is recorded.
    fn unloaded(&mut self, axles: u64, state: &Unloaded);
    /// The passage at a recorded count.
    fn passage(&mut self, axles: u64, direction: Direction, passage: &PassageOutcome);
    /// A block is done: its passages, and the settlement of every seat after it, m. `block` is `None` for the passage
    /// after the last block.
    fn block(&mut self, axles: u64, block: Option<&Block>, passages: &[PassageOutcome], before: &[f64], after: &[f64]);
    /// Settlement of every seat by each law, the driving one first, m: as built and after each block.
    fn laws(&mut self, _axles: u64, _settlement: &[Vec<f64>]) {}
    /// Called after each block; a failure stops the run.
    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<(), String>;
    /// Passages done and to be done in all.
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

/// Runs a graph, from its beginning or from a checkpoint.
pub fn execute(graph: &Graph, recorder: &mut dyn Recorder, from: Option<Checkpoint>) -> Result<(), RunError> {
    let at = |axles: u64| move |cause: TrackError| RunError::Track { axles, cause };
    match &graph.schedule {
        Schedule::Static { loads } => {
            let system = TrackSystem::new(graph).map_err(at(0))?;
            recorder.equilibrium(&system.equilibrium(loads).map_err(at(0))?);
            recorder.progress(1, 1);
            Ok(())
        }
        Schedule::Blocks(blocks) => {
            let mut run = Run { blocks, system: TrackSystem::new(graph).map_err(at(0))?, recorder };
            let mut substructure = Substructure::new(&graph.substructure, &graph.track);
            let mut done = 0;
            if let Some(checkpoint) = from {
                substructure.state = checkpoint.substructure;
                done = checkpoint.blocks;
            }
            if done == 0 {
                run.recorder.laws(0, &substructure.settlement_by_law());
            }
            for (i, block) in blocks.blocks.iter().enumerate().skip(done) {
                run.block(block, &mut substructure)?;
                run.recorder.laws(block.before + block.axles, &substructure.settlement_by_law());
                let checkpoint = Checkpoint { blocks: i + 1, substructure: substructure.state.clone() };
                run.recorder.checkpoint(&checkpoint).map_err(RunError::Recorder)?;
                run.recorder.progress(i as u64 + 1, blocks.blocks.len() as u64 + 1);
            }
            run.last(&substructure)?;
            run.recorder.progress(blocks.blocks.len() as u64 + 1, blocks.blocks.len() as u64 + 1);
            Ok(())
        }
    }
}

/// The first passage of a graph, over a track as built; `None` where no train runs.
pub fn passage_as_built(graph: &Graph) -> Result<Option<PassageOutcome>, RunError> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Ok(None) };
    let at = |cause: TrackError| RunError::Track { axles: 0, cause };
    let level = vec![0.0; graph.track.track.seats.len()];
    let system = TrackSystem::new(graph).map_err(at)?;
    let (_, passage) = system.passage(0, &level, blocks.leading_direction(), false).map_err(at)?;
    Ok(Some(passage))
}

struct Run<'a> {
    blocks: &'a Blocks,
    system: TrackSystem<'a>,
    recorder: &'a mut dyn Recorder,
}

impl Run<'_> {
    /// One exchange: the forces of the track as it lies, and what they settle.
    fn block(&mut self, block: &Block, substructure: &mut Substructure<'_>) -> Result<(), RunError> {
        let before = substructure.settlement();
        let directions = self.blocks.passages(block);
        let mut passages = Vec::with_capacity(directions.len());
        for (i, (direction, trains)) in directions.iter().enumerate() {
            let passage = self.passage(block.before, &before, *direction, i == 0)?;
            substructure.load(&passage.peaks, *trains);
            passages.push(passage);
        }
        self.recorder.block(block.before, Some(block), &passages, &before, &substructure.settlement());
        Ok(())
    }

    /// The track after all axles.
    fn last(&mut self, substructure: &Substructure<'_>) -> Result<(), RunError> {
        let settlement = substructure.settlement();
        let passage = self.passage(self.blocks.total, &settlement, self.blocks.leading_direction(), true)?;
        self.recorder.block(self.blocks.total, None, &[passage], &settlement, &settlement);
        Ok(())
    }

    /// A passage over the settled track; the first one at a recorded count is shown to the recorder.
    fn passage(
        &mut self,
        axles: u64,
        settlement: &[f64],
        direction: Direction,
        first: bool,
    ) -> Result<PassageOutcome, RunError> {
        let at = |cause: TrackError| RunError::Track { axles, cause };
        let recorded = first && self.blocks.recorded.contains(&axles);
        let (unloaded, passage) = self.system.passage(axles, settlement, direction, recorded).map_err(at)?;
        if recorded {
            self.recorder.unloaded(axles, &unloaded);
            self.recorder.passage(axles, direction, &passage);
        }
        Ok(passage)
    }
}
