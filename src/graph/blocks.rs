//! Which trains run between two exchanges: whole trains, up to the next recorded count, in the directions of the traffic.

use super::{Block, Blocks};
use crate::scenario::{Direction, Update};

impl Blocks {
    /// The next axle count at which the state is recorded, or the end of the run.
    pub fn stop(&self, before: u64) -> u64 {
        self.recorded.iter().copied().find(|count| *count > before).unwrap_or(self.total)
    }

    /// Trains until the next stop.
    pub fn trains_left(&self, before: u64) -> u64 {
        (self.stop(before) - before) / self.train.axles()
    }

    /// Trains that the policy wants to send next, where it knows without a look at forces.
    pub fn wanted(&self, before: u64) -> Option<u64> {
        let axles = self.train.axles();
        let wanted = match self.update {
            Update::Fixed { axles: fixed } => fixed / axles,
            Update::Geometric { first, ratio } => first.max((ratio * before as f64) as u64) / axles,
            Update::Adaptive { .. } => return None,
        };
        Some(wanted.clamp(1, self.trains_left(before)))
    }

    /// A block of so many trains after `before` axles.
    pub fn block(&self, before: u64, trains: u64) -> Block {
        let axles = self.train.axles();
        let (forward, backward) = match self.train.direction {
            Direction::Forward => (trains, 0),
            Direction::Backward => (0, trains),
            // the first of every two trains of the run goes forward
            Direction::Both if (before / axles).is_multiple_of(2) => (trains.div_ceil(2), trains / 2),
            Direction::Both => (trains / 2, trains.div_ceil(2)),
        };
        Block { before, axles: trains * axles, forward, backward }
    }

    /// The blocks of a run whose policy needs no forces; `None` for an adaptive one.
    pub fn planned(&self) -> Option<Vec<Block>> {
        let mut blocks = Vec::new();
        let mut before = 0;
        while before < self.total {
            let block = self.block(before, self.wanted(before)?);
            before += block.axles;
            blocks.push(block);
        }
        Some(blocks)
    }

    /// Directions of the passages that a block needs, with the number of trains of each.
    pub fn passages(&self, block: &Block) -> Vec<(Direction, u64)> {
        [(Direction::Forward, block.forward), (Direction::Backward, block.backward)]
            .into_iter()
            .filter(|(_, trains)| *trains > 0)
            .collect()
    }
}
