//! The wheels of a train at rest: one Newton iteration for all contacts and vehicles on a track of given compliance.
//!
//! ```text
//! wheel:    δ = y - (w + r + C F),   F = F(δ)
//! vehicle:  K y + F = weight
//! ```
//!
//! w is the rail under the wheel without the train, and C its compliance there. Linearised, `δ = rest + F/F'`, the
//! system is symmetric and quasi-definite. Ordered vehicle by vehicle it is a skyline matrix, as wide as the group of
//! wheels that act on each other.

use super::loads::Inertia;
use super::stiffness::subtract_stiffness;
use crate::linalg::banded::BandedFactor;
use crate::linalg::skyline::Skyline;
use crate::solvers::track::contact::WheelLaw;
use crate::solvers::track::error::{TrackError, TrackParameter};
use crate::solvers::track::mesh::{RailPoint, Track};
use crate::solvers::track::{Multibody, SupportPhase, TrackLevel, Train};

const NEWTON_LIMIT: usize = 60;
/// Wheel forces are converged to this share of the mean force.
const FORCE_TOLERANCE: f64 = 1e-13;
/// Indentations below this count as zero, m.
const INDENTATION_ROUNDING: f64 = 1e-14;
/// A compliance below this share of the compliance of the wheel at its own place counts as zero.
const NEGLIGIBLE: f64 = 1e-18;

/// The wheels of a train at rest, with the results of the last solve. Lists run over wheels, vehicle by vehicle, or
/// over vehicles.
pub(super) struct StandingTrain {
    leading: f64,
    bodies: Vec<Body>,
    pub points: Vec<RailPoint>,
    /// Unevenness of the running surface under the wheel, m.
    unevenness: Vec<f64>,
    laws: Vec<WheelLaw>,
    pub forces: Vec<f64>,
    pub indentations: Vec<f64>,
    pub vehicles: Vec<Vec<f64>>,
}

/// A vehicle at rest.
struct Body {
    vehicle: Multibody,
    /// Constant forces on its unknowns, N.
    weight: Vec<f64>,
    /// Its first wheel among all.
    first_wheel: usize,
    /// Mean force of a wheel, N.
    wheel_load: f64,
}

impl Body {
    /// Its wheels without a given force: their index among all wheels and their unknown.
    fn carrying(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let wheels = self.vehicle.wheels.iter().enumerate();
        wheels.filter_map(|(w, wheel)| Some((self.first_wheel + w, wheel.unknown?)))
    }
}

impl StandingTrain {
    pub fn new(track: &Track, train: Option<(&Train, f64)>, inertia: &Inertia) -> Result<Self, TrackError> {
        let mut standing = Self {
            leading: 0.0,
            bodies: Vec::new(),
            points: Vec::new(),
            unevenness: Vec::new(),
            laws: Vec::new(),
            forces: Vec::new(),
            indentations: Vec::new(),
            vehicles: Vec::new(),
        };
        let Some((train, leading)) = train else { return Ok(standing) };
        train.check()?;
        standing.leading = leading;
        for (i, (vehicle, _)) in train.vehicles.iter().enumerate() {
            let wheel_load = vehicle.wheel_load(track.model.gravity);
            if vehicle.order() > 0 && wheel_load <= 0.0 {
                return Err(TrackError::Parameter {
                    name: TrackParameter::Vehicle("weight of a vehicle"),
                    value: wheel_load,
                    expected: "above 0: gravity or a force that holds it down",
                });
            }
            let mut weight = vehicle.weight(track.model.gravity);
            if let Some(extra) = inertia.vehicles.get(i) {
                weight.iter_mut().zip(extra).for_each(|(weight, extra)| *weight += extra);
            }
            let first_wheel = standing.laws.len();
            standing.laws.extend(vehicle.wheels.iter().map(|w| WheelLaw::at_rest(w.contact)));
            standing.vehicles.push(vec![0.0; vehicle.order()]);
            for law in &standing.laws[first_wheel..] {
                standing.forces.push(law.given().unwrap_or(wheel_load));
                standing.indentations.push(law.indentation(wheel_load));
            }
            standing.bodies.push(Body { vehicle: vehicle.clone(), weight, first_wheel, wheel_load });
        }
        for x in train.wheel_positions(leading) {
            standing.points.push(track.rail_point(x)?);
            standing.unevenness.push(track.model.irregularity.depth_at(x));
        }
        Ok(standing)
    }

