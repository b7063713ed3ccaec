//! A bed of grains under actuators: the node of a test rig, advanced piece by piece of a cycle.

use super::on_grains::{Stage, Telling};
use super::{Bonds, NodeError};
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::Packed;
use crate::solvers::granular::rig::{
    Cycle, CycleSample, Rig, RigError, SensorReading, SpecimenState, StoredTrial, Trial,
};
use serde::{Deserialize, Serialize};

/// A packing under test, as it ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tested {
    pub seed: u64,
    pub cycles: Vec<Cycle>,
    pub samples: Vec<CycleSample>,
    pub readings: Vec<SensorReading>,
    /// States of a specimen with sides that give way.
    pub specimen: Vec<SpecimenState>,
    /// Time steps of the test.
    pub steps: u64,
    /// Bonds of glued grains at its end.
    #[serde(default)]
    pub bonds: Bonds,
}

/// A test that is not finished, as data.
pub type TestState = StoredTrial<f32>;

/// A test on its way.
pub struct BedUnderActuators<'a> {
    seed: u64,
    trial: Trial<'a, f32>,
}

impl<'a> BedUnderActuators<'a> {
    /// Sets sleepers, or a plate, down on `copies` cells of a packed bed side by side, and lets them come to rest.
    pub fn new(
        seed: u64,
        mut packed: Packed<f32>,
        copies: u32,
        rig: &'a Rig,
        tell: &mut Telling<'_>,
    ) -> Result<Self, NodeError> {
        let failed = |failure| RigError::Failure { cycle: 0, failure };
        let whole = if copies == 1 { packed.bed } else { packed.bed.replicate(copies).map_err(failed)? };
        Ok(BedUnderActuators { seed, trial: Trial::new(whole, rig, |share| tell(Stage::Sleepers, share))? })
    }

    /// Goes on from a state that was kept of the same rig.
    pub fn restore(seed: u64, state: TestState, rig: &'a Rig) -> Result<Self, NodeError> {
        let foreign = |why: &dyn std::fmt::Display| NodeError::Foreign { node: "bed", why: why.to_string() };
        Ok(BedUnderActuators { seed, trial: Trial::restore(state, rig).map_err(|error| foreign(&error))? })
    }

    /// Runs the next piece of a cycle; false where there is none.
    pub fn advance(&mut self) -> Result<bool, NodeError> {
        Ok(self.trial.advance()?)
    }

    /// Pieces that are done, and those of the whole test.
    pub fn pieces(&self) -> (u64, u64) {
        (self.trial.done(), self.trial.pieces())
    }

    /// Cycles that the first actuator has ended.
    pub fn cycles(&self) -> u64 {
        self.trial.cycles().last().map_or(0, |cycle| cycle.number)
    }

    /// The state as data.
    pub fn save(&self) -> TestState {
        self.trial.store()
    }

    /// Its answer, and the bed as it ended.
    pub fn finish(self) -> (Tested, Bed<f32>) {
        let trial = self.trial;
        let tested = Tested {
            seed: self.seed,
            cycles: trial.cycles().to_vec(),
            samples: trial.samples().to_vec(),
            readings: trial.readings().to_vec(),
            specimen: trial.specimen().to_vec(),
            steps: trial.steps(),
            bonds: Bonds::in_bed(&trial.bed),
        };
        (tested, trial.bed)
    }
}
