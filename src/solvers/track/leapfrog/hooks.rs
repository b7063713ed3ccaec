//! Settings for tests only: starts of passages, steps that are too long, kicks.

use super::Leapfrog;
use super::ride_state::RideState;
use super::rider::{BodyState, WheelState};
use super::riding::Ride;
use crate::solvers::track::{Passage, Train};
use nalgebra::DVector;

impl Leapfrog {
    /// Continues in steps that may be too long, as if the last step had had this length.
    pub(in super::super) fn force_time_step(&mut self, time_step: f64) {
        self.factor = super::factor(&self.track, &self.mass, &self.stiffness, &self.damping, time_step).unwrap();
        if let Some(ride) = &mut self.ride {
            ride.set_time_step(time_step).unwrap();
        }
        (self.time_step, self.state.last_step) = (time_step, time_step);
    }

    /// Adds to the velocity of an unknown, m/s.
    pub(in super::super) fn kick(&mut self, unknown: usize, velocity: f64) {
        self.state.velocity[unknown] += velocity;
    }

    /// Begins like a passage with its leading wheel at `start` (m), vehicles included.
    pub(in super::super) fn start_from(&mut self, passage: &Passage<'_>, train: &Train, start: f64) {
        let (state, half) = (&mut self.state, 0.5 * self.time_step);
        state.last_step = self.time_step;
        state.displacement.clone_from(&passage.displacement);
        state.before.clone_from(&passage.displacement);
        state.acceleration.clone_from(&passage.acceleration);
        for (before, (v, a)) in state.velocity.iter_mut().zip(passage.velocity.iter().zip(&passage.acceleration)) {
            *before = v - half * a;
        }
        let Some((run, _)) = &passage.train else { return };
        let mut ride = Ride::new(&self.track, &self.mass, &self.beyond, train, run.motion, start).unwrap();
        ride.set_time_step(self.time_step).unwrap();
        let vector = |values: &Vec<f64>| DVector::from_column_slice(values);
        let bodies = passage.vehicles.iter().map(|(running, _)| {
            let acceleration = vector(&running.acceleration);
            let velocity = vector(&running.velocity) - half * &acceleration;
            BodyState { displacement: vector(&running.displacement), velocity, acceleration }
        });
        let standing = |indentation: &f64| WheelState { indentation: *indentation, ..WheelState::default() };
        let wheels = passage.interface.indentations.iter().map(standing).collect();
        state.ride = RideState { began: state.time, ground: [0.0; 2], bodies: bodies.collect(), wheels };
        self.ride = Some(ride);
    }
}
