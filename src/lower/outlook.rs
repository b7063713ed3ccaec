//! What a run will do block by block, before it runs. Prescribed blocks are known, but for those that overshoot; adaptive ones
//! are chosen as the run will choose them, on one seat that stands for the worst.

use crate::graph::{Block, Blocks, Control, Runner, SupportNode, Train};
use crate::solvers::settlement::{Law, Peak, SupportState};

/// Share of a static wheel load that the worst seat bears: lambda s / 2 of a beam on springs, and a little for what is dynamic.
const SEAT_SHARE: f64 = 0.42;
/// Share of its stiffness by which a seat loses force as it settles, since the track beside it settles less: that at which
/// this dry run has about as many passages as the adaptive scenes of `scenarios/`, planned and run: `sleepers` 15 and 13, `usp`, `pads`
/// and `wedge` 15 and 15, `bridge` 88 and 122.
const UNEVEN: f64 = 0.12;
/// Adaptive blocks that are followed one by one; what goes on longer goes on as before.
const FOLLOWED: u64 = 1000;

/// What a run consists of.
#[derive(Default)]
pub(super) struct Outlook {
    pub blocks: u64,
    /// Axles of the shortest and of the longest block.
    pub axles: [u64; 2],
    /// Passages of each kind of train.
    pub passages: Vec<u64>,
}

impl Outlook {
    pub fn new(supports: &[SupportNode], gravity: f64, law: &Law, blocks: &Blocks) -> Outlook {
        let kinds = blocks.others.len() + 1;
        let mut outlook = Outlook { blocks: 0, axles: [u64::MAX, 0], passages: vec![0; kinds] };
        let mut seat = blocks.adaptive().map(|accuracy| WorstSeat::new(supports, gravity, law, blocks, accuracy));
        let mut before = 0;
        while before < blocks.total {
            if seat.is_some() && outlook.blocks == FOLLOWED {
                return outlook.going_on(blocks.total as f64 / before as f64);
            }
            let tamped = blocks.tamped_after(before).next().is_some();
            let expected = blocks.wanted(before).unwrap_or_else(|| blocks.trains_left(before));
            outlook.add(&blocks.due(before, expected).passages);
            if tamped {
                outlook.add(&blocks.block(before, expected).runners());
            }
            let block = match &mut seat {
                Some(seat) => {
                    if tamped {
                        seat.state = law.fresh();
                    }
                    seat.next(before, |middle| outlook.add(middle))
                }
                None => blocks.block(before, expected),
            };
            outlook.blocks += 1;
            outlook.axles = [outlook.axles[0].min(block.axles), outlook.axles[1].max(block.axles)];
            before += block.axles;
        }
        outlook.add(&blocks.due(before, 0).passages);
        outlook
    }

    /// The same for so many times as many axles.
    fn going_on(mut self, times: f64) -> Outlook {
        let more = |count: &mut u64| *count = (*count as f64 * times) as u64;
        more(&mut self.blocks);
        self.passages.iter_mut().for_each(more);
        self
    }

    fn add(&mut self, runners: &[Runner]) {
        runners.iter().for_each(|runner| self.passages[runner.kind] += 1);
    }
}

/// The seat whose settlement chooses the blocks.
struct WorstSeat<'a> {
    blocks: &'a Blocks,
    tolerance: f64,
    cap: Option<f64>,
    /// Stiffness of its support, N/m.
    stiffness: f64,
    /// For each kind of train: static contact forces, N, and how many vehicles of a train press so.
    forces: Vec<Vec<(f64, u64)>>,
    state: SupportState,
    control: Control,
}

impl<'a> WorstSeat<'a> {
    fn new(
        supports: &[SupportNode],
        gravity: f64,
        law: &Law,
        blocks: &'a Blocks,
        (tolerance, cap): (f64, Option<f64>),
    ) -> Self {
        let stiffness = supports.iter().find_map(|support| Some(support.spring?.stiffness));
        WorstSeat {
            blocks,
            tolerance,
            cap,
            stiffness: stiffness.unwrap_or(1.0),
            // without sleepers nothing settles
            forces: blocks.kinds().map(|(train, _)| stiffness.map_or(Vec::new(), |_| forces(train, gravity))).collect(),
            state: law.fresh(),
            control: Control::default(),
        }
    }

    /// The next block, as the adaptive step of a run finds it; `middle` is told the passages of every attempt.
    fn next(&mut self, before: u64, mut middle: impl FnMut(&[Runner])) -> Block {
        let left = self.blocks.trains_left(before);
        let mut most = left;
        loop {
            let trains = self.control.choose(most, left, |trains| self.settled(&self.blocks.block(before, trains)));
            let block = self.blocks.block(before, trains);
            let whole = self.after(&self.state, &block, 0.0);
            let settled = whole.settlement() - self.state.settlement();
            if trains > 1 {
                middle(&block.runners());
                let half = self.blocks.block(before, trains / 2);
                let rest = self.blocks.block(before + half.axles, trains - trains / 2);
                let lost = UNEVEN * self.stiffness * self.settled(&half);
                let halves = self.after(&self.after(&self.state, &half, 0.0), &rest, lost);
                let error = (halves.settlement() - whole.settlement()).abs();
                self.control.learn(error, settled, self.tolerance, self.cap);
                if trains > 2 && error > self.tolerance {
                    most = (trains / 2).max(2);
                    continue;
                }
            }
            self.state = whole;
            return block;
        }
    }

    /// What a block settles, m.
    fn settled(&self, block: &Block) -> f64 {
        self.after(&self.state, block, 0.0).settlement() - self.state.settlement()
    }

    /// The seat after a block under forces that are smaller by `lost`, N.
    fn after(&self, from: &SupportState, block: &Block, lost: f64) -> SupportState {
        let mut state = from.clone();
        for (runner, trains) in &block.runs {
            for (force, vehicles) in &self.forces[runner.kind] {
                let force = force - lost;
                let peak = Peak { force, deflection: force / self.stiffness };
                state.load(&[peak; 4], trains * vehicles);
            }
        }
        state
    }
}

/// Static contact forces under the vehicles of a train, N, those that are alike counted together.
fn forces(train: &Train, gravity: f64) -> Vec<(f64, u64)> {
    let mut forces: Vec<(f64, u64)> = Vec::new();
    for (vehicle, _) in &train.vehicles {
        let force = SEAT_SHARE * vehicle.mass() / 4.0 * gravity;
        match forces.iter_mut().find(|(known, _)| *known == force) {
            Some((_, vehicles)) => *vehicles += 1,
            None => forces.push((force, 1)),
        }
    }
    forces
}
