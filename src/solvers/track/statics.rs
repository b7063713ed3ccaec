//! The track at rest: gravity, point loads and standing vehicles, on supports that may have lost contact.
//!
//! The energy of the track is convex and quadratic in pieces, one for each set of closed supports. Starting from all closed,
//! each iteration factors the banded stiffness of its set, solves, and moves the supports that contradict it; after
//! [`FLIP_ALL`] of these only the first contradiction is moved, which cannot cycle. Wheels enter by the compliance of that
//! track at their places and share one Newton iteration with the unknowns of their vehicles.

use super::contact::{hertz_force, hertz_indentation, hertz_stiffness};
use super::ends;
use super::mesh::{FootUnknown, RailPoint, Track};
use super::vehicle::{UNKNOWNS, VehicleVector, WHEEL, WHEELS};
use super::{RailEnds, TrackError, TrackLevel, Train};
use crate::linalg::banded::BandedFactor;
use nalgebra::{DMatrix, DVector};

/// What stands on the track besides its own weight.
#[derive(Debug, Clone, Copy, Default)]
pub struct Loads<'a> {
    /// Chainage (m) and force (N, down) on the rail.
    pub rail: &'a [(f64, f64)],
    /// Index of a seat with a sleeper and force (N, down) on that sleeper.
    pub sleepers: &'a [(usize, f64)],
    /// A train with its leading wheel at this chainage, m.
    pub train: Option<(&'a Train, f64)>,
}

/// An equilibrium of the track. Lists run over nodes, seats or wheels as the fields say; all positive down.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticState {
    /// Per node, m, from the track as built.
    pub rail_deflection: Vec<f64>,
    /// Per node, rad.
    pub rail_slope: Vec<f64>,
    /// Per node, N m, sagging positive.
    pub rail_moment: Vec<f64>,
    /// Force of the rail on the pad, per seat, N.
    pub seat_loads: Vec<f64>,
    /// Force of the sleeper on its support, per seat, N; 0 for seats without a sleeper.
    pub contact_forces: Vec<f64>,
    /// Displacement of sleeper or slab under each seat, m, from the track as built; 0 for rigid seats.
    pub foot_displacements: Vec<f64>,
    /// Per wheel, vehicle by vehicle, N.
    pub wheel_forces: Vec<f64>,
    pub balance: Balance,
    /// Sets of closed supports that were tried.
    pub iterations: usize,
    /// All unknowns of the track.
    pub(super) unknowns: Vec<f64>,
    /// Per sleeper.
    pub(super) closed: Vec<bool>,
    pub(super) vehicles: Vec<VehicleVector>,
    /// Hertz indentation per wheel, m.
    pub(super) indentations: Vec<f64>,
    pub(super) on_rail: Vec<(RailPoint, f64)>,
}

/// The sums of forces in an equilibrium, N, loads downward and supports upward.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Gravity on rails, sleepers and vehicles, and the point loads; a slab lies at rest under its own weight already.
    pub loads: f64,
    /// Of the sleepers' supports.
    pub sleeper_supports: f64,
    pub rigid_seats: f64,
    /// Beyond the slabs' own weight.
    pub slab_foundations: f64,
    pub rail_ends: f64,
}

impl Balance {
    /// All supports together, N.
    pub fn supports(&self) -> f64 {
        self.sleeper_supports + self.rigid_seats + self.slab_foundations + self.rail_ends
    }
}

/// Further nodal forces, for states that move: the track's and each vehicle's.
#[derive(Debug, Clone, Default)]
pub(super) struct Inertia {
    pub track: Vec<f64>,
    pub vehicles: Vec<VehicleVector>,
}

/// Iterations that move every contradicting support at once.
const FLIP_ALL: usize = 20;
const NEWTON_LIMIT: usize = 60;
/// Wheel forces are converged to this part of the mean one.
const FORCE_TOLERANCE: f64 = 1e-13;
/// Gaps below this are none, m.
const GAP_TOLERANCE: f64 = 1e-14;

