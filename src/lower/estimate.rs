//! What a run will take, before it runs: counts of unknowns and steps, times a measured cost.

use super::outlook::Outlook;
use crate::graph::{Estimate, PassagePlan, Schedule, TrackNode};
use crate::scenario::Train;

/// Seconds a step and unknown of one passage on one core, as `cargo bench --bench track_passage` shows.
const SECONDS: f64 = 2.5e-8;

pub(super) fn estimate(node: &TrackNode, schedule: &Schedule, outlook: &Outlook) -> Estimate {
    let unknowns = unknowns(node);
    let bytes = unknowns as u64 * 6_000; // bands and the windows of the inverse
    let Outlook { blocks, axles, passages: of_kinds } = outlook;
    let passages = of_kinds.iter().sum();
    let base = Estimate { unknowns, blocks: *blocks, block_axles: *axles, passages, steps: 0, seconds: 0.01, bytes };
    let Schedule::Blocks(scheduled) = schedule else { return base };
    let steps_of = |train: &Train, plan: &PassagePlan| {
        let run = plan.right - plan.left - train.wheel_base();
        (run / *train.speed / plan.usual_step()).ceil() as u64
    };
    let mut sum = Estimate { seconds: 0.0, ..base };
    for ((train, plan), passages) in scheduled.kinds().zip(of_kinds) {
        let (steps, unknowns) = (passages * steps_of(train, plan), unknowns + 10 * train.vehicles.len());
        sum.unknowns = sum.unknowns.max(unknowns);
        sum.steps += steps;
        sum.seconds += (steps * unknowns as u64) as f64 * SECONDS;
    }
    sum
}

/// Rail and slab nodes have two unknowns each, a sleeper one.
fn unknowns(node: &TrackNode) -> usize {
    let track = &node.track;
    let elements = node.elements_per_bay as usize;
    let bays = track.seats.len() + 1;
    let slab_seats = track.seats.iter().filter(|s| s.foot == crate::scenario::Foot::Slab).count();
    let sleepers = track.seats.iter().filter(|s| s.is_ballasted()).count();
    2 * (bays * elements + 1) + 2 * slab_seats * elements + sleepers
}
