//! A test as data, to go on with later.

use super::super::bed::Bed;
use super::super::checkpoint::{Checkpoint, RestoreError};
use super::super::lanes::Real;
use super::description::Rig;
use super::trial::{Trial, TrialState};
use serde::{Deserialize, Serialize};

/// What [`Trial`] holds. A test that comes back goes on bit by bit as the one that was stored.
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

    /// A test of the same rig that goes on. Fails where what was stored is damaged.
    pub fn restore(stored: StoredTrial<R>, rig: &'a Rig) -> Result<Self, RestoreError> {
        Ok(Trial { bed: Bed::restore(stored.bed)?, rig, state: stored.state })
    }
}
