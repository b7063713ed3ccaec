//! Cost of a run of passages, estimated before the run: number of unknowns and steps, times a measured cost.

use super::outlook::Outlook;
use crate::graph::{Blocks, Cost, PassagePlan, PassageWork, Record, TrackFoot, TrackNode, Train, Work};

/// Seconds per time step on one core, and per unknown in a step: a straight line through passages of 400 and of 1300
/// unknowns (`cargo bench --bench track_passage`, `benches/estimates.py`).
const STEP: f64 = 3.5e-6;
const UNKNOWN: f64 = 1.95e-8;
/// Seconds per place of the stiffness profile and per unknown of the track: one equilibrium at each place.
const PLACE: f64 = 3e-8;
/// Places of the stiffness profile in a bay.
const PER_BAY: f64 = 4.0;
/// Seconds per recorded value: kept, written and drawn.
const VALUE: f64 = 1.5e-6;
/// Bytes per recorded value: in its row, and in the columns of the file during writing.
const VALUE_BYTES: f64 = 260.0;
/// Seconds of the equilibrium of a bogie over a seat, and how often it is computed in an adaptive block: twelve steps
/// in the whole block, in each of its halves and in the result.
const STANDING: f64 = 5e-5;
const TIMES: f64 = 51.0;
/// Seconds of a state of rest, and of the tables and pages of any run.
const AT_REST: f64 = 0.01;
const WRITING: f64 = 0.06;
/// Bytes per unknown: bands and the windows of the inverse; and of the program itself.
const BYTES: u64 = 6_000;
const PROGRAM: u64 = 19 << 20;
/// Bytes per value of the forces of sleepers that a passage gives to cells of grains: 2.6 copies
/// (`benches/grain_errors.py`).
const FORCE_BYTES: f64 = 21.0;

/// The cost of a track at rest.
pub(super) fn at_rest(node: &TrackNode) -> Cost {
    let unknowns = unknowns(node);
    cost(AT_REST + WRITING, PassageWork { unknowns, ..PassageWork::default() }, unknowns)
}

/// The cost of the passages of all blocks, of the records and of the files.
pub(super) fn of_blocks(node: &TrackNode, blocks: &Blocks, outlook: &Outlook) -> Cost {
    let unknowns = unknowns(node);
    let Outlook { blocks: count, axles, passages: of_kinds, .. } = outlook;
    let passages = of_kinds.iter().sum();
    let mut work = PassageWork { unknowns, blocks: *count, block_axles: *axles, passages, steps: 0 };
    let mut seconds = 0.0;
    for ((train, plan), passages) in blocks.kinds().zip(of_kinds) {
        let steps = passages * steps(train, plan);
        let unknowns = unknowns + 10 * train.vehicles.len();
        work.unknowns = work.unknowns.max(unknowns);
        work.steps += steps;
        seconds += steps as f64 * (STEP + unknowns as f64 * UNKNOWN);
    }
    if blocks.compared.is_some() {
        let (train, plan) = blocks.kind(0);
        let unknowns = 2 * unknowns + 10 * train.vehicles.len();
        seconds += steps(train, &plan.finer()) as f64 * (STEP + unknowns as f64 * UNKNOWN);
    }
    let standing = standing(node, blocks, *count);
    let profile = (node.seats.len() * unknowns) as f64 * PER_BAY * PLACE;
    let apart = AT_REST + WRITING + blocks.recorded.len() as f64 * profile;
    Cost {
        seconds: seconds + standing + apart,
        seconds_on_two_cores: seconds * side_by_side(blocks) + 0.5 * standing + apart,
        bytes: bytes(unknowns),
        work: Work::Passages(work),
    }
}

/// Bytes of a program with a track.
fn bytes(unknowns: usize) -> u64 {
    PROGRAM + unknowns as u64 * BYTES
}

/// Bytes of the track that drives cells of grains.
pub(super) fn bytes_of_track(node: &TrackNode) -> u64 {
    bytes(unknowns(node))
}

/// Bytes of the forces of all sleepers over a passage.
pub(super) fn bytes_of_forces(seats: usize, (train, plan): (&Train, &PassagePlan)) -> u64 {
    (FORCE_BYTES * seats as f64 * steps(train, plan) as f64) as u64
}

/// Time of standing bogies over all seats on springs in adaptive blocks, s.
fn standing(node: &TrackNode, blocks: &Blocks, count: u64) -> f64 {
    if blocks.adaptive().is_none() {
        return 0.0;
    }
    let bogies: usize = blocks.kinds().map(|(train, _)| train.bogies(node.gravity).len()).sum();
    let seats = node.seats.iter().filter(|seat| seat.is_ballasted()).count();
    count as f64 * TIMES * (bogies * seats) as f64 * STANDING
}

/// Time steps of a passage.
fn steps(train: &Train, plan: &PassagePlan) -> u64 {
    (way(train, plan) / train.speed / plan.usual_step()).ceil() as u64
}

/// Distance that a train runs in a passage, m.
fn way(train: &Train, plan: &PassagePlan) -> f64 {
    plan.right - plan.left - train.wheel_base()
}

/// Time of the passages of one exchange on two cores / time on one core: the passages are independent.
fn side_by_side(blocks: &Blocks) -> f64 {
    let runners = blocks.block(0, blocks.trains_left(0)).runners();
    let time = |kind: usize| {
        let (train, plan) = blocks.kind(kind);
        steps(train, plan) as f64
    };
    let mut times: Vec<f64> = runners.iter().map(|runner| time(runner.kind)).collect();
    times.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = times.iter().sum();
    let mut cores = [0.0; 2];
    for time in times {
        let free = if cores[0] <= cores[1] { 0 } else { 1 };
        cores[free] += time;
    }
    if all > 0.0 { cores[0].max(cores[1]) / all } else { 1.0 }
}

/// Adds the cost of the records: every kept value of a passage.
pub(super) fn with_records(cost: &mut Cost, blocks: &Blocks, records: &[Record]) {
    let of = |record: &Record, (train, plan): (&Train, &PassagePlan)| {
        let near = record.near.map_or(1.0, |near| ((2.0 * near + train.wheel_base()) / way(train, plan)).min(1.0));
        let samples = way(train, plan) / train.speed / (plan.time_step * plan.sample_every as f64);
        (record.quantities.len() * record.seats.len() * record.after.len()) as f64 * near * samples
    };
    let values: f64 = records.iter().map(|record| blocks.kinds().map(|kind| of(record, kind)).sum::<f64>()).sum();
    cost.seconds += values * VALUE;
    cost.seconds_on_two_cores += values * VALUE;
    cost.bytes += (values * VALUE_BYTES) as u64;
}

/// A cost without parallel work.
fn cost(seconds: f64, work: PassageWork, unknowns: usize) -> Cost {
    Cost { seconds, seconds_on_two_cores: seconds, bytes: bytes(unknowns), work: Work::Passages(work) }
}

/// Rail and slab nodes have two unknowns each, a sleeper one.
fn unknowns(node: &TrackNode) -> usize {
    let elements = node.elements_per_bay as usize;
    let bays = node.seats.len() + 1;
    let slab_seats = node.seats.iter().filter(|s| s.foot == TrackFoot::Slab).count();
    let sleepers = node.seats.iter().filter(|s| s.is_ballasted()).count();
    2 * (bays * elements + 1) + 2 * slab_seats * elements + sleepers
}
