//! A vehicle of a riding train: the scheme of the track for the few unknowns of the vehicle, with a dense `M̂`.

use super::BETA;
use crate::solvers::track::Multibody;
use crate::solvers::track::contact::WheelLaw;
use crate::solvers::track::error::{TrackError, TrackParameter};
use crate::solvers::track::passage::{WILD_FORCE, within};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Newton steps after which the search for a state of rest of a vehicle on level ground fails.
const NEWTON_LIMIT: usize = 60;
/// Wheels are at rest if they move by less than this share of their displacement.
const ROUNDING: f64 = 1e-14;

/// A vehicle. Lists run over its unknowns or its wheels.
#[derive(Debug, Clone)]
pub(super) struct Rider {
    vehicle: Multibody,
    /// Distances of the wheels behind the leading wheel of the train, m.
    offsets: Vec<f64>,
    first_wheel: usize,
    /// Constant forces, N.
    weight: Vec<f64>,
    /// Limit of the wheel forces, N; a larger force means that the motion is unstable.
    force_limit: f64,
    time_step: f64,
    /// `M̂⁻¹`.
    inverse: DMatrix<f64>,
    forces: DVector<f64>,
}

/// The motion of a vehicle: displacement at the present time, velocity half a step and acceleration a step before.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct BodyState {
    pub displacement: DVector<f64>,
    pub velocity: DVector<f64>,
    pub acceleration: DVector<f64>,
}

/// The state of a wheel at the time of its last force.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct WheelState {
    /// N.
    pub force: f64,
    /// m, and its rate over the step before, m/s.
    pub indentation: f64,
    pub rate: f64,
}

impl Rider {
    /// A vehicle whose first wheel is `offset` (m) behind the first of the train.
    pub fn new(vehicle: &Multibody, offset: f64, first_wheel: usize, gravity: f64) -> Result<Self, TrackError> {
        let load = vehicle.wheel_load(gravity);
        if vehicle.order() > 0 && load <= 0.0 {
            let name = TrackParameter::Vehicle("weight of a vehicle");
            let expected = "above 0: gravity or a force that holds it down";
            return Err(TrackError::Parameter { name, value: load, expected });
        }
        let order = vehicle.order();
        Ok(Self {
            offsets: vehicle.wheels.iter().map(|wheel| offset + wheel.offset).collect(),
            first_wheel,
            weight: vehicle.weight(gravity),
            force_limit: WILD_FORCE * load,
            time_step: 0.0,
            inverse: DMatrix::zeros(order, order),
            forces: DVector::zeros(order),
            vehicle: vehicle.clone(),
        })
    }

    /// Its wheels among all of the train.
    pub fn wheels(&self) -> Range<usize> {
        self.first_wheel..self.first_wheel + self.offsets.len()
    }

    /// Chainage of a wheel with the leading wheel of the train at `leading`, m.
    #[inline]
    pub fn position(&self, wheel: usize, leading: f64, sign: f64) -> f64 {
        leading - sign * self.offsets[wheel]
    }

