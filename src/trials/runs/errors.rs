//! By how much a run differs from the reference in what people ask for.

use crate::graph::{Graph, Model};
use crate::results::{Run, SleeperRow, common_count};
use serde::Serialize;

/// Seats at this distance are the same, m.
const SAME_PLACE: f64 = 0.01;

/// Differences of a run from the reference at the last count that both have recorded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RunErrors {
    /// Largest difference of settlement at any compared seat / largest settlement of the reference.
    pub settlement: f64,
    /// Difference of the step at the transition / largest settlement of the reference; `None` without a transition.
    pub step: Option<f64>,
    /// Difference of the largest seat load / this load.
    pub seat_load: f64,
    /// Largest difference of the force without a train at any compared seat / the mean of these forces of the whole
    /// track.
    pub gravity: f64,
    /// Difference of the largest or of the smallest wheel force / the largest.
    pub wheel_force: f64,
}

/// A difference, with its name and its key in tables.
pub type Read = (&'static str, &'static str, fn(&RunErrors) -> Option<f64>);

impl RunErrors {
    /// What a chart shows.
    pub const ALL: [Read; 5] = [
        ("settlement", "settlement of any sleeper", |e| Some(e.settlement)),
        ("step", "step at the transition", |e| e.step),
        ("seat_load", "largest seat load", |e| Some(e.seat_load)),
        ("gravity", "contact without a train", |e| Some(e.gravity)),
        ("wheel_force", "wheel force", |e| Some(e.wheel_force)),
    ];

    /// Compares at the seats between two chainages, m. `None` if nothing can be compared.
    pub fn between(run: &Run, reference: &Run, span: [f64; 2]) -> Option<RunErrors> {
        let axles = common_count([run, reference])?;
        let pairs = pairs(run, reference, axles, span);
        let largest = largest(pairs.iter().map(|(_, known)| known.settlement_m.abs()));
        // over the whole track: near a transition some sleepers hang
        let everywhere = self::pairs(reference, reference, axles, [f64::NEG_INFINITY, f64::INFINITY]);
        let weights = everywhere.iter().map(|(row, _)| row.gravity_contact_force_N);
        let mean = weights.sum::<f64>() / everywhere.len() as f64;
        let load = |rows: &mut dyn Iterator<Item = f64>| rows.fold(0.0, f64::max);
        let seat_load = load(&mut pairs.iter().map(|(row, _)| row.max_rail_seat_load_N));
        let known_load = load(&mut pairs.iter().map(|(_, known)| known.max_rail_seat_load_N));
        let worst = |difference: fn(&SleeperRow, &SleeperRow) -> f64| {
            pairs.iter().map(|(row, known)| difference(row, known).abs()).fold(0.0, f64::max)
        };
        let ((low, high), (known_low, known_high)) = (wheel_forces(run)?, wheel_forces(reference)?);
        let step = run.scalar("settlement_step").zip(reference.scalar("settlement_step"));
        (largest > 0.0 && mean > 0.0 && known_load > 0.0 && known_high > 0.0).then(|| RunErrors {
            settlement: worst(|row, known| row.settlement_m - known.settlement_m) / largest,
            step: step.map(|(step, known)| (step - known).abs() / largest),
            seat_load: (seat_load - known_load).abs() / known_load,
            gravity: worst(|row, known| row.gravity_contact_force_N - known.gravity_contact_force_N) / mean,
            wheel_force: (high - known_high).abs().max((low - known_low).abs()) / known_high,
        })
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// Rows of the same ballasted seats of both runs.
fn pairs<'r>(run: &'r Run, reference: &'r Run, axles: u64, span: [f64; 2]) -> Vec<(&'r SleeperRow, &'r SleeperRow)> {
    let rows = |run: &'r Run| SleeperRow::that_count(run.sleepers.iter().filter(|row| row.axles == axles));
    let ballasted: Vec<f64> =
        reference.scenario.track.seats.iter().filter(|seat| seat.is_ballasted()).map(|seat| seat.x).collect();
    let near = |a: f64, b: f64| (a - b).abs() < SAME_PLACE;
    let known = rows(reference)
        .into_iter()
        .filter(|row| row.x_m >= span[0] && row.x_m <= span[1] && ballasted.iter().any(|x| near(*x, row.x_m)));
    let others = rows(run);
    known.filter_map(|known| Some((*others.iter().find(|row| near(row.x_m, known.x_m))?, known))).collect()
}

/// Smallest and largest wheel force of the last passage.
fn wheel_forces(run: &Run) -> Option<(f64, f64)> {
    let block = run.blocks.last()?;
    Some((block.min_wheel_force_N, block.max_wheel_force_N))
}

/// Chainages between which runs are compared, m: over the sleepers on grains of the reference, or everywhere.
pub fn compared(reference: &Graph) -> [f64; 2] {
    let seats = |node: &crate::graph::Node| match &node.model {
        Model::Grains(grains) => grains
            .stretches
            .iter()
            .flat_map(|stretch| stretch.sleepers.iter().filter(|sleeper| !sleeper.buffer).map(|sleeper| sleeper.seat))
            .collect(),
        _ => Vec::new(),
    };
    let places: Vec<f64> = reference
        .track()
        .map(|track| reference.nodes.iter().flat_map(seats).map(|seat| track.seats[seat].x).collect())
        .unwrap_or_default();
    if places.is_empty() {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    [places.iter().copied().fold(f64::INFINITY, f64::min), places.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}
