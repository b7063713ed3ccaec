//! The train that rides: any number of vehicles, of which those move that are on the track or partly so.
//!
//! Level ground carries the wheels before and behind the track, at the level of the rail's unloaded ends. A vehicle whose wheels
//! are all off the track keeps its motion: before the track that is its rest.

use super::limit::{LightestRail, StepLimit};
use super::rider::{BodyState, Rider, WheelState};
use super::state::LeapfrogState;
use crate::solvers::track::error::{TrackError, TrackParameter, Wild};
use crate::solvers::track::mesh::Track;
use crate::solvers::track::motion::Timetable;
use crate::solvers::track::{Motion, Train};
use serde::{Deserialize, Serialize};

/// A train on its way.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    timetable: Timetable,
    /// +1 or -1.
    sign: f64,
    riders: Vec<Rider>,
    limit: Option<StepLimit>,
}

/// The motion of a train. Lists run over vehicles or wheels.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct RideState {
    /// When it began, s.
    pub began: f64,
    /// Levels of the ground before the left and behind the right end, m.
    pub ground: [f64; 2],
    pub bodies: Vec<BodyState>,
    pub wheels: Vec<WheelState>,
}

impl RideState {
    /// Numbers of vehicles and wheels.
    pub fn shape(&self) -> [usize; 2] {
        [self.bodies.len(), self.wheels.len()]
    }

    /// Per wheel, N.
    pub fn forces(&self) -> impl Iterator<Item = f64> + '_ {
        self.wheels.iter().map(|wheel| wheel.force)
    }
}

impl Ride {
    /// A train whose leading wheel is at `start` (m) when it begins.
    pub fn new(track: &Track, train: &Train, motion: &Motion, start: f64) -> Result<Self, TrackError> {
        train.check()?;
        let sign = train.direction.sign();
        let exit = track.model.ends[usize::from(sign > 0.0)] + sign * train.wheel_base();
        // A train that has left goes on at its last speed.
        let timetable = motion.timetable(start, exit, sign)?;
        let gravity = track.model.gravity;
        let rail = LightestRail::new(track);
        let vehicles = train.vehicles.iter();
        let limit = vehicles.filter_map(|(vehicle, _)| rail.limit(vehicle, gravity)).min_by(StepLimit::shorter);
        let mut first_wheel = 0;
        let mut riders = Vec::with_capacity(train.vehicles.len());
        for (vehicle, offset) in &train.vehicles {
            riders.push(Rider::new(vehicle, *offset, first_wheel, gravity)?);
            first_wheel += vehicle.wheels.len();
        }
        Ok(Self { timetable, sign, riders, limit })
    }

    /// Fails where a wheel stands on the track, or has passed it, when the ride begins.
    pub fn check_start(&self, track: &Track, start: f64) -> Result<(), TrackError> {
        let entry = track.model.ends[usize::from(self.sign < 0.0)];
        if self.sign * (entry - start) > 0.0 {
            return Ok(());
        }
        let name = TrackParameter::Train("place of the leading wheel at the start");
        Err(TrackError::Parameter { name, value: start, expected: "before the track" })
    }

    /// When the last wheel has left the track, s since the ride began.
    pub fn duration(&self) -> f64 {
        self.timetable.duration
    }

    pub fn limit(&self) -> Option<StepLimit> {
        self.limit
    }

    pub fn set_time_step(&mut self, time_step: f64) -> Result<(), TrackError> {
        self.riders.iter_mut().try_for_each(|rider| rider.set_time_step(time_step))
    }

    /// All vehicles at rest on level ground.
    pub fn standing(&self, track: &Track, state: &LeapfrogState) -> Result<RideState, TrackError> {
        let ends = [track.rail[0], track.rail[track.rail.len() - 1]];
        let ground = ends.map(|unknown| state.displacement[unknown]);
        let entry = usize::from(self.sign < 0.0);
        let level = ground[entry] + track.model.irregularity.depth_at(track.model.ends[entry]);
        let mut ride = RideState { began: state.time, ground, ..RideState::default() };
        for rider in &self.riders {
            let x = rider.position(0, self.timetable.position(0.0), self.sign);
            let (body, wheels) = rider.standing(level, x)?;
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

    /// Presses the wheels on the rail as it lies at the present time, adds their forces to `nodal`, and moves the vehicles on
    /// by a step of the length that was set.
    pub fn step(&mut self, track: &Track, state: &mut LeapfrogState, nodal: &mut [f64]) -> Result<(), TrackError> {
        let leading = self.timetable.position(state.time - state.ride.began);
        let [left, right] = track.model.ends;
        for (rider, body) in self.riders.iter_mut().zip(&mut state.ride.bodies) {
            let [first, last] = rider.reach(leading, self.sign);
            if last < left || first > right {
                continue;
            }
            let wheels = &mut state.ride.wheels[rider.wheels()];
            rider.begin();
            for (w, wheel) in wheels.iter_mut().enumerate() {
                let x = rider.position(w, leading, self.sign);
                let under = track.rail_point(x).ok();
                let surface = match &under {
                    Some(point) => track.deflection_at(point, &state.displacement),
                    None => state.ride.ground[usize::from(x > left)],
                };
                let unevenness = track.model.irregularity.depth_at(x.clamp(left, right));
                let compliance = under.map_or(0.0, |point| point.local_compliance);
                let approach = rider.place(w, body) - surface - unevenness;
                let force = rider.press(w, wheel, approach, compliance, state.last_step);
                if !rider.bears(w, force) {
                    let (step, time, what) = (state.steps as usize, state.time, Wild::WheelForce(force));
                    return Err(TrackError::Unstable { step, time, x, what });
                }
                if let Some(point) = &under {
                    track.add_force(point, force, nodal);
                    state.on_rail.push((x, force));
                }
            }
            rider.advance(body, state.last_step);
        }
        Ok(())
    }
}
