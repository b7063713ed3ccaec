//! One load that stands at one place after the other: what a measuring wheel finds at walking speed.
//!
//! Every place is an equilibrium of its own, with its own set of closed supports. It is unique, so that where the search
//! for it begins does not matter: it begins with the set of the last place, which neighbours mostly share, and with it the
//! factorised stiffness.

use super::mesh::Track;
use super::statics::{Inertia, StandingTrain, contradicts, factor};
use super::{Loads, TrackError, TrackLevel, solve_static};
use crate::linalg::banded::BandedFactor;

/// Sets of closed supports that are tried from the last place's before the search starts anew.
const TRIES: usize = 6;

/// Deflection of the rail (m, from the track as built) under gravity and `force` (N, down) where that force stands, for
/// each of `places` (m). Fails as [`solve_static`] does.
pub fn standing_deflections(
    track: &Track,
    level: &TrackLevel,
    force: f64,
    places: &[f64],
) -> Result<Vec<f64>, TrackError> {
    track.check_level(level)?;
    let mut search = Search { closed: vec![true; track.sleepers.len()], factor: None };
    let deflection = |x: &f64| {
        let point = track.rail_point(*x)?;
        let mut forces = track.weight.clone();
        track.add_force(&point, force, &mut forces);
        let unknowns = match search.near_last(track, level, &forces)? {
            Some(unknowns) => unknowns,
            None => {
                let state = solve_static(track, level, &Loads { rail: &[(*x, force)], ..Loads::default() })?;
                search = Search { closed: state.closed, factor: None };
                state.unknowns
            }
        };
        Ok(track.deflection_at(&point, &unknowns) + force * point.local_compliance)
    };
    places.iter().map(deflection).collect()
}

/// The set of closed supports of the last equilibrium, and its factorised stiffness.
struct Search {
    closed: Vec<bool>,
    factor: Option<BandedFactor>,
}

impl Search {
    /// The equilibrium under `forces`, if a few steps from the last set reach it.
    fn near_last(&mut self, track: &Track, level: &TrackLevel, forces: &[f64]) -> Result<Option<Vec<f64>>, TrackError> {
        let mut nothing = StandingTrain::new(track, None, &Inertia::default())?;
        for _ in 0..TRIES {
            let known = match self.factor.take() {
                Some(known) => known,
                None => match factor(track, &self.closed) {
                    Ok(new) => new,
                    Err(_) => return Ok(None), // too many supports opened at once
                },
            };
            let unknowns = nothing.solve(track, level, &self.closed, &known, forces)?;
            let wrong: Vec<usize> =
                (0..self.closed.len()).filter(|s| contradicts(track, level, *s, self.closed[*s], &unknowns)).collect();
            if wrong.is_empty() {
                self.factor = Some(known);
                return Ok(Some(unknowns));
            }
            wrong.into_iter().for_each(|s| self.closed[s] = !self.closed[s]);
        }
        Ok(None)
    }
}
