//! The track in time steps that it shares with an explicit model, such as grains under its sleepers: central
//! differences in time whose linear, stiff part is implicit.
//!
//! Displacements and forces belong to full steps n, velocities to the half steps between them, as in a leapfrog scheme
//! of grains:
//!
//! ```text
//! M a_n + C (v_{n-1/2} + v_{n+1/2})/2 + K (β u_{n-1} + (1-2β) u_n + β u_{n+1}) = f + F_n
//! v_{n+1/2} = v_{n-1/2} + Δt a_n,    u_{n+1} = u_n + Δt v_{n+1/2}
//! ```
//!
//! f are gravity and the forces of the track beyond the rail ends. F_n are all forces that are computed from the state
//! at step n: pushes of the ground on carried sleepers, supports of ordinary sleepers, wheels. The remaining linear
//! system has a matrix that is factored once for a step length:
//!
//! ```text
//! u_{n-1} - 2 u_n + u_{n+1} = Δt² a_n
//! M̂ a_n = f + F_n - C v_{n-1/2} - K u_n,    M̂ = M + ½ Δt C + β Δt² K,    β = ¼
//! ```
//!
//! This is Newmark's method (β = ¼, γ = ½) for the implicit part and central differences for the explicit part, mixed
//! as in Hughes and Liu (1978, J. Appl. Mech. 45, 371–378). It is symmetric in time and of second order. A track that
//! is released from rest begins with half a kick; if the step length changes, one kick has the mean of both lengths.
//! When a sleeper touches its support again, the force of the damper jumps at the next full step: there the error is of
//! first order, here as in a passage.
//!
//! **Energy.** The product with the mean velocity v̄ at a full step gives, with the mean displacement ū at half steps,
//!
//! ```text
//! v̄_n = (v_{n-1/2} + v_{n+1/2})/2,    ū_{n+1/2} = (u_n + u_{n+1})/2
//! E = ½ vᵀ M v + ½ ūᵀ K ū - f ū,    E_{n+1/2} - E_{n-1/2} = Δt v̄_nᵀ (F_n - C v̄_n)
//! ```
//!
//! to rounding. So a force on the interface gives one side the power `F_n v̄_n` that it takes from the other side, and
//! without F every step length is stable. [`Leapfrog::watch`] keeps this account.
//!
//! **Limit.** Let F contain a spring k and a damper c between places that e selects from u; the damper has the velocity
//! `v_{n-1/2} + ½ Δt a_{n-1}`. In the fastest motion, `u_n = (-1)ⁿ u`, the implicit elasticity cancels (1 - 4β = 0) for
//! any stiffness, and
//!
//! ```text
//! 4/Δt² > (k + 4 c/Δt) eᵀ M⁻¹ e,    so  Δt < 2 m/(c + √(c² + k m)),    1/m = eᵀ M⁻¹ e
//! ```
//!
//! For the support of a sleeper, m is the mass of the sleeper; for a wheel, the mass of the wheel and the effective
//! mass of the rail. For a carried sleeper on a pad, m is the mass of the underside of the pad alone, and k and c are
//! the sums over the contacts of the ground: [`Leapfrog::hold`] adds the mass that they need.
//!
//! **Wheels** that ride press by their contact law on the rail at the present time; the rail yields under them within
//! its element. Beyond an absorbing end they press on the beam that continues the rail. The shape of this beam moves
//! with the end, and the mass and stiffness of the shape belong to the end.

mod energy;
mod hold;
#[cfg(test)]
mod hooks;
mod level;
mod limit;
mod ride_state;
mod rider;
mod riding;
mod state;
mod step;
mod under;
mod view;

pub use energy::EnergyAccount;
pub use limit::StepLimit;
pub use state::LeapfrogState;
pub use view::{FootMotion, LeapfrogView};

use super::ends;
use super::error::{TrackError, TrackParameter};
use super::mesh::Track;
use super::model::SAME_PLACE;
use super::{Direction, Loads, Motion, TrackLevel, Train, solve_static};
use crate::linalg::banded::{NotPositiveDefinite, SymmetricBanded};
use crate::linalg::twisted::TwistedFactor;
use riding::Ride;
use std::sync::Arc;
use under::Beyond;

