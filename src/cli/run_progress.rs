//! How far a run is, on a terminal or in a line a minute.

use super::{pack, progress, terminal};
use crate::execute::{Checkpoint, Event, Listener};
use crate::graph::{Block, BlockWeight, Blocks, Clock, Graph, Schedule};
use crate::nodes::Stage;
use crate::results::compared_passage;
use crate::solvers::granular::packing::Progress;
use std::ops::ControlFlow;

/// Shows a run while it goes on.
pub(super) struct Shown {
    bar: progress::Patient,
    tests: bool,
    /// What a track on grains is busy with, and blocks done of all.
    stage: String,
    blocks: Option<(u64, u64)>,
    way: Option<Way>,
}

impl Shown {
    pub(super) fn new(graph: &Graph, from: Option<&Checkpoint>) -> Shown {
        let tests = matches!(graph.schedule, Schedule::Actuators(_));
        let bar = progress::Patient::new(if tests { "the bed" } else { "the run" });
        Shown { bar, tests, stage: String::new(), blocks: None, way: Way::new(graph, from) }
    }

    /// Shows a stage of a track on grains: each has a bar of its own, and trains that of the whole run.
    fn stage(&mut self, progress: &Progress) {
        let trains = self.way.as_ref().filter(|_| progress.stage == Stage::Passage.to_string());
        let share = trains.map_or(progress.share, |way| way.share(progress.share));
        if self.stage != progress.stage {
            self.stage.clone_from(&progress.stage);
            let block =
                self.blocks.map_or(String::new(), |(done, all)| format!(", block {} of {all}", (done + 1).min(all)));
            let of_run = if trains.is_some() { "the run: " } else { "" };
            self.bar = progress::Patient::new(format!("{of_run}{}{block}", self.stage));
        }
        pack::show_share(&mut self.bar, share);
    }
}

/// How far trains are on their way over grains.
struct Way {
    /// Weight of the blocks that are done, of the one under way, and of all.
    done: f64,
    block: f64,
    all: f64,
    weight: BlockWeight,
    blocks: Blocks,
}

impl Way {
    fn new(graph: &Graph, from: Option<&Checkpoint>) -> Option<Way> {
        let (weight, blocks) = (graph.block_weight()?, graph.blocks()?.clone());
        let axles = match from.map(|checkpoint| checkpoint.clock) {
            Some(Clock::Axles(axles)) => axles,
            _ => 0,
        };
        let (done, left) = (weight.between(&blocks, 0, axles), weight.between(&blocks, axles, blocks.total));
        let mut way = Way { done, block: 0.0, all: done + left, weight, blocks };
        way.begin(axles);
        Some(way)
    }

    /// The block after so many axles begins.
    fn begin(&mut self, axles: u64) {
        let over = axles >= self.blocks.total;
        let block = (!over).then(|| self.blocks.next_block(axles));
        self.block = block.map_or(0.0, |block| self.weight.of_block(&self.blocks, &block));
    }

    /// A block has come to its end.
    fn end(&mut self, block: &Block) {
        self.done += self.block;
        self.begin(block.before + block.axles);
    }

    /// Share of all that is done where so much of the block is.
    fn share(&self, of_block: f64) -> f64 {
        ((self.done + of_block * self.block) / self.all).min(1.0)
    }
}

impl Listener for Shown {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        match event {
            Event::Compared(compared) if compared.exceeds() => {
                terminal::note(&format!("{}\n", compared_passage(compared)));
            }
            Event::Packing(progress) if self.tests => pack::show_share(&mut self.bar, progress.share),
            Event::Packing(progress) => self.stage(progress),
            Event::Packed { found, .. } => {
                pack::tell_loss(found);
                self.bar = progress::Patient::new("the test");
            }
            Event::Block { block: Some((block, _)), .. } => self.way.iter_mut().for_each(|way| way.end(block)),
            Event::Tested { .. } if self.tests => self.bar = progress::Patient::new("the bed"),
            Event::Progress { done, all } if self.stage.is_empty() => self.bar.show(*done, *all),
            Event::Progress { done, all } => {
                (self.blocks, self.stage) = (Some((*done, *all)), " ".into());
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}
