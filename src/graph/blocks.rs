//! Trains that run between two exchanges: whole trains, up to the next stop, in the order and directions of the
//! traffic.

use super::{Block, Blocks, PassagePlan, Runner, Runs, Tamping, Train, Update};
use crate::solvers::track::Direction;

/// Number of parts into which a block of different trains is divided when the track settles. Within a part one kind of
/// train runs after the other, so the order of the trains is kept to within a sixteenth of the block.
const PARTS: u64 = 16;

/// Steps of a block in which the forces follow the settlement.
const STEPS: u64 = 12;

/// Passages over the track at an axle count.
pub struct Due {
    pub passages: Vec<Runner>,
    /// Recorded passages: one for each kind of train, the leading kind first; empty if nothing is recorded.
    pub shown: Vec<Runner>,
}

impl Blocks {
    /// A kind of train with its passage plan; 0 is the leading kind.
    pub fn kind(&self, kind: usize) -> (&Train, &PassagePlan) {
        match kind.checked_sub(1).and_then(|other| self.others.get(other)) {
            Some((train, plan)) => (train, plan),
            None => (&self.train, &self.passage),
        }
    }

    /// Every kind of train, in the order of the traffic.
    pub fn kinds(&self) -> impl Iterator<Item = (&Train, &PassagePlan)> {
        std::iter::once((&self.train, &self.passage)).chain(self.others.iter().map(|(train, plan)| (train, plan)))
    }

    /// The tolerance and the cap of the settlement of a block, m, if blocks are adaptive.
    pub fn adaptive(&self) -> Option<(f64, Option<f64>)> {
        match self.update {
            Update::Adaptive { tolerance, cap } if self.share => Some((tolerance, cap)),
            _ => None,
        }
    }

    /// A passage of each kind of train in its leading direction.
    pub fn leading(&self) -> Vec<Runner> {
        self.kinds()
            .enumerate()
            .map(|(kind, (train, _))| Runner { kind, direction: train.leading_direction() })
            .collect()
    }

    /// Number of trains that have passed after `axles` axles.
    fn position(&self, axles: u64) -> u64 {
        self.sequence.within(axles)
    }

    /// Tampings after `axles` axles.
    pub fn tamped_after(&self, axles: u64) -> impl Iterator<Item = &Tamping> {
        self.tampings.iter().filter(move |tamping| tamping.after.contains(&axles))
    }

    /// Whether no train is on the track after `axles` axles: before the first train and behind the last one, at a
    /// tamping, and, where trains of several kinds or in both directions run, after every run of equal trains.
    pub fn is_gap(&self, axles: u64) -> bool {
        let is_one_kind = self.others.is_empty() && self.train.runs != Runs::BothWays;
        axles == 0 || axles >= self.total || !is_one_kind || self.tamped_after(axles).next().is_some()
    }

    /// The next axle count at which a block ends: at a record, at a tamping, at the start of another kind of train, or
    /// at the end of the run.
    pub fn stop(&self, before: u64) -> u64 {
        self.stops.get(self.stops.partition_point(|count| *count <= before)).copied().unwrap_or(self.total)
    }

    /// Trains until the next stop.
    pub fn trains_left(&self, before: u64) -> u64 {
        self.position(self.stop(before)) - self.position(before)
    }

    /// Number of trains in the next block by the policy, if the policy does not depend on forces.
    pub fn wanted(&self, before: u64) -> Option<u64> {
        if !self.share {
            return Some(1);
        }
        let axles = self.update.axles_after(before)?;
        let wanted = self.position(before + axles) - self.position(before);
        Some(wanted.max(1).min(self.trains_left(before)))
    }

    /// A block of `trains` trains after `before` axles.
    pub fn block(&self, before: u64, trains: u64) -> Block {
        let position = self.position(before);
        let (begun, done) = (self.sequence.counts(position), self.sequence.counts(position + trains));
        let mut runs = Vec::new();
        for (kind, (train, _)) in self.kinds().enumerate() {
            let (first, end) = (begun[kind], done[kind]);
            let forward = match train.runs {
                Runs::Forward => end - first,
                Runs::Backward => 0,
                // the first of every two trains runs forward
                Runs::BothWays => end.div_ceil(2) - first.div_ceil(2),
            };
            let of = |direction, trains| (Runner { kind, direction }, trains);
            runs.extend([of(Direction::Forward, forward), of(Direction::Backward, end - first - forward)]);
        }
        runs.retain(|(_, trains)| *trains > 0);
        let axles = runs.iter().map(|(runner, trains)| trains * self.kind(runner.kind).0.axles()).sum();
        Block { before, axles, runs }
    }