    /// Total static force of the train on the track, N.
    pub fn weight(&self) -> f64 {
        let given: f64 = self.laws.iter().filter_map(WheelLaw::given).sum();
        given + self.bodies.iter().flat_map(|body| &body.weight).sum::<f64>()
    }

    /// Solves track and vehicles with the supports in their phases; returns the unknowns of the track.
    pub fn solve(
        &mut self,
        track: &Track,
        level: &TrackLevel,
        phases: &[SupportPhase],
        factor: &BandedFactor,
        forces: &[f64],
    ) -> Result<Vec<f64>, TrackError> {
        let mut held = vec![0.0; track.order()];
        for (unknown, at) in track.held_at_rest(level) {
            held[unknown] = at;
        }
        let mut steady = forces.to_vec();
        for (sleeper, phase) in track.sleepers.iter().zip(phases) {
            steady[sleeper.unknown] -= sleeper.spring_force(*phase, -level.settlements[sleeper.seat]);
        }
        let solve = |forces: &mut Vec<f64>| {
            for (unknown, _) in track.held_at_rest(level) {
                forces[unknown] = 0.0;
            }
            factor.solve_in_place(forces);
        };
        let mut free = steady.clone();
        subtract_stiffness(track, phases, &held, &mut free);
        solve(&mut free);
        for (u, held) in free.iter_mut().zip(&held) {
            *u += held;
        }
        let columns: Vec<Vec<f64>> = self
            .points
            .iter()
            .map(|point| {
                let mut column = vec![0.0; track.order()];
                track.add_force(point, 1.0, &mut column);
                solve(&mut column);
                column
            })
            .collect();
        self.stand(track, &free, &columns)?;
        for (force, point) in self.forces.iter().zip(&self.points) {
            track.add_force(point, *force, &mut steady);
        }
        for (force, column) in self.forces.iter().zip(&columns) {
            for (u, c) in free.iter_mut().zip(column) {
                *u += force * c;
            }
        }
        // One refinement: gives equilibrium to rounding for any condition number of the beam.
        subtract_stiffness(track, phases, &free, &mut steady);
        solve(&mut steady);
        for (u, correction) in free.iter_mut().zip(&steady) {
            *u += correction;
        }
        Ok(free)
    }

    /// Finds wheel forces, indentations and vehicles on a track. `free` are its unknowns without the train, `columns`
    /// its displacements under a unit force at each wheel.
    fn stand(&mut self, track: &Track, free: &[f64], columns: &[Vec<f64>]) -> Result<(), TrackError> {
        let wheels = self.points.len();
        let surface = |(point, unevenness): (&RailPoint, &f64)| track.deflection_at(point, free) + unevenness;
        let level: Vec<f64> = self.points.iter().zip(&self.unevenness).map(surface).collect();
        let compliance: Vec<Vec<f64>> = (0..wheels)
            .map(|j| {
                let of = |k: usize| track.deflection_at(&self.points[j], &columns[k]) + self.local(track, j, k);
                (0..wheels).map(of).collect()
            })
            .collect();
        let mut system = Skyline::default();
        for _ in 0..NEWTON_LIMIT {
            let mut solution = self.assemble(&mut system, &level, &compliance);
            if system.solve_in_place(&mut solution).is_err() || solution.iter().any(|value| !value.is_finite()) {
                return Err(TrackError::Mechanism { x: self.leading });
            }
            if self.update(&solution, &level, &compliance) {
                return Ok(());
            }
        }
        Err(TrackError::NoEquilibrium { x: self.leading, iterations: NEWTON_LIMIT })
    }

