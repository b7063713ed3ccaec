//! What a run will take, before it runs: counts of unknowns and steps, times a measured cost.

use crate::graph::{Estimate, Schedule, TrackNode};

/// Seconds a step and unknown of one passage on one core, as `cargo bench --bench track_passage` shows.
const SECONDS: f64 = 2.5e-8;

pub(super) fn estimate(node: &TrackNode, schedule: &Schedule) -> Estimate {
    let unknowns = unknowns(node);
    let bytes = unknowns as u64 * 6_000; // bands and the windows of the inverse
    match schedule {
        Schedule::Static { .. } => Estimate { unknowns, passages: 0, steps: 0, seconds: 0.01, bytes },
        Schedule::Blocks(b) => {
            let passages: u64 = b.blocks.iter().map(|block| b.passages(block).len() as u64).sum::<u64>() + 1;
            let run = b.passage.right - b.passage.left - b.train.wheel_base();
            let steps = (run / *b.train.speed / b.passage.time_step).ceil() as u64 * passages;
            let unknowns = unknowns + 10 * b.train.vehicles.len();
            Estimate { unknowns, passages, steps, seconds: steps as f64 * unknowns as f64 * SECONDS, bytes }
        }
    }
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