/// Finds the equilibrium of the track at `level` under gravity and `loads`.
///
/// Fails where a load stands off the track, where something moves without resistance, or where no set of closed supports is
/// in equilibrium after ten times as many iterations as there are sleepers.
pub fn solve_static(track: &Track, level: &TrackLevel, loads: &Loads) -> Result<StaticState, TrackError> {
    solve_with_inertia(track, level, loads, &Inertia::default())
}

pub(super) fn solve_with_inertia(
    track: &Track,
    level: &TrackLevel,
    loads: &Loads,
    inertia: &Inertia,
) -> Result<StaticState, TrackError> {
    track.check_level(level)?;
    let mut forces = track.own_forces(level);
    for (force, extra) in forces.iter_mut().zip(&inertia.track) {
        *force += extra;
    }
    let mut on_rail = Vec::new();
    for &(x, force) in loads.rail {
        let point = track.rail_point(x)?;
        track.add_force(&point, force, &mut forces);
        on_rail.push((point, force));
    }
    for &(seat, force) in loads.sleepers {
        match track.feet.get(seat) {
            Some(FootUnknown::Sleeper(s)) => forces[track.sleepers[*s].unknown] += force,
            _ => {
                return Err(TrackError::Parameter {
                    name: "loaded seat",
                    value: seat as f64,
                    expected: "with a sleeper",
                });
            }
        }
    }
    let mut wheels = StandingTrain::new(track, loads.train, inertia)?;

    let mut closed = vec![true; track.sleepers.len()];
    let mut before = closed.clone();
    let (limit, mut one_by_one, mut last_change) = (FLIP_ALL + 10 * closed.len().max(5), false, 0.0);
    for iteration in 1..=limit {
        one_by_one |= iteration > FLIP_ALL;
        let factor = match factor(track, &closed) {
            Ok(factor) => factor,
            Err(row) => {
                if one_by_one || closed == before {
                    return Err(TrackError::Mechanism { x: track.place_of(row) });
                }
                // Too many supports opened at once.
                one_by_one = true;
                closed.clone_from(&before);
                continue;
            }
        };
        let unknowns = wheels.solve(track, level, &closed, &factor, &forces)?;
        before.clone_from(&closed);
        let mut consistent = true;
        for (s, sleeper) in track.sleepers.iter().enumerate() {
            let gap = unknowns[sleeper.unknown] - level.settlements[sleeper.seat];
            let wrong = if closed[s] { gap < -GAP_TOLERANCE } else { gap > GAP_TOLERANCE };
            if wrong && (consistent || !one_by_one) {
                closed[s] = !closed[s];
                consistent = false;
                last_change = track.model.seats[sleeper.seat].x;
            }
        }
        if consistent {
            on_rail.extend(wheels.points.iter().copied().zip(wheels.forces.iter().copied()));
            let applied: f64 = loads.rail.iter().map(|l| l.1).chain(loads.sleepers.iter().map(|l| l.1)).sum();
            return Ok(describe(track, level, unknowns, closed, on_rail, wheels, applied, iteration));
        }
    }
    Err(TrackError::NoEquilibrium { x: last_change, iterations: limit })
}

/// Factors the stiffness with the open supports removed; fails with the row of a mechanism.
fn factor(track: &Track, closed: &[bool]) -> Result<BandedFactor, usize> {
    let mut stiffness = track.stiffness.clone();
    for (sleeper, _) in track.sleepers.iter().zip(closed).filter(|(_, closed)| !**closed) {
        stiffness.add(sleeper.unknown, sleeper.unknown, -sleeper.support_stiffness);
    }
    for (unknown, _) in &track.held {
        stiffness.pin(*unknown);
    }
    stiffness.factor().map_err(|e| e.row)
}

