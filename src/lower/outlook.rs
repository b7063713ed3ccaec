//! Estimate of the blocks of a run before it runs. Prescribed blocks are known, except blocks that overshoot. Adaptive
//! blocks are chosen as in the run, on the track beside its transitions under standing wheels.

use super::dry_run::DryRun;
use super::memo::Memo;
use crate::graph::{Blocks, Runner, SupportNode, TrackNode};
use crate::solvers::settlement::Law;

/// Number of adaptive blocks that are computed one by one; later blocks are extrapolated.
const FOLLOWED: u64 = 120;

/// Estimates of the last plans with adaptive blocks.
static ADAPTIVE: Memo<(TrackNode, Vec<SupportNode>, Law, Blocks), Outlook> = Memo::new(8);

/// Blocks and passages of a run.
#[derive(Clone, Default)]
pub(super) struct Outlook {
    pub blocks: u64,
    /// Axles of the shortest and of the longest block.
    pub axles: [u64; 2],
    /// Passages of each kind of train.
    pub passages: Vec<u64>,
    /// Sum of the errors of settlement of the blocks, m; 0 for prescribed blocks, because only the run can tell.
    pub error: f64,
    /// Largest settlement at any time, m; 0 for prescribed blocks.
    pub settled: f64,
}

impl Outlook {
    pub fn new(track: &TrackNode, supports: &[SupportNode], law: &Law, blocks: &Blocks) -> Outlook {
        if blocks.adaptive().is_none() {
            return Outlook::made(track, supports, law, blocks);
        }
        let input = (track.clone(), supports.to_vec(), *law, blocks.clone());
        ADAPTIVE.get(input, |(track, supports, law, blocks)| Outlook::made(track, supports, law, blocks))
    }

    fn made(track: &TrackNode, supports: &[SupportNode], law: &Law, blocks: &Blocks) -> Outlook {
        let kinds = blocks.others.len() + 1;
        let mut outlook =
            Outlook { blocks: 0, axles: [u64::MAX, 0], passages: vec![0; kinds], error: 0.0, settled: 0.0 };
        let mut dry = blocks.adaptive().map(|accuracy| DryRun::new(track, supports, law, blocks, accuracy));
        let mut before = 0;
        while before < blocks.total {
            if dry.is_some() && outlook.blocks == FOLLOWED {
                return outlook.going_on(before, blocks.total);
            }
            let tamped = blocks.tamped_after(before).next().is_some();
            let expected = blocks.wanted(before).unwrap_or_else(|| blocks.trains_left(before));
            outlook.add(&blocks.due(before, expected).passages);
            if tamped {
                outlook.add(&blocks.block(before, expected).runners());
            }
            let block = match &mut dry {
                Some(dry) => {
                    if tamped {
                        dry.tamp(law);
                    }
                    dry.next(before, |middle| outlook.add(middle))
                }
                None => blocks.block(before, expected),
            };
            outlook.blocks += 1;
            if let Some(dry) = &dry {
                outlook.error = dry.error;
                outlook.settled = outlook.settled.max(dry.settled());
            }
            outlook.axles = [outlook.axles[0].min(block.axles), outlook.axles[1].max(block.axles)];
            before += block.axles;
        }
        outlook.add(&blocks.due(before, 0).passages);
        outlook
    }

    /// Extrapolates to all axles: the blocks keep their average growth with the axles so far.
    fn going_on(mut self, before: u64, total: u64) -> Outlook {
        let begun = self.axles[0].max(1) as f64;
        let times = (total as f64 / begun).ln() / (before as f64 / begun).ln().max(f64::MIN_POSITIVE);
        let more = |count: &mut u64| *count = (*count as f64 * times.max(1.0)) as u64;
        more(&mut self.blocks);
        self.passages.iter_mut().for_each(more);
        self.error *= times.max(1.0);
        self
    }

    fn add(&mut self, runners: &[Runner]) {
        runners.iter().for_each(|runner| self.passages[runner.kind] += 1);
    }
}
