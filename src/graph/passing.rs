//! How long trains take to pass grains, in the time of the scene: what a run on grains costs, and how far it is.

use super::{Block, Blocks, GrainsNode, Runner};

/// Way that wheels run beside the grains while they act on them, m, and time of a rest after a passage, s.
const BESIDE: f64 = 12.0;
const REST: f64 = 0.25;
/// Blocks that are looked at one by one; those behind count as the last of them.
const FOLLOWED: usize = 10_000;

/// Trains on their way over grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// From the first grain to the last, m.
    pub length: f64,
    /// Distance from the front of a train to that of the next one, m; `None` where the track comes to rest between them.
    pub headway: Option<f64>,
}

/// What a block of trains over grains weighs in the progress of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BlockWeight {
    /// The time in which its trains pass, for all of them are computed.
    Time(Passing),
    /// All blocks weigh the same: cells compute as many trains as they need, and nobody knows before how many.
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
    /// Trains over the grains of a node; `None` where it has none yet.
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

/// Sum over the blocks between two counts of axles. Blocks that nobody knows before their forces count as a train each.
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