/// `K u` for a set of closed supports, without the held unknowns' reactions.
fn subtract_stiffness(track: &Track, closed: &[bool], u: &[f64], y: &mut [f64]) {
    track.stiffness.subtract_product(u, y);
    for (sleeper, _) in track.sleepers.iter().zip(closed).filter(|(_, closed)| !**closed) {
        y[sleeper.unknown] += sleeper.support_stiffness * u[sleeper.unknown];
    }
}

/// The wheels of a train at rest, with what the last solve found.
struct StandingTrain<'a> {
    train: Option<&'a Train>,
    leading: f64,
    weights: Vec<VehicleVector>,
    points: Vec<RailPoint>,
    forces: Vec<f64>,
    indentations: Vec<f64>,
    vehicles: Vec<VehicleVector>,
}

impl<'a> StandingTrain<'a> {
    fn new(track: &Track, train: Option<(&'a Train, f64)>, inertia: &Inertia) -> Result<Self, TrackError> {
        let mut standing = Self {
            train: None,
            leading: 0.0,
            weights: Vec::new(),
            points: Vec::new(),
            forces: Vec::new(),
            indentations: Vec::new(),
            vehicles: Vec::new(),
        };
        let Some((train, leading)) = train else { return Ok(standing) };
        train.check()?;
        let gravity = track.model.gravity;
        if gravity == 0.0 && !train.vehicles.is_empty() {
            return Err(TrackError::Parameter { name: "gravity", value: gravity, expected: "above 0 under a train" });
        }
        (standing.train, standing.leading) = (Some(train), leading);
        for (i, (vehicle, _)) in train.vehicles.iter().enumerate() {
            let extra = inertia.vehicles.get(i).copied().unwrap_or_else(VehicleVector::zeros);
            standing.weights.push(vehicle.weight(gravity) + extra);
            let share = vehicle.mass() * gravity / WHEELS as f64;
            standing.forces.extend([share; WHEELS]);
            standing.indentations.extend([hertz_indentation(vehicle.hertz, share); WHEELS]);
        }
        for x in train.wheel_positions(leading) {
            standing.points.push(track.rail_point(x)?);
        }
        standing.vehicles = vec![VehicleVector::zeros(); train.vehicles.len()];
        Ok(standing)
    }

    /// Solves track and vehicles for one set of closed supports; returns the unknowns of the track.
    fn solve(
        &mut self,
        track: &Track,
        level: &TrackLevel,
        closed: &[bool],
        factor: &BandedFactor,
        forces: &[f64],
    ) -> Result<Vec<f64>, TrackError> {
        let mut held = vec![0.0; track.order()];
        for (unknown, end) in &track.held {
            held[*unknown] = end.map_or(0.0, |end| level.ends[end]);
        }
        let mut steady = forces.to_vec();
        for (sleeper, _) in track.sleepers.iter().zip(closed).filter(|(_, closed)| **closed) {
            steady[sleeper.unknown] += sleeper.support_stiffness * level.settlements[sleeper.seat];
        }
        let solve = |forces: &mut Vec<f64>| {
            for (unknown, _) in &track.held {
                forces[*unknown] = 0.0;
            }
            factor.solve_in_place(forces);
        };
        let mut free = steady.clone();
        subtract_stiffness(track, closed, &held, &mut free);
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
        // One refinement: equilibrium to rounding, whatever the condition of the beam.
        subtract_stiffness(track, closed, &free, &mut steady);
        solve(&mut steady);
        for (u, correction) in free.iter_mut().zip(&steady) {
            *u += correction;
        }
        Ok(free)
    }

    /// Newton iteration for wheel forces and vehicles: `K_v y + F = weight`, `y_wheel - w_rail(F) = indentation(F)`.
    fn stand(&mut self, track: &Track, free: &[f64], columns: &[Vec<f64>]) -> Result<(), TrackError> {
        let Some(train) = self.train else { return Ok(()) };
        let wheels = self.points.len();
        let order = wheels + UNKNOWNS * train.vehicles.len();
        let compliance = DMatrix::from_fn(wheels, wheels, |j, k| {
            let local = if j == k { self.points[j].local_compliance } else { 0.0 };
            track.deflection_at(&self.points[j], &columns[k]) + local
        });
        let level: Vec<f64> = self.points.iter().map(|p| track.deflection_at(p, free)).collect();
        let mechanism = TrackError::Mechanism { x: self.leading };
        for _ in 0..NEWTON_LIMIT {
            let (mut matrix, mut rhs) = (DMatrix::zeros(order, order), DVector::zeros(order));
            for (v, (vehicle, _)) in train.vehicles.iter().enumerate() {
                // Forces in units of a stiff spring's, so that all rows are of one size.
                let unit = vehicle.primary_stiffness;
                let first = wheels + UNKNOWNS * v;
                let (stiffness, _) = vehicle.suspension();
                matrix.view_mut((first, first), (UNKNOWNS, UNKNOWNS)).copy_from(&(stiffness / unit));
                rhs.rows_mut(first, UNKNOWNS).copy_from(&(self.weights[v] / unit));
                let mut standing = 0;
                for w in 0..WHEELS {
                    let j = WHEELS * v + w;
                    matrix[(first + WHEEL + w, j)] = 1.0;
                    let indentation = self.indentations[j];
                    if indentation <= 0.0 {
                        matrix[(j, j)] = 1.0;
                        continue;
                    }
                    standing += 1;
                    let tangent = hertz_stiffness(vehicle.hertz, indentation);
                    matrix[(j, first + WHEEL + w)] = -1.0;
                    for (k, (other, _)) in (0..wheels).map(|k| (k, &train.vehicles[k / WHEELS])) {
                        matrix[(j, k)] = compliance[(j, k)] * other.primary_stiffness;
                    }
                    matrix[(j, j)] += unit / tangent;
                    rhs[j] = hertz_force(vehicle.hertz, indentation) / tangent - indentation - level[j];
                }
                if standing < 2 {
                    return Err(mechanism);
                }
            }
            if !matrix.lu().solve_mut(&mut rhs) || rhs.iter().any(|value| !value.is_finite()) {
                return Err(mechanism);
            }
            let mut converged = true;
            for (v, (vehicle, _)) in train.vehicles.iter().enumerate() {
                let first = wheels + UNKNOWNS * v;
                self.vehicles[v] = VehicleVector::from_iterator(rhs.rows(first, UNKNOWNS).iter().copied());
                let scale = vehicle.mass() * track.model.gravity / WHEELS as f64;
                for w in 0..WHEELS {
                    let j = WHEELS * v + w;
                    let force = rhs[j] * vehicle.primary_stiffness;
                    let rail: f64 = level[j]
                        + (0..wheels)
                            .map(|k| compliance[(j, k)] * rhs[k] * train.vehicles[k / WHEELS].0.primary_stiffness)
                            .sum::<f64>();
                    self.indentations[j] = self.vehicles[v][WHEEL + w] - rail;
                    self.forces[j] = force;
                    let law = hertz_force(vehicle.hertz, self.indentations[j]);
                    converged &= (law - force).abs()
                        <= FORCE_TOLERANCE * scale
                            + hertz_stiffness(vehicle.hertz, self.indentations[j]) * GAP_TOLERANCE;
                }
            }
            if converged {
                return Ok(());
            }
        }
        Err(TrackError::NoEquilibrium { x: self.leading, iterations: NEWTON_LIMIT })
    }
}

#[expect(clippy::too_many_arguments, reason = "it only moves what the solve found into its result")]
fn describe(
    track: &Track,
    level: &TrackLevel,
    unknowns: Vec<f64>,
    closed: Vec<bool>,
    on_rail: Vec<(RailPoint, f64)>,
    wheels: StandingTrain,
    point_loads: f64,
    iterations: usize,
) -> StaticState {
    let model = &track.model;
    let u = &unknowns;
    let rail_deflection: Vec<f64> = track.rail.iter().map(|w| u[*w]).collect();
    let moment = |node: usize| {
        let clamping: f64 = on_rail.iter().map(|(point, force)| track.clamping_moment(node, point, *force)).sum();
        track.cubic_moment(node, u) + clamping
    };
    let foot_displacements: Vec<f64> = track
        .feet
        .iter()
        .map(|foot| match foot {
            FootUnknown::Sleeper(s) => u[track.sleepers[*s].unknown],
            FootUnknown::Slab { unknown } => u[*unknown],
            FootUnknown::Rigid => 0.0,
        })
        .collect();
    let seat_loads: Vec<f64> = (0..model.seats.len())
        .map(|i| model.seats[i].pad_stiffness * (rail_deflection[track.seat_nodes[i]] - foot_displacements[i]))
        .collect();
    let mut contact_forces = vec![0.0; model.seats.len()];
    for (sleeper, _) in track.sleepers.iter().zip(&closed).filter(|(_, closed)| **closed) {
        let gap = u[sleeper.unknown] - level.settlements[sleeper.seat];
        contact_forces[sleeper.seat] = (sleeper.support_stiffness * gap).max(0.0);
    }

    let vehicle_weight: f64 = wheels.weights.iter().map(|w| w[0] + w[2] + w[4] + w.rows(WHEEL, WHEELS).sum()).sum();
    let mut reactions = track.weight.clone();
    for (point, force) in &on_rail {
        track.add_force(point, *force, &mut reactions);
    }
    track.stiffness.subtract_product(u, &mut reactions);
    let balance = Balance {
        loads: track.dead_weight + vehicle_weight + point_loads,
        sleeper_supports: contact_forces.iter().sum(),
        rigid_seats: (0..model.seats.len())
            .filter(|i| track.feet[*i] == FootUnknown::Rigid)
            .map(|i| seat_loads[i])
            .sum(),
        slab_foundations: slab_reactions(track, u),
        rail_ends: track
            .held
            .iter()
            .filter(|(_, end)| end.is_some())
            .map(|(unknown, _)| reactions[*unknown])
            .sum::<f64>()
            + if model.rail_ends == RailEnds::Absorbing { ends::carried(track, level, u) } else { 0.0 },
    };
    StaticState {
        rail_slope: track.rail.iter().map(|w| u[*w + 1]).collect(),
        rail_moment: (0..track.nodes.len()).map(moment).collect(),
        rail_deflection,
        seat_loads,
        contact_forces,
        foot_displacements,
        wheel_forces: wheels.forces,
        balance,
        iterations,
        unknowns,
        closed,
        vehicles: wheels.vehicles,
        indentations: wheels.indentations,
        on_rail,
    }
}

fn slab_reactions(track: &Track, u: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (slab, mesh) in track.model.slabs.iter().zip(&track.slabs) {
        for (unknowns, beam) in mesh.elements(&track.nodes, slab.bending_stiffness) {
            let load = beam.even_load(slab.foundation_stiffness);
            sum += unknowns.into_iter().zip(load).map(|(unknown, load)| load * u[unknown]).sum::<f64>();
        }
    }
    sum
}

impl StaticState {
    /// Deflection of the rail at x, m, from the track as built; exact between nodes under point loads. Fails off the track.
    pub fn rail_deflection_at(&self, track: &Track, x: f64) -> Result<f64, TrackError> {
        let point = track.rail_point(x)?;
        let beam = &track.elements[point.element].beam;
        let local: f64 = self
            .on_rail
            .iter()
            .filter(|(load, _)| load.element == point.element)
            .map(|(load, force)| force * beam.clamped_deflection(point.offset, load.offset))
            .sum();
        Ok(track.deflection_at(&point, &self.unknowns) + local)
    }
}
