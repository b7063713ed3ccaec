//! A test as data, to be continued later.

use super::super::bed::Bed;
use super::super::checkpoint::{Checkpoint, RestoreError};
use super::super::lanes::Real;
use super::description::Rig;
use super::trial::{Trial, TrialState};
use serde::{Deserialize, Serialize};

/// The content of [`Trial`]. A restored test continues bit by bit like the stored test.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
pub struct StoredTrial<R: Real> {
    bed: Checkpoint<R>,
    state: TrialState,
}

impl<'a, R: Real> Trial<'a, R> {
    pub fn store(&self) -> StoredTrial<R> {
        StoredTrial { bed: self.bed.checkpoint(), state: self.state.clone() }
    }

    /// Restores a stored test of the same rig. Fails if the data are damaged: they must match the sleepers and sensors,
    /// and must not go beyond the end of the test.
    pub fn restore(stored: StoredTrial<R>, rig: &'a Rig) -> Result<Self, RestoreError> {
        let trial = Trial { bed: Bed::restore(stored.bed)?, rig, state: stored.state };
        trial.check().map_err(RestoreError::Inconsistent).map(|()| trial)
    }

    fn check(&self) -> Result<(), &'static str> {
        let (state, sleepers) = (&self.state, self.rig.sleepers.len());
        if [state.walls.len(), state.rest.len(), state.current.len()] != [sleepers; 3] {
            return Err("data of a sleeper are missing");
        }
        if state.walls.iter().any(|wall| wall.0 as usize >= self.bed.walls().len()) {
            return Err("a sleeper has no wall in its bed");
        }
        let cycles = state.cycles.iter().map(|cycle| cycle.sleeper);
        if cycles.chain(state.samples.iter().map(|sample| sample.sleeper)).any(|sleeper| sleeper >= sleepers)
            || state.readings.iter().any(|reading| reading.sensor >= self.rig.sensors.len())
        {
            return Err("a reading names a sleeper or a sensor that does not exist");
        }
        if state.pieces > self.pieces() || !(state.stride.is_finite() && state.stride > 0.0) {
            return Err("its position is beyond the end of the test, or it has no time step");
        }
        Ok(())
    }
}
