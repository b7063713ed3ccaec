//! The equilibrium: phases of the supports are tried until no support contradicts its phase.
//!
//! The energy of the track is convex and piecewise quadratic, with one piece for each set of phases of the supports.
//! Starting with all supports closed, each iteration factors the banded stiffness for its phases, solves, and moves the
//! supports that contradict their phase. After [`FLIP_ALL`] iterations only the first contradiction is moved; this
//! cannot cycle. Wheels enter by the compliance of the track at their places and share one Newton iteration with the
//! unknowns of their vehicles.

use super::loads::{Inertia, Loads};
use super::standing::StandingTrain;
use super::state::{StaticState, describe};
use super::stiffness::factor;
use crate::solvers::track::error::{TrackError, TrackParameter};
use crate::solvers::track::mesh::{FootUnknown, Track};
use crate::solvers::track::model::TrackLevel;
use crate::solvers::track::support::SupportPhase;

/// Iterations that move every contradicting support at once.
const FLIP_ALL: usize = 20;

/// Finds the equilibrium of the track at `level` under gravity and `loads`.
///
/// Fails if a load stands off the track, if something moves without resistance, or if no set of phases in equilibrium
/// is found after ten times as many iterations as there are sleepers.
pub fn solve_static(track: &Track, level: &TrackLevel, loads: &Loads) -> Result<StaticState, TrackError> {
    solve_with_inertia(track, level, loads, &Inertia::default())
}

pub(in super::super) fn solve_with_inertia(
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
                    name: TrackParameter::Load("loaded seat"),
                    value: seat as f64,
                    expected: "with a sleeper on a support",
                });
            }
        }
    }
    let mut wheels = StandingTrain::new(track, loads.train, inertia)?;

    let mut phases = vec![SupportPhase::Closed; track.sleepers.len()];
    let mut before = phases.clone();
    let (limit, mut one_by_one, mut last_change) = (FLIP_ALL + 10 * phases.len().max(5), false, 0.0);
    for iteration in 1..=limit {
        one_by_one |= iteration > FLIP_ALL;
        let factor = match factor(track, &phases) {
            Ok(factor) => factor,
            Err(row) => {
                if one_by_one || phases == before {
                    return Err(TrackError::Mechanism { x: track.place_of(row) });
                }
                // Too many supports opened at once.
                one_by_one = true;
                phases.clone_from(&before);
                continue;
            }
        };
        let unknowns = wheels.solve(track, level, &phases, &factor, &forces)?;
        before.clone_from(&phases);
        let mut consistent = true;
        for (s, sleeper) in track.sleepers.iter().enumerate() {
            let gap = unknowns[sleeper.unknown] - level.settlements[sleeper.seat];
            let next = sleeper.phase_at_rest(phases[s], gap);
            if next != phases[s] && (consistent || !one_by_one) {
                phases[s] = next;
                consistent = false;
                last_change = track.model.seats[sleeper.seat].x;
            }
        }
        if consistent {
            on_rail.extend(wheels.points.iter().copied().zip(wheels.forces.iter().copied()));
            let applied: f64 = loads.rail.iter().map(|l| l.1).chain(loads.sleepers.iter().map(|l| l.1)).sum();
            return Ok(describe(track, level, unknowns, phases, on_rail, wheels, applied, iteration));
        }
    }
    Err(TrackError::NoEquilibrium { x: last_change, iterations: limit })
}