    /// The block that begins after `before` axles; one train if the length of the block depends on forces.
    pub fn next_block(&self, before: u64) -> Block {
        self.block(before, self.wanted(before).unwrap_or(1))
    }

    /// The passages over the track after `axles` axles; `trains` is the expected number of trains in the next block.
    pub fn due(&self, axles: u64, trains: u64) -> Due {
        let adaptive = self.adaptive().is_some();
        let mut passages = if axles == self.total {
            self.leading()
        } else if adaptive && self.tamped_after(axles).next().is_some() {
            Vec::new() // no train runs before the track is lifted
        } else {
            self.block(axles, trains).runners()
        };
        let shown = if self.recorded.binary_search(&axles).is_ok() { self.shown(&passages) } else { Vec::new() };
        let missing: Vec<Runner> = shown.iter().filter(|shown| !passages.contains(shown)).copied().collect();
        passages.extend(missing);
        Due { passages, shown }
    }

    /// The recorded passages: one for each kind of train, in its leading direction unless only the other direction
    /// runs.
    fn shown(&self, passages: &[Runner]) -> Vec<Runner> {
        let of = |leading: Runner| {
            let mut same = passages.iter().filter(|runner| runner.kind == leading.kind);
            let (first, second) = (same.next().copied(), same.next());
            first.filter(|_| second.is_none()).unwrap_or(leading)
        };
        self.leading().into_iter().map(of).collect()
    }

    /// Divides a block into parts that keep the order of its trains.
    pub fn parts(&self, block: &Block) -> Vec<Block> {
        let trains = block.trains();
        let mixed = block.runs.iter().any(|(runner, _)| runner.kind != block.runs[0].0.kind);
        if !mixed {
            return vec![block.clone()];
        }
        let parts = trains.min(PARTS);
        let mut before = block.before;
        let part = |k: u64| {
            let part = self.block(before, (k + 1) * trains / parts - k * trains / parts);
            before += part.axles;
            part
        };
        (0..parts).map(part).collect()
    }

    /// Divides a block into steps that settle the track by about the same amount: settlement grows about as the cube
    /// root of the number of trains.
    pub fn steps(&self, block: &Block) -> Vec<Block> {
        let (first, last) = (self.position(block.before), self.position(block.before + block.axles));
        let roots = [first, last].map(|position| (position as f64).cbrt());
        let end = |step: u64| (roots[0] + (roots[1] - roots[0]) * step as f64 / STEPS as f64).powi(3).round() as u64;
        let mut steps = Vec::new();
        let (mut position, mut before) = (first, block.before);
        for step in 1..=STEPS {
            let end = if step == STEPS { last } else { end(step).clamp(position, last) };
            if end > position {
                let step = self.block(before, end - position);
                (position, before) = (end, before + step.axles);
                steps.push(step);
            }
        }
        steps
    }

    /// The blocks of a run whose policy does not depend on forces; `None` for an adaptive policy.
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

    /// The same traffic with another leading kind of train, so that results for the leading train can be asked for each
    /// kind.
    pub fn led_by(&self, kind: usize) -> Blocks {
        let mut blocks = self.clone();
        let Some(other) = kind.checked_sub(1).filter(|other| *other < blocks.others.len()) else { return blocks };
        std::mem::swap(&mut blocks.train, &mut blocks.others[other].0);
        std::mem::swap(&mut blocks.passage, &mut blocks.others[other].1);
        blocks.sequence.shares.swap(0, kind);
        blocks
    }
}

impl Block {
    pub fn trains(&self) -> u64 {
        self.runs.iter().map(|(_, trains)| trains).sum()
    }

    /// Place of the mean forces of its trains between the forces at its start (0) and after its last train (1): each
    /// train meets the forces that the trains before it have left.
    pub fn middle(&self) -> f64 {
        let trains = self.trains().max(1) as f64;
        0.5 * (trains - 1.0) / trains
    }

    /// Number of trains of all kinds in a direction.
    pub fn towards(&self, direction: Direction) -> u64 {
        self.runs.iter().filter(|(runner, _)| runner.direction == direction).map(|(_, trains)| trains).sum()
    }

    /// The passages that represent its trains.
    pub fn runners(&self) -> Vec<Runner> {
        self.runs.iter().map(|(runner, _)| *runner).collect()
    }
}
