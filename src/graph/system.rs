//! The track node at work: its statics and its passages, spoken to in the scene's terms.

use super::model::{level, model};
use super::track::{PassageOutcome, RailPoint, Unloaded, UnloadedSeat};
use super::{Graph, TrackNode};
use crate::scenario::{Direction, StaticLoad, Target};
use crate::solvers::track::{Loads, StaticState, Track, TrackError, solve_static};

/// A meshed track, factored once for all passages.
pub(super) struct TrackSystem<'a> {
    node: &'a TrackNode,
    track: Track,
}

impl<'a> TrackSystem<'a> {
    pub fn new(graph: &'a Graph) -> Result<Self, TrackError> {
        let track = Track::new(model(&graph.track))?;
        Ok(TrackSystem { node: &graph.track, track })
    }

    /// The track under test loads.
    pub fn equilibrium(&self, loads: &[StaticLoad]) -> Result<Unloaded, TrackError> {
        let seats = &self.node.track.seats;
        let on = |target: Target| loads.iter().filter(move |l| l.on == target);
        let rail: Vec<(f64, f64)> = on(Target::Rail).map(|l| (l.x, *l.force)).collect();
        let nearest = |x: f64| {
            (0..seats.len()).min_by(|&a, &b| (seats[a].x - x).abs().total_cmp(&(seats[b].x - x).abs())).unwrap_or(0)
        };
        let sleepers: Vec<(usize, f64)> = on(Target::Sleepers).map(|l| (nearest(l.x), *l.force)).collect();
        let settlement = vec![0.0; seats.len()];
        let loads = Loads { rail: &rail, sleepers: &sleepers, train: None };
        let state = solve_static(&self.track, &level(self.node, &settlement), &loads)?;
        Ok(self.at_rest(&state, &settlement))
    }

    /// The settled track under its own weight.
    pub fn unloaded(&self, settlement: &[f64]) -> Result<Unloaded, TrackError> {
        let state = solve_static(&self.track, &level(self.node, settlement), &Loads::default())?;
        Ok(self.at_rest(&state, settlement))
    }

    fn at_rest(&self, state: &StaticState, settlement: &[f64]) -> Unloaded {
        let rail = self
            .track
            .nodes()
            .iter()
            .zip(state.rail_deflection.iter().zip(&state.rail_moment))
            .map(|(x, (deflection, moment))| RailPoint { x: *x, deflection: *deflection, moment: *moment })
            .collect();
        let seats = (0..settlement.len())
            .map(|i| UnloadedSeat {
                settlement: settlement[i],
                sleeper_level: state.foot_displacements[i],
                void: if self.node.track.seats[i].is_ballasted() {
                    (settlement[i] - state.foot_displacements[i]).max(0.0)
                } else {
                    0.0
                },
                contact_force: state.contact_forces[i],
                seat_load: state.seat_loads[i],
            })
            .collect();
        Unloaded { rail, seats }
    }

    pub fn passage(
        &self,
        _axles: u64,
        _settlement: &[f64],
        _unloaded: &Unloaded,
        _direction: Direction,
        _recorded: bool,
    ) -> Result<PassageOutcome, TrackError> {
        Err(TrackError::Mechanism { x: 0.0 })
    }
}
