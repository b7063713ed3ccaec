//! The riding train: any number of vehicles. Only vehicles that are at least partly on the track move.
//!
//! Wheels before and behind the track stand on the continuation of the track ([`Under`]). A vehicle that does not act
//! on the track keeps its motion; before the track it stays at rest.

use super::limit::{LightestRail, StepLimit};
use super::ride_state::RideState;
use super::rider::Rider;
use super::state::LeapfrogState;
use super::under::{Beyond, Under};
use crate::linalg::banded::SymmetricBanded;
use crate::solvers::track::ends::end_unknown;
use crate::solvers::track::error::{TrackError, TrackParameter, Wild};
use crate::solvers::track::mesh::Track;
use crate::solvers::track::motion::Timetable;
use crate::solvers::track::{Motion, Train};

/// A train on its way.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    timetable: Timetable,
    /// +1 or -1.
    sign: f64,
    riders: Vec<Rider>,
    limit: Option<StepLimit>,
    /// Chainages between which a wheel acts on the track, m.
    felt: [f64; 2],
}

impl Ride {
    /// A train whose leading wheel is at `start` (m) when it begins.
    pub fn new(
        track: &Track,
        mass: &SymmetricBanded,
        beyond: &Beyond,
        train: &Train,
        motion: &Motion,
        start: f64,
    ) -> Result<Self, TrackError> {
        train.check()?;
        let sign = train.direction.sign();
        let reach = |end: usize| beyond[end].map_or(0.0, |continuation| continuation.reach());
        let felt = [track.model.ends[0] - reach(0), track.model.ends[1] + reach(1)];
        let exit = felt[usize::from(sign > 0.0)] + sign * train.wheel_base();
        // A train that has left the track goes on at its last speed.
        let timetable = motion.timetable(start, exit, sign)?;
        let gravity = track.model.gravity;
        let rail = LightestRail::new(track, mass);
        let vehicles = train.vehicles.iter();
        let limit = vehicles.filter_map(|(vehicle, _)| rail.limit(vehicle, gravity)).min_by(StepLimit::shorter);
        let mut first_wheel = 0;
        let mut riders = Vec::with_capacity(train.vehicles.len());
        for (vehicle, offset) in &train.vehicles {
            riders.push(Rider::new(vehicle, *offset, first_wheel, gravity)?);
            first_wheel += vehicle.wheels.len();
        }
        Ok(Self { timetable, sign, riders, limit, felt })
    }

    /// Fails if a wheel stands on the track, or has passed it, when the ride begins.
    pub fn check_start(&self, track: &Track, start: f64) -> Result<(), TrackError> {
        let entry = track.model.ends[usize::from(self.sign < 0.0)];
        if self.sign * (entry - start) > 0.0 {
            return Ok(());
        }
        let name = TrackParameter::Train("place of the leading wheel at the start");
        Err(TrackError::Parameter { name, value: start, expected: "before the track" })
    }

    /// The time from which the last wheel does not act on the track any more, s since the ride began.
    pub fn duration(&self) -> f64 {
        self.timetable.duration
    }

    pub fn limit(&self) -> Option<StepLimit> {
        self.limit
    }

    pub fn set_time_step(&mut self, time_step: f64) -> Result<(), TrackError> {
        self.riders.iter_mut().try_for_each(|rider| rider.set_time_step(time_step))
    }

    /// All vehicles at rest far before the track.
    pub fn standing(&self, track: &Track, beyond: &Beyond, state: &LeapfrogState) -> Result<RideState, TrackError> {
        let ground = [0, 1].map(|end| state.displacement[end_unknown(track, end)]);
        let entry = usize::from(self.sign < 0.0);
        let far = Under::wheel_at(track, beyond, &state.level, ground, self.felt[entry] - self.sign);
        let level = far.surface(&state.displacement) + track.model.irregularity.depth_at(track.model.ends[entry]);
        let mut ride = RideState { began: state.time, ground, ..RideState::default() };
        for rider in &self.riders {
            let x = rider.position(0, self.timetable.position(0.0), self.sign);
            let (body, wheels) = rider.standing(level, far.compliance, x)?;
            ride.bodies.push(body);
            ride.wheels.extend(wheels);
        }
        Ok(ride)
    }

    /// Chainage of every wheel at a time since the ride began (s), vehicle by vehicle, m.
    pub fn positions(&self, time: f64) -> impl Iterator<Item = f64> + '_ {
        let (leading, sign) = (self.timetable.position(time), self.sign);
        self.riders.iter().flat_map(move |rider| rider.positions(leading, sign))
    }

    /// Presses the wheels on the rail at its present position, adds their forces to `nodal`, and moves the vehicles by
    /// one step of the set length.
    pub fn step(
        &mut self,
        track: &Track,
        beyond: &Beyond,
        state: &mut LeapfrogState,
        nodal: &mut [f64],
    ) -> Result<(), TrackError> {
        let leading = self.timetable.position(state.time - state.ride.began);
        let [left, right] = track.model.ends;
        for (rider, body) in self.riders.iter_mut().zip(&mut state.ride.bodies) {
            let [first, last] = rider.reach(leading, self.sign);
            if last < self.felt[0] || first > self.felt[1] {
                continue;
            }
            let wheels = &mut state.ride.wheels[rider.wheels()];
            rider.begin();
            for (w, wheel) in wheels.iter_mut().enumerate() {
                let x = rider.position(w, leading, self.sign);
                let under = Under::wheel_at(track, beyond, &state.level, state.ride.ground, x);
                let unevenness = track.model.irregularity.depth_at(x.clamp(left, right));
                let approach = rider.place(w, body) - under.surface(&state.displacement) - unevenness;
                let force = rider.press(w, wheel, approach, under.compliance, state.last_step);
                if !rider.bears(w, force) {
                    let (step, time, what) = (state.steps as usize, state.time, Wild::WheelForce(force));
                    return Err(TrackError::Unstable { step, time, x, what });
                }
                if under.is_felt() {
                    under.press(force, nodal);
                    state.on_rail.push((x, force));
                }
            }
            rider.advance(body, state.last_step);
        }
        Ok(())
    }
}