    /// Compliance between two wheels that the cubic of their element leaves out, m/N.
    fn local(&self, track: &Track, j: usize, k: usize) -> f64 {
        if self.points[j].element == self.points[k].element {
            track.local_deflection(&self.points[j], &self.points[k])
        } else {
            0.0
        }
    }

    /// The linearised system and its right-hand side. For each vehicle a row per wheel that carries, then one per
    /// unknown.
    fn assemble(&self, system: &mut Skyline, level: &[f64], compliance: &[Vec<f64>]) -> Vec<f64> {
        let mut rhs = Vec::new();
        let mut row_of_wheel: Vec<Option<usize>> = vec![None; level.len()];
        system.clear();
        for body in &self.bodies {
            let block = rhs.len();
            for (j, _) in body.carrying() {
                let row = rhs.len();
                let floor = NEGLIGIBLE * compliance[j][j];
                let felt = |k: &usize| compliance[j][*k].abs() > floor;
                let first = (0..j).filter(felt).filter_map(|k| row_of_wheel[k]).next().unwrap_or(row);
                row_of_wheel[j] = Some(row);
                let entries = system.push_row(first);
                let line = self.laws[j].touches(self.indentations[j]).then(|| self.laws[j].line(self.indentations[j]));
                let Some((flexibility, rest)) = line else {
                    entries[row - first] = 1.0;
                    rhs.push(0.0);
                    continue;
                };
                for k in 0..=j {
                    // Only wheels in contact; the rows of other wheels are F = 0.
                    let on_rail = self.laws[k].touches(self.indentations[k]);
                    if let Some(column) = row_of_wheel[k].filter(|column| *column >= first && on_rail) {
                        entries[column - first] = compliance[j][k];
                    }
                }
                entries[row - first] += flexibility;
                let given = |k: usize| self.laws[k].given().map_or(0.0, |force| compliance[j][k] * force);
                rhs.push(-level[j] - rest - (0..level.len()).map(given).sum::<f64>());
            }
            let first_unknown = rhs.len();
            for i in 0..body.vehicle.order() {
                let entries = system.push_row(block);
                for (j, unknown) in body.carrying() {
                    let on_rail = self.laws[j].touches(self.indentations[j]);
                    if let Some(column) = row_of_wheel[j].filter(|_| unknown == i && on_rail) {
                        entries[column - block] = -1.0;
                    }
                }
                for k in 0..=i {
                    entries[first_unknown + k - block] = -body.vehicle.stiffness[(i, k)];
                }
                rhs.push(-body.weight[i]);
            }
        }
        rhs
    }

    /// Takes over a solution of the linearised system; returns whether all wheels meet their law.
    fn update(&mut self, solution: &[f64], level: &[f64], compliance: &[Vec<f64>]) -> bool {
        let mut row = 0;
        for (body, unknowns) in self.bodies.iter().zip(&mut self.vehicles) {
            for (j, _) in body.carrying() {
                self.forces[j] = solution[row];
                row += 1;
            }
            unknowns.copy_from_slice(&solution[row..row + body.vehicle.order()]);
            row += body.vehicle.order();
        }
        let mut converged = true;
        for (body, unknowns) in self.bodies.iter().zip(&self.vehicles) {
            for (j, unknown) in body.carrying() {
                let rail: f64 = compliance[j].iter().zip(&self.forces).map(|(c, f)| c * f).sum::<f64>() + level[j];
                let indentation = unknowns[unknown] - rail;
                let rounding = INDENTATION_ROUNDING + f64::EPSILON * (unknowns[unknown].abs() + rail.abs());
                let law = self.laws[j];
                let tolerance = FORCE_TOLERANCE * body.wheel_load + law.stiffness(indentation) * rounding;
                converged &= (law.force(indentation) - self.forces[j]).abs() <= tolerance;
                self.indentations[j] = indentation;
            }
        }
        converged
    }
}
