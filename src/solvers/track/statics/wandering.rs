//! One load at one place after the other, like a measuring wheel at walking speed.
//!
//! Every place is a separate equilibrium with its own set of support phases. The equilibrium is unique, so the start of
//! the search does not affect it. The search begins with the phases and the factored stiffness of the last place,
//! because neighbouring places mostly have the same phases.

use super::loads::{Inertia, Loads};
use super::solve::solve_static;
use super::standing::StandingTrain;
use super::state::StaticState;
use super::stiffness::factor;
use crate::linalg::banded::BandedFactor;
use crate::solvers::track::mesh::Track;
use crate::solvers::track::support::SupportPhase;
use crate::solvers::track::{TrackError, TrackLevel};

/// Sets of phases that are tried from the phases of the last place before the search starts anew.
const TRIES: usize = 6;

/// Deflection of the rail (m, relative to the track as built) at the force, under gravity and `force` (N, down), for
/// each of `places` (m) of the force. Fails as [`solve_static`] does.
pub fn standing_deflections(
    track: &Track,
    level: &TrackLevel,
    force: f64,
    places: &[f64],
) -> Result<Vec<f64>, TrackError> {
    track.check_level(level)?;
    let mut search = Search { phases: vec![SupportPhase::Closed; track.sleepers.len()], factor: None };
    let deflection = |x: &f64| {
        let point = track.rail_point(*x)?;
        let mut forces = track.own_forces(level);
        track.add_force(&point, force, &mut forces);
        let unknowns = match search.near_last(track, level, &forces)? {
            Some(unknowns) => unknowns,
            None => {
                let state = solve_static(track, level, &Loads { rail: &[(*x, force)], ..Loads::default() })?;
                search = Search { phases: state.phases, factor: None };
                state.unknowns
            }
        };
        Ok(track.deflection_at(&point, &unknowns) + force * point.local_compliance)
    };
    places.iter().map(deflection).collect()
}

/// Static stiffness at rail level (N/m) at each of `places` (m): `force` (N, down) divided by the additional deflection
/// at the force. Fails as [`solve_static`] does.
pub fn standing_stiffness(
    track: &Track,
    level: &TrackLevel,
    unloaded: &StaticState,
    force: f64,
    places: &[f64],
) -> Result<Vec<f64>, TrackError> {
    let loaded = standing_deflections(track, level, force, places)?;
    let added = |(x, loaded): (&f64, f64)| Ok(force / (loaded - unloaded.rail_deflection_at(track, *x)?));
    places.iter().zip(loaded).map(added).collect()
}

/// Force of the sleeper on its support (N) and deflection of the support (m) at each of `seats`, under gravity and two
/// wheels of `force` (N, down): one over the seat, the other `apart` (m) ahead if the rail goes on there. 0 at seats
/// without a sleeper. Fails as [`solve_static`] does.
pub fn forces_under_wheels(
    track: &Track,
    level: &TrackLevel,
    [force, apart]: [f64; 2],
    seats: &[usize],
) -> Result<Vec<[f64; 2]>, TrackError> {
    track.check_level(level)?;
    let mut search = Search { phases: vec![SupportPhase::Closed; track.sleepers.len()], factor: None };
    let under = |seat: &usize| {
        let Some(number) = track.sleepers.iter().position(|sleeper| sleeper.seat == *seat) else { return Ok([0.0; 2]) };
        let x = track.model.seats[*seat].x;
        let wheels: Vec<(f64, f64)> =
            [x, x + apart].into_iter().filter(|x| *x <= track.model.ends[1]).map(|x| (x, force)).collect();
        let mut forces = track.own_forces(level);
        for (x, force) in &wheels {
            track.add_force(&track.rail_point(*x)?, *force, &mut forces);
        }
        let unknowns = match search.near_last(track, level, &forces)? {
            Some(unknowns) => unknowns,
            None => {
                let state = solve_static(track, level, &Loads { rail: &wheels, ..Loads::default() })?;
                search = Search { phases: state.phases, factor: None };
                state.unknowns
            }
        };
        let sleeper = &track.sleepers[number];
        let gap = unknowns[sleeper.unknown] - level.settlements[*seat];
        Ok([sleeper.spring_force(search.phases[number], gap).max(0.0), gap.max(0.0)])
    };
    seats.iter().map(under).collect()
}

/// The phases of the last equilibrium, and its factored stiffness.
struct Search {
    phases: Vec<SupportPhase>,
    factor: Option<BandedFactor>,
}

impl Search {
    /// The equilibrium under `forces`, if a few steps from the last set reach it.
    fn near_last(&mut self, track: &Track, level: &TrackLevel, forces: &[f64]) -> Result<Option<Vec<f64>>, TrackError> {
        let mut nothing = StandingTrain::new(track, None, &Inertia::default())?;
        for _ in 0..TRIES {
            let known = match self.factor.take() {
                Some(known) => known,
                None => match factor(track, &self.phases) {
                    Ok(new) => new,
                    Err(_) => return Ok(None), // too many supports opened at once
                },
            };
            let unknowns = nothing.solve(track, level, &self.phases, &known, forces)?;
            let mut consistent = true;
            for (sleeper, phase) in track.sleepers.iter().zip(&mut self.phases) {
                let next = sleeper.phase_at_rest(*phase, unknowns[sleeper.unknown] - level.settlements[sleeper.seat]);
                consistent &= next == *phase;
                *phase = next;
            }
            if consistent {
                self.factor = Some(known);
                return Ok(Some(unknowns));
            }
        }
        Ok(None)
    }
}
