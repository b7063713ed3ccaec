//! The level of the supports and rail ends of the track, which may move during the run.

use super::Leapfrog;
use crate::solvers::track::error::{TrackError, TrackParameter};
use crate::solvers::track::model::TrackLevel;
use serde::{Deserialize, Serialize};

/// A level that moves to another level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct LevelMove {
    from: TrackLevel,
    to: TrackLevel,
    /// s.
    began: f64,
    duration: f64,
}

impl Leapfrog {
    /// Present level of the supports of ordinary sleepers and of the rail ends.
    pub fn level(&self) -> &TrackLevel {
        &self.state.level
    }

    /// Moves the supports of ordinary sleepers and the ends of the rail to another level at once. Carried feet stay in
    /// place. A held end then acts on the rail like a blow; [`Leapfrog::move_level`] avoids this.
    pub fn set_level(&mut self, level: &TrackLevel) -> Result<(), TrackError> {
        self.track.check_level(level)?;
        self.state.level_move = None;
        self.state.level.clone_from(level);
        for (unknown, at) in self.track.held_at(level) {
            self.state.displacement[unknown] = at;
        }
        Ok(())
    }

    /// The same as [`Leapfrog::set_level`], but smoothly over `duration` (s, above 0) from now on.
    pub fn move_level(&mut self, level: &TrackLevel, duration: f64) -> Result<(), TrackError> {
        self.track.check_level(level)?;
        if !(duration > 0.0 && duration.is_finite()) {
            let name = TrackParameter::Level("time in which the level moves");
            return Err(TrackError::Parameter { name, value: duration, expected: "above 0" });
        }
        let (from, began) = (self.state.level.clone(), self.state.time);
        self.state.level_move = Some(LevelMove { from, to: level.clone(), began, duration });
        Ok(())
    }

    /// Sets the level at the end of the last step.
    pub(super) fn advance_level(&mut self) {
        let (state, dt) = (&mut self.state, self.time_step);
        let Some(LevelMove { from, to, began, duration }) = &state.level_move else { return };
        let t = ((state.time - began) / duration).min(1.0);
        let share = t * t * (3.0 - 2.0 * t);
        let between = |a: f64, b: f64| a + share * (b - a);
        for (settlement, (a, b)) in state.level.settlements.iter_mut().zip(from.settlements.iter().zip(&to.settlements))
        {
            *settlement = between(*a, *b);
        }
        for end in [0, 1] {
            state.level.ends[end] = between(from.ends[end], to.ends[end]);
        }
        for (unknown, at) in self.track.held_at(&state.level) {
            state.velocity[unknown] = (at - state.before[unknown]) / dt;
            state.displacement[unknown] = at;
        }
        if t >= 1.0 {
            for (unknown, _) in &self.track.held {
                state.velocity[*unknown] = 0.0;
            }
            state.level_move = None;
        }
    }
}
