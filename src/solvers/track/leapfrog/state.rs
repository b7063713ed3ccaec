//! The state on which the next step depends, as data.

use super::Leapfrog;
use super::energy::EnergyAccount;
use super::level::LevelMove;
use super::ride_state::RideState;
use crate::solvers::track::error::{TrackError, TrackParameter};
use crate::solvers::track::mesh::Track;
use crate::solvers::track::model::TrackLevel;
use serde::{Deserialize, Serialize};

/// The motion of a [`Leapfrog`]. With the same track, step, drag and train the run continues bit by bit the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeapfrogState {
    pub(super) steps: u64,
    /// s, of `displacement`.
    pub(super) time: f64,
    /// Length of the last step and of the last kick, s; 0 before the first.
    pub(super) last_step: f64,
    pub(super) last_kick: f64,
    pub(super) displacement: Vec<f64>,
    /// Displacement one step before.
    pub(super) before: Vec<f64>,
    /// Velocity half a step before.
    pub(super) velocity: Vec<f64>,
    /// Acceleration one step before.
    pub(super) acceleration: Vec<f64>,
    /// Forces of the last step: pushes on carried feet and forces of the supports of ordinary sleepers, N up; wheels
    /// that act on the track, m and N down.
    pub(super) pushes: Vec<f64>,
    /// Moments of the ground on carried feet, N m, as the slope of the rail.
    pub(super) turns: Vec<f64>,
    /// Mass added to the undersides of carried feet, kg.
    pub(super) added: Vec<f64>,
    pub(super) supports: Vec<f64>,
    pub(super) on_rail: Vec<(f64, f64)>,
    pub(super) level: TrackLevel,
    pub(super) level_move: Option<LevelMove>,
    pub(super) ride: RideState,
    pub(super) account: Option<EnergyAccount>,
}

impl LeapfrogState {
    pub(super) fn at_rest(track: &Track, level: &TrackLevel, displacement: Vec<f64>) -> Self {
        let zeros = vec![0.0; track.order()];
        Self {
            steps: 0,
            time: 0.0,
            last_step: 0.0,
            last_kick: 0.0,
            before: displacement.clone(),
            displacement,
            velocity: zeros.clone(),
            acceleration: zeros,
            pushes: vec![0.0; track.carried.len()],
            turns: vec![0.0; track.carried.len()],
            added: vec![0.0; track.carried.len()],
            supports: vec![0.0; track.sleepers.len()],
            on_rail: Vec::new(),
            level: level.clone(),
            level_move: None,
            ride: RideState::default(),
            account: None,
        }
    }

    /// The lengths of its lists.
    fn shape(&self) -> [usize; 11] {
        let [vehicles, wheels] = self.ride.shape();
        let lists = [
            &self.displacement,
            &self.before,
            &self.velocity,
            &self.acceleration,
            &self.pushes,
            &self.supports,
            &self.turns,
            &self.added,
        ];
        let [a, b, c, d, e, f, g, h] = lists.map(Vec::len);
        [a, b, c, d, e, f, g, h, self.level.settlements.len(), vehicles, wheels]
    }
}

impl Leapfrog {
    /// The present motion.
    pub fn state(&self) -> &LeapfrogState {
        &self.state
    }

    /// Continues from a state of this track and train; fails if the state belongs to another track or train.
    pub fn restore(&mut self, state: &LeapfrogState) -> Result<(), TrackError> {
        if state.shape() != self.state.shape() {
            let name = TrackParameter::Load("unknowns of a stored state");
            let (value, expected) = (state.displacement.len() as f64, "as many as this track and its train have");
            return Err(TrackError::Parameter { name, value, expected });
        }
        self.state.clone_from(state);
        self.weigh()
    }
}
