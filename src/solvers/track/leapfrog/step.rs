//! One step: the forces at its beginning, the kick, the drift.

use super::under::Under;
use super::{Leapfrog, WheelLoads};
use crate::solvers::track::error::{TrackError, TrackParameter, Wild};
use crate::solvers::track::passage::{WILD_DISPLACEMENT, within};

impl Leapfrog {
    /// One step from the present time. `pushes[i]` is the force of the ground on the underside of the i-th carried foot
    /// at the present time, N, positive up.
    ///
    /// Fails if a push is missing or is not a number, and if a value is beyond its limit; then the state must not be
    /// used.
    pub fn step(&mut self, pushes: &[f64], wheels: &WheelLoads<'_>) -> Result<(), TrackError> {
        self.forces.copy_from_slice(&self.track.weight);
        for (end, unknown, pull) in &self.pulls {
            self.forces[*unknown] += pull * self.state.level.ends[*end];
        }
        self.push_feet(pushes)?;
        self.carry_sleepers();
        match wheels {
            WheelLoads::None => self.state.on_rail.clear(),
            WheelLoads::Given(given) => self.load_rail(given)?,
            WheelLoads::Riding => self.ride_on()?,
        }
        self.advance();
        self.keep_account();
        self.advance_level();
        self.check_sense()
    }

    /// Sets the moment of the ground on the i-th carried foot about its middle, N m. A moment above 0 presses the side
    /// of larger x down. It acts in all steps until it is set again. A foot that stays level ignores it.
    pub fn turn(&mut self, i: usize, moment: f64) {
        self.state.turns[i] = moment;
    }

    fn push_feet(&mut self, pushes: &[f64]) -> Result<(), TrackError> {
        if pushes.len() != self.track.carried.len() {
            let (name, value) = (TrackParameter::Load("pushes on carried feet"), pushes.len() as f64);
            return Err(TrackError::Parameter { name, value, expected: "one per carried foot" });
        }
        for ((carried, push), turn) in self.track.carried.iter().zip(pushes).zip(&self.state.turns) {
            self.forces[carried.underside] -= push;
            if let Some(pitch) = carried.pitch {
                self.forces[pitch] += turn;
            }
        }
        self.state.pushes.copy_from_slice(pushes);
        Ok(())
    }

    /// Adds the forces of the supports of ordinary sleepers at the present gaps and velocities.
    fn carry_sleepers(&mut self) {
        let state = &mut self.state;
        let half = 0.5 * state.last_step;
        for (sleeper, support) in self.track.sleepers.iter().zip(&mut state.supports) {
            let i = sleeper.unknown;
            let gap = state.displacement[i] - state.level.settlements[sleeper.seat];
            *support = sleeper.push(gap, state.velocity[i] + half * state.acceleration[i]);
            self.forces[i] -= *support;
        }
    }

    fn load_rail(&mut self, given: &[(f64, f64)]) -> Result<(), TrackError> {
        self.state.on_rail.clear();
        for &(x, force) in given {
            if !(x.is_finite() && force.is_finite()) {
                let name = TrackParameter::Load("place and force of a wheel");
                return Err(TrackError::Parameter { name, value: x + force, expected: "finite numbers" });
            }
            let state = &mut self.state;
            let under = Under::wheel_at(&self.track, &self.beyond, &state.level, state.ride.ground, x);
            if under.is_felt() {
                under.press(force, &mut self.forces);
                state.on_rail.push((x, force));
            }
        }
        Ok(())
    }

    fn ride_on(&mut self) -> Result<(), TrackError> {
        self.state.on_rail.clear();
        let Some(ride) = &mut self.ride else {
            let (name, expected) = (TrackParameter::Train("vehicles"), "of 1 or more: `Leapfrog::ride` begins a ride");
            return Err(TrackError::Parameter { name, value: 0.0, expected });
        };
        ride.step(&self.track, &self.beyond, &mut self.state, &mut self.forces)
    }

    /// `M̂ a = F - C v - K u`, then the kick and the drift.
    fn advance(&mut self) {
        let (state, dt) = (&mut self.state, self.time_step);
        self.damping.subtract_product(&state.velocity, &mut self.forces);
        self.stiffness.subtract_product(&state.displacement, &mut self.forces);
        self.track.held.iter().for_each(|(unknown, _)| self.forces[*unknown] = 0.0);
        self.factor.solve_in_place(&mut self.forces);
        std::mem::swap(&mut state.acceleration, &mut self.forces);
        state.before.copy_from_slice(&state.displacement);
        let kick = 0.5 * (state.last_step + dt);
        let motion = state.displacement.iter_mut().zip(&mut state.velocity).zip(&state.acceleration);
        for ((u, v), a) in motion {
            *v += kick * a;
            *u += dt * *v;
        }
        (state.last_kick, state.last_step) = (kick, dt);
        state.steps += 1;
        state.time += dt;
    }

    /// Fails if a displacement is beyond its limit.
    fn check_sense(&self) -> Result<(), TrackError> {
        let state = &self.state;
        if state.displacement.iter().fold(true, |sound, u| sound & within(*u, WILD_DISPLACEMENT)) {
            return Ok(());
        }
        let unknown = state.displacement.iter().position(|u| !within(*u, WILD_DISPLACEMENT)).unwrap_or(0);
        Err(TrackError::Unstable {
            step: state.steps as usize,
            time: state.time,
            x: self.track.place_of(unknown),
            what: Wild::Displacement(state.displacement[unknown]),
        })
    }
}
