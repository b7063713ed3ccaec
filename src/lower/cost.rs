//! What a run of passages will take, before it runs: counts of unknowns and steps, times a measured cost.

use super::outlook::Outlook;
use crate::graph::{Blocks, Cost, PassagePlan, PassageWork, TrackFoot, TrackNode, Train, Work};

/// Seconds a step and unknown of one passage on one core, as `cargo bench --bench track_passage` shows.
const SECONDS: f64 = 2.5e-8;
/// Seconds of a state of rest.
const AT_REST: f64 = 0.01;
/// Bytes an unknown: bands and the windows of the inverse.
const BYTES: u64 = 6_000;

/// The cost of a track at rest.
pub(super) fn at_rest(node: &TrackNode) -> Cost {
    let unknowns = unknowns(node);
    cost(AT_REST, PassageWork { unknowns, ..PassageWork::default() }, unknowns)
}

/// The cost of the passages of all blocks.
pub(super) fn of_blocks(node: &TrackNode, blocks: &Blocks, outlook: &Outlook) -> Cost {
    let unknowns = unknowns(node);
    let Outlook { blocks: count, axles, passages: of_kinds } = outlook;
    let passages = of_kinds.iter().sum();
    let mut work = PassageWork { unknowns, blocks: *count, block_axles: *axles, passages, steps: 0 };
    let steps_of = |train: &Train, plan: &PassagePlan| {
        let run = plan.right - plan.left - train.wheel_base();
        (run / train.speed / plan.usual_step()).ceil() as u64
    };
    let mut seconds = 0.0;
    for ((train, plan), passages) in blocks.kinds().zip(of_kinds) {
        let (steps, unknowns) = (passages * steps_of(train, plan), unknowns + 10 * train.vehicles.len());
        work.unknowns = work.unknowns.max(unknowns);
        work.steps += steps;
        seconds += (steps * unknowns as u64) as f64 * SECONDS;
    }
    cost(seconds, work, unknowns)
}

/// Passages run one after the other but for those of one exchange, so that a second core is not counted on.
fn cost(seconds: f64, work: PassageWork, unknowns: usize) -> Cost {
    Cost { seconds, seconds_on_two_cores: seconds, bytes: unknowns as u64 * BYTES, work: Work::Passages(work) }
}

/// Rail and slab nodes have two unknowns each, a sleeper one.
fn unknowns(node: &TrackNode) -> usize {
    let elements = node.elements_per_bay as usize;
    let bays = node.seats.len() + 1;
    let slab_seats = node.seats.iter().filter(|s| s.foot == TrackFoot::Slab).count();
    let sleepers = node.seats.iter().filter(|s| s.is_ballasted()).count();
    2 * (bays * elements + 1) + 2 * slab_seats * elements + sleepers
}
