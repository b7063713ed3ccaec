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
    /// Whether the bar is that of trains over all blocks.
    trains: bool,
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
        Shown { bar, trains: false, tests, stage: String::new(), blocks: None, way: Way::new(graph, from) }
    }

    /// Shows a stage of a track on grains: each has a bar of its own, and trains that of the whole run.
    fn stage(&mut self, progress: &Progress) {
        let way = self.way.as_ref().filter(|_| progress.stage == Stage::Passage.to_string());
        let share = way.map_or(progress.share, |way| way.share(progress.share));
        if self.stage != progress.stage {
            self.stage.clone_from(&progress.stage);
            let block =
                self.blocks.map_or(String::new(), |(done, all)| format!(", block {} of {all}", (done + 1).min(all)));
            let of_run = if way.is_some() { "the run: " } else { "" };
            let message = format!("{of_run}{}{block}", self.stage);
            // time goes on from block to block
            match std::mem::replace(&mut self.trains, way.is_some()) && self.trains {
                true => self.bar.rename(message),
                false => self.bar = progress::Patient::new(message),
            }
        }
        pack::show_share(&mut self.bar, share);
    }
}

/// How far trains are on their way over grains.
struct Way {
    /// Weight of the blocks that are done, of the one under way as planned, and of all.
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
        let done = weight.between(&blocks, 0, axles);
        let mut way = Way { done, block: 0.0, all: done, weight, blocks };
        way.begin(axles);
        Some(way)
    }

    /// The block after so many axles begins.
    fn begin(&mut self, axles: u64) {
        self.all = self.done + self.weight.between(&self.blocks, axles, self.blocks.total);
        let over = axles >= self.blocks.total;
        let block = (!over).then(|| self.blocks.next_block(axles));
        self.block = block.map_or(0.0, |block| self.weight.of_block(&self.blocks, &block));
    }

    /// A block has come to its end, maybe earlier than planned.
    fn end(&mut self, block: &Block) {
        self.done += self.weight.of_block(&self.blocks, block);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{NoModules, Override};

    /// Blocks of 20 axles on cells, which all count the same.
    #[test]
    fn blocks_that_end_early_do_not_bring_the_run_forward() {
        let text = include_str!("../../scenarios/transition_short.track");
        let wanted = ["solve.substructure=cells", "traffic.total=100 axles"].map(|set| Override::parse(set).unwrap());
        let compiled = crate::compile("transition_short.track", text, &NoModules, &wanted);
        let mut way = Way::new(&compiled.graph.unwrap(), None).unwrap();
        assert!(matches!(way.weight, BlockWeight::Equal));
        let passes = |way: &mut Way, before: u64, trains: u64| way.end(&way.blocks.block(before, trains));
        assert_eq!((way.share(0.0), way.share(0.5)), (0.0, 0.1));
        passes(&mut way, 0, 5);
        passes(&mut way, 20, 1);
        // two are done; 76 axles are left for blocks of 20
        assert!((way.share(0.0) - 2.0 / 6.0).abs() < 1e-12, "{}", way.share(0.0));
        [(24, 5), (44, 5), (64, 5), (84, 4)].into_iter().for_each(|(before, trains)| passes(&mut way, before, trains));
        assert_eq!(way.share(0.0), 1.0);
    }
}
