//! The rail as a measuring wheel finds it: level, moment and static stiffness at rail level along the track (paper,
//! Fig. 8).
//!
//! The stiffness is the secant one, `k = F / (w_F - w_0)`: F stands still at the place, w_F and w_0 are the deflections
//! with and without it, each in equilibrium with its own lost contacts. On a track without voids it is the paper's,
//! which inverts the assembled matrix with all supports closed; over a void it is lower, as the wheel must close the
//! gap first. There is no profile outside the range of the wheels: near the ends of the model the supports of the rail
//! ends would affect the result.

use super::RailPlace;
use crate::solvers::track::{StaticState, Track, TrackError, TrackLevel, standing_stiffness};
use std::ops::RangeInclusive;

/// Places in each bay.
const PER_BAY: usize = 4;

/// The profile under a wheel of `load` (N) where wheels `run` (m); `unloaded` is the track at rest.
pub(super) fn profile(
    track: &Track,
    level: &TrackLevel,
    unloaded: &StaticState,
    load: f64,
    run: RangeInclusive<f64>,
) -> Result<Vec<RailPlace>, TrackError> {
    let places: Vec<f64> = places(track).filter(|x| run.contains(x)).collect();
    let stiffness = standing_stiffness(track, level, unloaded, load, &places)?;
    let place = |(x, stiffness): (f64, f64)| {
        let rest = unloaded.rail_deflection_at(track, x)?;
        let moment = moment_at(track.nodes(), &unloaded.rail_moment, x);
        Ok(RailPlace { x, level: rest, moment, stiffness })
    };
    places.into_iter().zip(stiffness).map(place).collect()
}

/// Every seat and three places in each bay.
fn places(track: &Track) -> impl Iterator<Item = f64> + '_ {
    let seats = &track.model().seats;
    let part = |left: f64, right: f64, k: usize| left + (right - left) * k as f64 / PER_BAY as f64;
    let bays = seats.windows(2).flat_map(move |pair| (0..PER_BAY).map(move |k| part(pair[0].x, pair[1].x, k)));
    bays.chain(seats.last().map(|seat| seat.x))
}

/// The moment at x, linear between the nodes: exact at nodes, and between them but for the weight of one element.
fn moment_at(nodes: &[f64], moments: &[f64], x: f64) -> f64 {
    let (left, share) = between(nodes, x);
    moments[left] + share * (moments[left + 1] - moments[left])
}

/// The node left of x, and how far x lies on the way to the next one, 0 .. 1. There are two nodes or more.
pub fn between(nodes: &[f64], x: f64) -> (usize, f64) {
    let left = nodes.partition_point(|node| *node < x).clamp(1, nodes.len() - 1) - 1;
    (left, ((x - nodes[left]) / (nodes[left + 1] - nodes[left])).clamp(0.0, 1.0))
}