    /// Places of all its wheels, m.
    pub fn positions(&self, leading: f64, sign: f64) -> impl Iterator<Item = f64> + use<'_> {
        self.offsets.iter().map(move |offset| leading - sign * offset)
    }

    /// Chainages between which its wheels stand, m.
    pub fn reach(&self, leading: f64, sign: f64) -> [f64; 2] {
        self.positions(leading, sign).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
    }

    /// Prepares steps of another length, s; fails if an unknown has neither mass nor spring.
    pub fn set_time_step(&mut self, time_step: f64) -> Result<(), TrackError> {
        let vehicle = &self.vehicle;
        let mut matrix = 0.5 * time_step * &vehicle.damping + BETA * time_step * time_step * &vehicle.stiffness;
        for (i, mass) in vehicle.masses.iter().enumerate() {
            matrix[(i, i)] += mass;
        }
        self.inverse = matrix.cholesky().map(|factor| factor.inverse()).ok_or(TrackError::Parameter {
            name: TrackParameter::Vehicle("unknowns of a vehicle"),
            value: vehicle.order() as f64,
            expected: "that each have a mass or a spring",
        })?;
        self.time_step = time_step;
        Ok(())
    }

    /// State of rest on ground at `level` (m) that yields by `compliance` (m/N), at x (m):
    /// `K y + Σ F(y_w - level) e_w = weight` by Newton's method.
    pub fn standing(&self, level: f64, compliance: f64, x: f64) -> Result<(BodyState, Vec<WheelState>), TrackError> {
        let (vehicle, order) = (&self.vehicle, self.vehicle.order());
        let mean_load = self.force_limit / WILD_FORCE;
        let laws: Vec<WheelLaw> = vehicle.wheels.iter().map(|wheel| WheelLaw::at_rest(wheel.contact)).collect();
        let carrying = || vehicle.wheels.iter().enumerate().filter_map(|(w, wheel)| Some((w, wheel.unknown?)));
        let mut approach: Vec<f64> =
            laws.iter().map(|law| law.indentation(mean_load) + compliance * mean_load).collect();
        let mut displacement = DVector::zeros(order);
        let (mut settled, mut iterations) = (order == 0, 0);
        while !settled {
            if iterations == NEWTON_LIMIT {
                return Err(TrackError::NoEquilibrium { x, iterations });
            }
            let mut stiffness = vehicle.stiffness.clone();
            let mut forces = DVector::from_column_slice(&self.weight);
            for (w, unknown) in carrying() {
                let indentation = laws[w].behind(approach[w], compliance);
                let slope = laws[w].stiffness(indentation);
                let slope = slope / (1.0 + compliance * slope);
                stiffness[(unknown, unknown)] += slope;
                forces[unknown] -= laws[w].force(indentation) - slope * (approach[w] + level);
            }
            let factor = stiffness.cholesky().ok_or(TrackError::Mechanism { x })?;
            displacement = factor.solve(&forces);
            settled = true;
            for (w, unknown) in carrying() {
                let next = displacement[unknown] - level;
                settled &= within(next - approach[w], ROUNDING * (next.abs() + displacement[unknown].abs()));
                approach[w] = next;
            }
            iterations += 1;
        }
        let standing = |(law, approach): (&WheelLaw, f64)| {
            let indentation = law.behind(approach, compliance);
            WheelState { force: law.force(indentation), indentation, rate: 0.0 }
        };
        let wheels = laws.iter().zip(approach).map(standing).collect();
        let zeros = DVector::zeros(order);
        Ok((BodyState { displacement, velocity: zeros.clone(), acceleration: zeros }, wheels))
    }

    /// Begins a step with the constant forces.
    pub fn begin(&mut self) {
        self.forces.as_mut_slice().copy_from_slice(&self.weight);
    }

    /// Displacement of a wheel, m; 0 under a given force.
    pub fn place(&self, wheel: usize, body: &BodyState) -> f64 {
        self.vehicle.wheels[wheel].unknown.map_or(0.0, |unknown| body.displacement[unknown])
    }

    /// Whether a wheel force (N) is within its limit.
    pub fn bears(&self, wheel: usize, force: f64) -> bool {
        self.vehicle.wheels[wheel].unknown.is_none() || within(force, self.force_limit)
    }

    /// Force of a wheel that approaches the rail nodes by `approach` (m) if the rail yields by `compliance` (m/N)
    /// relative to the nodes, `last_step` (s) after the time of `state`.
    pub fn press(
        &mut self,
        wheel: usize,
        state: &mut WheelState,
        approach: f64,
        compliance: f64,
        last_step: f64,
    ) -> f64 {
        let Multibody { wheels, .. } = &self.vehicle;
        let contact = wheels[wheel].contact;
        let law = if last_step > 0.0 {
            WheelLaw::in_step(contact, state.indentation, last_step * state.rate, last_step)
        } else {
            WheelLaw::at_rest(contact)
        };
        let indentation = law.behind(approach, compliance);
        if last_step > 0.0 {
            state.rate = (indentation - state.indentation) / last_step;
        }
        (state.force, state.indentation) = (law.force(indentation), indentation);
        if let Some(unknown) = wheels[wheel].unknown {
            self.forces[unknown] -= state.force;
        }
        state.force
    }

    /// `M̂ a = F - C v - K u`, then the kick and the drift.
    pub fn advance(&mut self, body: &mut BodyState, last_step: f64) {
        self.forces.gemv(-1.0, &self.vehicle.damping, &body.velocity, 1.0);
        self.forces.gemv(-1.0, &self.vehicle.stiffness, &body.displacement, 1.0);
        body.acceleration.gemv(1.0, &self.inverse, &self.forces, 0.0);
        body.velocity.axpy(0.5 * (last_step + self.time_step), &body.acceleration, 1.0);
        body.displacement.axpy(self.time_step, &body.velocity, 1.0);
    }
}