/// β of the implicit part: the smallest value that is stable for every stiffness.
const BETA: f64 = 0.25;

/// The loads on the rail in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WheelLoads<'a> {
    /// No load; a riding train has passed or has not arrived yet.
    None,
    /// Known forces: chainage (m) and force (N, down) at the present time. Forces beyond an absorbing end act on the
    /// end through the continuation of the track; other forces off the track have no effect.
    Given(&'a [(f64, f64)]),
    /// The train of [`Leapfrog::ride`].
    Riding,
}

/// A track in motion, step by step. Vectors run over the unknowns of the track unless said otherwise.
#[derive(Debug, Clone)]
pub struct Leapfrog {
    track: Arc<Track>,
    /// s.
    time_step: f64,
    /// 1/s.
    drag: f64,
    /// M, including the rails beyond absorbing ends: otherwise a wheel there would meet only the mass at the end of an
    /// element.
    mass: SymmetricBanded,
    /// K and C, without the supports of ordinary sleepers.
    stiffness: SymmetricBanded,
    damping: SymmetricBanded,
    /// Factor of M̂.
    factor: TwistedFactor,
    /// Forces by which the continuation of the rail pulls its ends to their level: end, unknown, and N or N m per
    /// metre.
    pulls: Vec<(usize, usize, f64)>,
    beyond: Beyond,
    ride: Option<Ride>,
    /// Seats of the carried feet.
    carried: Vec<usize>,
    state: LeapfrogState,
    forces: Vec<f64>,
    mean_velocity: Vec<f64>,
}

impl Leapfrog {
    /// The track at rest at `level` under gravity, with its carried feet held at their settlements, before a first step
    /// of `time_step` (s).
    ///
    /// Fails if nothing holds the track, or if the step is longer than the supports of its ordinary sleepers allow.
    pub fn new(track: Arc<Track>, level: &TrackLevel, time_step: f64) -> Result<Self, TrackError> {
        let rest = solve_static(&track, level, &Loads::default())?;
        let mut stiffness = track.stiffness.clone();
        for sleeper in &track.sleepers {
            stiffness.add(sleeper.unknown, sleeper.unknown, -sleeper.support_stiffness);
        }
        let mass = hold::mass(&track, &[]);
        let damping = damping(&track, &mass, 0.0);
        let order = track.order();
        check_step(&track, None, time_step)?;
        Ok(Self {
            factor: factor(&track, &mass, &stiffness, &damping, time_step)?,
            pulls: ends::pulls(&track).collect(),
            beyond: under::beyond(&track),
            time_step,
            drag: 0.0,
            ride: None,
            carried: track.carried.iter().map(|c| c.seat).collect(),
            state: LeapfrogState::at_rest(&track, level, rest.unknowns),
            forces: vec![0.0; order],
            mean_velocity: vec![0.0; order],
            mass,
            stiffness,
            damping,
            track,
        })
    }

    /// Continues in steps of another length, s. Fails if the length is above the limit of the supports and wheels.
    pub fn set_time_step(&mut self, time_step: f64) -> Result<(), TrackError> {
        check_step(&self.track, self.ride.as_ref(), time_step)?;
        if time_step != self.time_step {
            self.factor = factor(&self.track, &self.mass, &self.stiffness, &self.damping, time_step)?;
            if let Some(ride) = &mut self.ride {
                ride.set_time_step(time_step)?;
            }
            self.time_step = time_step;
        }
        Ok(())
    }

    /// Brakes every mass of the track by a force of `drag` (1/s, 0 for none) times its momentum, to bring the track to
    /// rest. The drag hardly affects motion much faster than the step; loads that grow over some milliseconds excite no
    /// such motion.
    pub fn set_drag(&mut self, drag: f64) -> Result<(), TrackError> {
        if !(drag >= 0.0 && drag.is_finite()) {
            let name = TrackParameter::Damping("drag of a track");
            return Err(TrackError::Parameter { name, value: drag, expected: "of 0 or more" });
        }
        if drag != self.drag {
            self.damping = damping(&self.track, &self.mass, drag);
            self.factor = factor(&self.track, &self.mass, &self.stiffness, &self.damping, self.time_step)?;
            self.drag = drag;
        }
        Ok(())
    }

