//! The effect of the wheel forces within one time step: on each other, through rail and vehicle, and on the sleepers.
//!
//! Wheels are ranked from left to right. The displacement by a wheel force decays within about a metre. So a row of the
//! compliance goes back to the first wheel that is near or on the same vehicle; the size of the matrix grows with the
//! length of the train, not with its square.

use super::influence::Stepper;
use super::mesh::RailPoint;
use crate::linalg::skyline::Skyline;
use crate::linalg::vector::add_scaled;
use nalgebra::DMatrix;

/// The compliances of the wheels at their present points. Lists run over ranks.
#[derive(Debug, Clone, Default)]
pub(super) struct Reach {
    pub wheels: Vec<RankedWheel>,
    /// Drop of a wheel into the rail per force of another, m/N.
    pub compliance: Skyline,
    /// Per vehicle: drop of its wheels per wheel force, m/N.
    vehicles: Vec<DMatrix<f64>>,
}

/// A wheel and the displacements by its force.
#[derive(Debug, Clone)]
pub(super) struct RankedWheel {
    /// Its index in the order of the train.
    pub wheel: usize,
    vehicle: usize,
    /// Its index among the wheels of its vehicle.
    within: usize,
    /// Rank of the leftmost wheel of its vehicle.
    pub vehicle_first: usize,
    /// The first unknown of the track that its force displaces, and the last unknown of its element.
    pub from: usize,
    pub end: usize,
    /// Number of sleepers left of it.
    pub sleepers_left: usize,
    /// First sleeper that its force displaces, and displacements of the sleepers from there, m/N.
    pub at_sleepers: (usize, Vec<f64>),
}

impl RankedWheel {
    /// Displacement of a sleeper per force of the wheel, m/N.
    #[inline]
    pub fn at_sleeper(&self, sleeper: usize) -> f64 {
        let (first, values) = &self.at_sleepers;
        values.get(sleeper.wrapping_sub(*first)).copied().unwrap_or(0.0)
    }
}

impl Reach {
    /// Sets the drop of a vehicle's wheels per wheel force, m/N.
    pub fn set_vehicle(&mut self, vehicle: usize, compliance: DMatrix<f64>) {
        self.vehicles[vehicle] = compliance;
    }

    /// Wheels at `positions` (m), vehicle by vehicle with the drop of its wheels per wheel force.
    pub fn new(vehicles: Vec<DMatrix<f64>>, positions: &[f64]) -> Self {
        let mut wheels: Vec<RankedWheel> = Vec::with_capacity(positions.len());
        for (vehicle, compliance) in vehicles.iter().enumerate() {
            let first = wheels.len();
            wheels.extend((0..compliance.nrows()).map(|within| RankedWheel {
                wheel: first + within,
                vehicle,
                within,
                vehicle_first: 0,
                from: 0,
                end: 0,
                sleepers_left: 0,
                at_sleepers: (0, Vec::new()),
            }));
        }
        wheels.sort_by(|a, b| positions[a.wheel].total_cmp(&positions[b.wheel]));
        let mut first_rank = vec![None; vehicles.len()];
        for (rank, wheel) in wheels.iter_mut().enumerate() {
            wheel.vehicle_first = *first_rank[wheel.vehicle].get_or_insert(rank);
        }
        Self { wheels, compliance: Skyline::default(), vehicles }
    }

    /// Gathers the compliances of wheels at `points`, in the order of the train.
    pub fn gather(&mut self, stepper: &Stepper, points: &[RailPoint]) {
        let track = &stepper.track;
        self.compliance.clear();
        for rank in 0..self.wheels.len() {
            let (before, rest) = self.wheels.split_at_mut(rank);
            let wheel = &mut rest[0];
            let point = &points[wheel.wheel];
            let columns = stepper.columns(point.element);
            wheel.from = columns.iter().filter(|c| !c.values.is_empty()).map(|c| c.start).min().unwrap_or(usize::MAX);
            wheel.end = track.element_unknowns(point.element)[3];
            let felt = before.iter().rev().take_while(|other| other.end >= wheel.from).count();
            let row = self.compliance.push_row((rank - felt).min(wheel.vehicle_first));
            let first = rank + 1 - row.len();
            for (entry, q) in row.iter_mut().zip(first..) {
                let other = if q == rank { &*wheel } else { &before[q] };
                let at = &points[other.wheel];
                let unknowns = track.element_unknowns(at.element);
                for (column, shape) in columns.into_iter().zip(point.shape) {
                    for (unknown, other_shape) in unknowns.into_iter().zip(at.shape) {
                        *entry += shape * other_shape * column.entry(unknown);
                    }
                }
                if q == rank {
                    *entry += point.local_compliance;
                } else if at.element == point.element {
                    *entry += track.local_deflection(at, point);
                }
                if other.vehicle == wheel.vehicle {
                    *entry += self.vehicles[wheel.vehicle][(wheel.within, other.within)];
                }
            }
            wheel.gather_sleepers(stepper, point);
        }
    }
}

impl RankedWheel {
    fn gather_sleepers(&mut self, stepper: &Stepper, point: &RailPoint) {
        let track = &stepper.track;
        let left = |s: usize| track.seat_nodes[track.sleepers[s].seat] <= point.element;
        while self.sleepers_left < track.sleepers.len() && left(self.sleepers_left) {
            self.sleepers_left += 1;
        }
        while self.sleepers_left > 0 && !left(self.sleepers_left - 1) {
            self.sleepers_left -= 1;
        }
        let columns = stepper.columns_at_sleepers(point.element);
        let reached = columns.iter().filter(|c| !c.values.is_empty());
        let start = reached.clone().map(|c| c.start).min().unwrap_or(0);
        let end = reached.clone().map(|c| c.end()).max().unwrap_or(start);
        let (first, values) = &mut self.at_sleepers;
        *first = start;
        values.clear();
        values.resize(end - start, 0.0);
        for (column, shape) in columns.into_iter().zip(point.shape).filter(|(c, _)| !c.values.is_empty()) {
            add_scaled(&mut values[column.start - start..], &column.values, shape);
        }
    }
}
