//! What a run will take, before it runs: counts of unknowns and steps, times a measured cost.

use crate::graph::{Blocks, Estimate, PassagePlan, Schedule, TrackNode};
use crate::scenario::{Direction, Train};

/// Seconds a step and unknown of one passage on one core, as `cargo bench --bench track_passage` shows.
const SECONDS: f64 = 2.5e-8;

pub(super) fn estimate(node: &TrackNode, schedule: &Schedule) -> Estimate {
    let unknowns = unknowns(node);
    let bytes = unknowns as u64 * 6_000; // bands and the windows of the inverse
    match schedule {
        Schedule::Static { .. } => Estimate { unknowns, passages: 0, steps: 0, seconds: 0.01, bytes },
        Schedule::Blocks(b) => {
            let passages = passages(b);
            let kinds = b.others.len() as u64 + 1;
            let steps_of = |(train, plan): (&Train, &PassagePlan)| {
                let run = plan.right - plan.left - train.wheel_base();
                (run / *train.speed / plan.usual_step()).ceil() as u64
            };
            let steps = b.kinds().map(steps_of).sum::<u64>() * passages / kinds;
            let vehicles = b.kinds().map(|(train, _)| train.vehicles.len()).max().unwrap_or(0);
            let unknowns = unknowns + 10 * vehicles;
            Estimate { unknowns, passages, steps, seconds: steps as f64 * unknowns as f64 * SECONDS, bytes }
        }
    }
}

/// Passages of a run; of an adaptive one an expectation, from what runs of the shipped scenes took.
pub(super) fn passages(blocks: &Blocks) -> u64 {
    match blocks.planned() {
        Some(planned) => {
            planned.iter().map(|block| block.runs.len() as u64).sum::<u64>() + blocks.others.len() as u64 + 1
        }
        None => {
            let trains = blocks.sequence.trains();
            let directions = |train: &Train| if train.direction == Direction::Both { 2 } else { 1 };
            let directions: u64 = blocks.kinds().map(|(train, _)| directions(train)).sum();
            (directions * (1.0 + 3.0 * (trains as f64).ln()).ceil() as u64).min(directions * trains)
                + blocks.others.len() as u64
                + 1
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
