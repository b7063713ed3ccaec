//! The results of a track in motion: its feet at the present time, and the whole track at the time of the last forces.

use super::Leapfrog;
use crate::solvers::track::mesh::{CarriedSleeper, FootUnknown, Track};

/// The motion of a carried sleeper or its underside; positive down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootMotion {
    /// At the present time, m relative to the track as built.
    pub level: f64,
    /// Half a step before, m/s.
    pub velocity: f64,
    /// One step before, m/s^2.
    pub acceleration: f64,
    /// Velocity at the present time by extrapolation, m/s: `v_{n-1/2} + ½ Δt a_{n-1}`.
    pub present_velocity: f64,
}

/// The track at the time of the forces of the last step: all values belong to one full step and are of second order.
/// Displacements and forces are positive down unless said otherwise.
#[derive(Debug, Clone, Copy)]
pub struct LeapfrogView<'a> {
    leapfrog: &'a Leapfrog,
}

impl Leapfrog {
    /// The i-th carried sleeper.
    pub fn sleeper(&self, i: usize) -> FootMotion {
        self.motion(self.track.carried[i].unknown)
    }

    /// The underside of the i-th carried sleeper, on which the ground pushes; the sleeper itself if it has no pad.
    pub fn underside(&self, i: usize) -> FootMotion {
        self.motion(self.track.carried[i].underside)
    }

    /// Rotation of the i-th carried sleeper, rad as the slope of the rail: down with x. None if the sleeper stays
    /// level.
    pub fn pitch(&self, i: usize) -> Option<FootMotion> {
        self.track.carried[i].pitch.map(|unknown| self.motion(unknown))
    }

    /// Moment of the ground on the i-th carried foot in the last step, N m.
    pub fn turned(&self, i: usize) -> f64 {
        self.state.turns[i]
    }

    fn motion(&self, unknown: usize) -> FootMotion {
        let state = &self.state;
        let (velocity, acceleration) = (state.velocity[unknown], state.acceleration[unknown]);
        FootMotion {
            level: state.displacement[unknown],
            velocity,
            acceleration,
            present_velocity: velocity + 0.5 * state.last_step * acceleration,
        }
    }

    /// The track one step before the present time, when the last forces acted; before any step, the start.
    pub fn view(&self) -> LeapfrogView<'_> {
        LeapfrogView { leapfrog: self }
    }
}

impl<'a> LeapfrogView<'a> {
    pub fn track(&self) -> &'a Track {
        &self.leapfrog.track
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.leapfrog.state.time - self.leapfrog.state.last_step
    }

    fn displacement(&self, unknown: usize) -> f64 {
        self.leapfrog.state.before[unknown]
    }

    fn velocity(&self, unknown: usize) -> f64 {
        let state = &self.leapfrog.state;
        state.velocity[unknown] - 0.5 * state.last_kick * state.acceleration[unknown]
    }

    /// Force of the rail on the pad, N.
    pub fn seat_load(&self, seat: usize) -> f64 {
        let track = &self.leapfrog.track;
        let (model, rail) = (&track.model.seats[seat], track.rail[track.seat_nodes[seat]]);
        let (foot, foot_velocity) =
            track.foot_unknown(seat).map_or((0.0, 0.0), |foot| (self.displacement(foot), self.velocity(foot)));
        model.pad_stiffness * (self.displacement(rail) - foot)
            + model.pad_damping * (self.velocity(rail) - foot_velocity)
    }

    /// Force of the sleeper on its support or on the ground, N; none for a seat without a sleeper.
    pub fn contact_force(&self, seat: usize) -> Option<f64> {
        let (track, state) = (&self.leapfrog.track, &self.leapfrog.state);
        match track.feet[seat] {
            FootUnknown::Sleeper(s) => Some(state.supports[s]),
            FootUnknown::Carried(c) => Some(state.pushes[c]),
            FootUnknown::Slab { .. } | FootUnknown::Rigid => None,
        }
    }

    /// Displacement of the sleeper or slab under a seat, m, relative to the track as built; 0 for rigid seats. The same
    /// holds for its velocity and acceleration.
    pub fn foot_displacement(&self, seat: usize) -> f64 {
        self.leapfrog.track.foot_unknown(seat).map_or(0.0, |unknown| self.displacement(unknown))
    }

    /// m/s.
    pub fn foot_velocity(&self, seat: usize) -> f64 {
        self.leapfrog.track.foot_unknown(seat).map_or(0.0, |unknown| self.velocity(unknown))
    }

    /// m/s^2.
    pub fn foot_acceleration(&self, seat: usize) -> f64 {
        self.leapfrog.track.foot_unknown(seat).map_or(0.0, |unknown| self.leapfrog.state.acceleration[unknown])
    }

    /// Displacement of the underside of the i-th carried sleeper, m, relative to the track as built.
    pub fn underside_displacement(&self, i: usize) -> f64 {
        let CarriedSleeper { underside, .. } = self.leapfrog.track.carried[i];
        self.displacement(underside)
    }

    /// Deflection of the rail at a node, m, relative to the track as built.
    pub fn rail_deflection(&self, node: usize) -> f64 {
        self.displacement(self.leapfrog.track.rail[node])
    }

    /// Slope of the rail at a node, rad, down with x; at a joint, the slope of the rail left of it.
    pub fn rail_slope(&self, node: usize) -> f64 {
        self.displacement(self.leapfrog.track.rail[node] + 1)
    }

    /// Sagging rail moment at a node, N m.
    pub fn rail_moment(&self, node: usize) -> f64 {
        let track = &self.leapfrog.track;
        let on_rail = self.on_rail().iter().filter_map(|(x, force)| Some((track.rail_point(*x).ok()?, force)));
        let clamping: f64 = on_rail.map(|(point, force)| track.clamping_moment(node, &point, *force)).sum();
        track.cubic_moment(node, &self.leapfrog.state.before) + clamping
    }

    /// Sagging rail moment at every node, N m.
    pub fn rail_moments(&self, moments: &mut [f64]) {
        let track = &self.leapfrog.track;
        for (node, moment) in moments.iter_mut().enumerate().take(track.nodes.len()) {
            *moment = track.cubic_moment(node, &self.leapfrog.state.before);
        }
        for (x, force) in self.on_rail() {
            let Ok(point) = track.rail_point(*x) else { continue };
            for node in [point.element, point.element + 1] {
                if let Some(moment) = moments.get_mut(node) {
                    *moment += track.clamping_moment(node, &point, *force);
                }
            }
        }
    }

    /// Chainage (m) and force (N, down) of every wheel that acts on the track: wheels on the rail, and wheels beyond an
    /// absorbing end and near it.
    pub fn on_rail(&self) -> &'a [(f64, f64)] {
        &self.leapfrog.state.on_rail
    }

    /// Chainage of each wheel of the train, vehicle by vehicle, m; wheels off the track included.
    pub fn wheel_positions(&self) -> impl Iterator<Item = f64> + 'a {
        let (leapfrog, time) = (self.leapfrog, self.time());
        leapfrog.ride.iter().flat_map(move |ride| ride.positions(time - leapfrog.state.ride.began))
    }

    /// Force of each wheel of the train on the rail or its continuation, vehicle by vehicle, N.
    pub fn wheel_forces(&self) -> impl Iterator<Item = f64> + 'a {
        self.leapfrog.state.ride.forces()
    }
}
