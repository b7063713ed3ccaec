//! Simulated time in which trains pass grains, for the cost and the progress of a run on grains.

use super::{Block, Blocks, GrainsNode, Runner};

/// Distance that wheels run beside the grains while they act on the grains, m; time of rest after a passage, s.
const BESIDE: f64 = 12.0;
const REST: f64 = 0.25;
/// Number of blocks that are counted one by one; later blocks count like the last of these.
const FOLLOWED: usize = 10_000;

/// Trains that pass over grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// Distance from the first to the last grain, m.
    pub length: f64,
    /// Distance between the fronts of two trains, m; `None` if the track comes to rest between two trains.
    pub headway: Option<f64>,
}

/// Weight of a block of trains over grains in the progress of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BlockWeight {
    /// The time in which the trains pass; all trains are computed.
    Time(Passing),
    /// All blocks have the same weight: the number of trains that cells compute is not known in advance.
    Equal,
}

impl BlockWeight {
    /// The weight of one block: a time, s, or 1.
    pub fn of_block(&self, blocks: &Blocks, block: &Block) -> f64 {
        match self {
            BlockWeight::Time(passing) => passing.of_block(blocks, block),
            BlockWeight::Equal => 1.0,
        }
    }

    /// The weight of the blocks between two counts of axles.
    pub fn between(&self, blocks: &Blocks, from: u64, to: u64) -> f64 {
        between(blocks, [from, to], |block| self.of_block(blocks, block))
    }
}

impl Passing {
    /// Trains over the grains of a node; `None` if it has no grains yet.
    pub fn over(grains: &GrainsNode) -> Option<Passing> {
        let ends = grains.stretches.iter().map(|stretch| {
            let [cell, _] = grains.beds[stretch.bed].numbers().plan;
            [stretch.start, stretch.start + f64::from(stretch.copies) * cell]
        });
        let [left, right] = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
        Some(Passing { length: right - left, headway: grains.headway })
    }

    /// Time of a block, s.
    pub fn of_block(&self, blocks: &Blocks, block: &Block) -> f64 {
        let of_run = |(runner, trains): &(Runner, u64)| {
            let (train, _) = blocks.kind(runner.kind);
            let alone = (self.length + BESIDE + train.wheel_base()) / train.speed + REST;
            match self.headway {
                Some(headway) => alone + trains.saturating_sub(1) as f64 * headway / train.speed,
                None => *trains as f64 * alone,
            }
        };
        block.runs.iter().map(of_run).sum()
    }

    /// Time of the blocks between two counts of axles, s.
    pub fn between(&self, blocks: &Blocks, from: u64, to: u64) -> f64 {
        between(blocks, [from, to], |block| self.of_block(blocks, block))
    }
}

/// Sum over the blocks between two counts of axles. A block whose length depends on forces counts as one train.
fn between(blocks: &Blocks, [from, to]: [u64; 2], of_block: impl Fn(&Block) -> f64) -> f64 {
    let (mut sum, mut before) = (0.0, from);
    for followed in 0.. {
        if before >= to {
            break;
        }
        let block = blocks.next_block(before);
        let (one, axles) = (of_block(&block), block.axles.max(1));
        if followed == FOLLOWED {
            return sum + one * (to - before) as f64 / axles as f64;
        }
        sum += one;
        before += axles;
    }
    sum
}
