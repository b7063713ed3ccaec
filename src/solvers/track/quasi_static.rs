//! The start of a passage: the track and its train move as if the train had always been there.
//!
//! Velocity and acceleration of the track are the first and second differences of the static states slightly behind, at
//! and ahead of the start. The state at the start is then solved once more with the inertia and damping forces of that
//! motion, so that the equation of motion holds at the first instant.
//!
//! A vehicle takes the mean slope over one bay and no acceleration. It cannot follow the ripple of the static states
//! from sleeper to sleeper: at speed, a ripple of one micrometre would need a force of a tenth of the weight of the car
//! body.

use super::mesh::Track;
use super::statics::{Inertia, solve_with_inertia};
use super::{Loads, StaticState, SupportPhase, TrackError, TrackLevel, Train, solve_static};

/// A state in motion.
pub(super) struct Start {
    pub state: StaticState,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub vehicle_velocity: Vec<Vec<f64>>,
}

/// Distance between the compared states, m: small compared with an element, large compared with the rounding of a
/// deflection.
const DISTANCE: f64 = 2e-3;
/// The same distance as a share of the usual bay, for rails with shear. Their deflection has a kink under a wheel and
/// over a seat, so that states close together, with a wheel over a seat, would give an unbounded acceleration. This
/// distance gives the mean over the time in which the wheel passes.
const SHEARED_DISTANCE: f64 = 0.25;

/// The train with its leading wheel at `leading` (m), moving at `speed` (m/s).
pub(super) fn start(
    track: &Track,
    level: &TrackLevel,
    train: &Train,
    leading: f64,
    speed: f64,
) -> Result<Start, TrackError> {
    let at = |x: f64| solve_static(track, level, &Loads { train: Some((train, x)), ..Loads::default() });
    let here = at(leading)?;
    let sign = train.direction.sign();
    let distance = if track.model.shears() { SHEARED_DISTANCE * track.model.usual_bay() } else { DISTANCE };
    let interval = distance / speed;
    // A wheel may stand at the very end of the track: then there is no state behind it or ahead of it.
    let (behind, ahead) = (at(leading - sign * distance), at(leading + sign * distance));
    let (Ok(behind), Ok(ahead)) = (behind, ahead) else { return Ok(Start::at_rest(track, here)) };

    let difference = |i: usize| (ahead.unknowns[i] - behind.unknowns[i]) / (2.0 * interval);
    let second = |i: usize| (ahead.unknowns[i] - 2.0 * here.unknowns[i] + behind.unknowns[i]) / (interval * interval);
    let velocity: Vec<f64> = (0..track.order()).map(difference).collect();
    let acceleration: Vec<f64> = (0..track.order()).map(second).collect();
    let half = 0.5 * track.model.usual_bay();
    let mut vehicle_velocity: Vec<Vec<f64>> = train.vehicles.iter().map(|(v, _)| vec![0.0; v.order()]).collect();
    if let (Ok(behind), Ok(ahead)) = (at(leading - sign * half), at(leading + sign * half)) {
        for (v, velocity) in vehicle_velocity.iter_mut().enumerate() {
            for (i, velocity) in velocity.iter_mut().enumerate() {
                *velocity = (ahead.vehicles[v][i] - behind.vehicles[v][i]) * (0.5 * speed / half);
            }
        }
    }

    let mut inertia = Inertia { track: vec![0.0; track.order()], vehicles: Vec::new() };
    track.mass.subtract_product(&acceleration, &mut inertia.track);
    track.damping.subtract_product(&velocity, &mut inertia.track);
    for (sleeper, _) in track.sleepers.iter().zip(&here.phases).filter(|(_, phase)| **phase == SupportPhase::Open) {
        inertia.track[sleeper.unknown] += sleeper.support_damping * velocity[sleeper.unknown];
    }
    for (v, (vehicle, _)) in train.vehicles.iter().enumerate() {
        let velocity = &vehicle_velocity[v];
        let row = |i: usize| -velocity.iter().enumerate().map(|(j, v)| vehicle.damping[(i, j)] * v).sum::<f64>();
        inertia.vehicles.push((0..vehicle.order()).map(row).collect());
    }
    let loads = Loads { train: Some((train, leading)), ..Loads::default() };
    let state = solve_with_inertia(track, level, &loads, &inertia)?;
    Ok(Start { state, velocity, acceleration, vehicle_velocity })
}

impl Start {
    /// A state without velocity or acceleration.
    pub fn at_rest(track: &Track, state: StaticState) -> Self {
        Self {
            velocity: vec![0.0; track.order()],
            acceleration: vec![0.0; track.order()],
            vehicle_velocity: state.vehicles.iter().map(|v| vec![0.0; v.len()]).collect(),
            state,
        }
    }
}