    /// Starts the ride of `train`, its leading wheel at `start` (m), before the track, with every vehicle at rest
    /// there.
    ///
    /// Beyond an absorbing end wheels stand on the continuation of the track, beyond other ends on level ground, at the
    /// present level of the rail end. So call this while the track is at rest, best with `start` from
    /// [`Leapfrog::approach`]. Fails if a wheel stands on the track, or if the step is longer than the wheels allow.
    pub fn ride(&mut self, train: &Train, motion: &Motion, start: f64) -> Result<(), TrackError> {
        let mut ride = Ride::new(&self.track, &self.mass, &self.beyond, train, motion, start)?;
        ride.check_start(&self.track, start)?;
        check_step(&self.track, Some(&ride), self.time_step)?;
        ride.set_time_step(self.time_step)?;
        self.state.ride = ride.standing(&self.track, &self.beyond, &self.state)?;
        self.state.on_rail.reserve(train.wheels());
        self.ride = Some(ride);
        Ok(())
    }

    /// Removes the train.
    pub fn dismiss(&mut self) {
        self.ride = None;
        self.state.ride = ride_state::RideState::default();
    }

    /// A place of the leading wheel at which the train does not yet act on the track, m.
    pub fn approach(&self, direction: Direction) -> f64 {
        let (sign, entry) = (direction.sign(), usize::from(direction == Direction::Backward));
        let reach = self.beyond[entry].map_or(SAME_PLACE, |continuation| continuation.reach());
        self.track.model.ends[entry] - sign * (reach + SAME_PLACE)
    }

    /// The time from which the last wheel of the train does not act on the track any more, s; none without a train.
    pub fn ride_ends(&self) -> Option<f64> {
        self.ride.as_ref().map(|ride| self.state.ride.began + ride.duration())
    }

    /// The longest stable step and the contact that sets it; none if no contact is explicit.
    pub fn limit(&self) -> Option<StepLimit> {
        limit::of_track(&self.track)
            .into_iter()
            .chain(self.ride.as_ref().and_then(Ride::limit))
            .min_by(StepLimit::shorter)
    }

    pub fn track(&self) -> &Track {
        &self.track
    }

    /// s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// s, of the present displacements.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }

    /// Seats of the carried feet, left to right, in the order of their pushes.
    pub fn carried(&self) -> &[usize] {
        &self.carried
    }
}

/// Fails if a step (s) is not above 0 or longer than the explicit contacts allow.
fn check_step(track: &Track, ride: Option<&Ride>, time_step: f64) -> Result<(), TrackError> {
    if !(time_step > 0.0 && time_step.is_finite()) {
        return Err(TrackError::Parameter { name: TrackParameter::TimeStep, value: time_step, expected: "above 0" });
    }
    let limits = limit::of_track(track).into_iter().chain(ride.and_then(Ride::limit));
    match limits.min_by(StepLimit::shorter).filter(|limit| time_step > limit.time_step) {
        Some(StepLimit { time_step: limit, x, contact }) => {
            Err(TrackError::StepTooLong { time_step, limit, x, contact })
        }
        None => Ok(()),
    }
}

/// C without the supports of ordinary sleepers, with a drag (1/s).
fn damping(track: &Track, mass: &SymmetricBanded, drag: f64) -> SymmetricBanded {
    let mut damping = track.damping.clone();
    for sleeper in &track.sleepers {
        damping.add(sleeper.unknown, sleeper.unknown, -sleeper.support_damping);
    }
    damping.add_scaled(drag, mass);
    damping
}

/// Factors M̂; fails if the track is a mechanism without mass.
fn factor(
    track: &Track,
    mass: &SymmetricBanded,
    stiffness: &SymmetricBanded,
    damping: &SymmetricBanded,
    time_step: f64,
) -> Result<TwistedFactor, TrackError> {
    let mut matrix = mass.clone();
    matrix.add_scaled(0.5 * time_step, damping);
    matrix.add_scaled(BETA * time_step * time_step, stiffness);
    track.held.iter().for_each(|(unknown, _)| matrix.pin(*unknown));
    TwistedFactor::new(&matrix).map_err(|e: NotPositiveDefinite| TrackError::Mechanism { x: track.place_of(e.row) })
}
