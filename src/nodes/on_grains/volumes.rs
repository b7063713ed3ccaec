//! When a passage over grains is recorded: in which block, from when on, and the passage after the last block.

use super::build::Parts;
use super::recording::{Recording, VolumeSample};
use super::underway::Following;
use super::{GrainGround, Live, Told, going_on};
use crate::graph::SleeperOnGrains;
use crate::nodes::{Load, NodeError};
use std::ops::ControlFlow;

/// The third of some sleepers.
const THIRD: usize = 2;

impl Live {
    /// Records the passage that comes next as one after so many axles.
    pub fn begin_record(&mut self, parts: Parts<'_>, axles: u64) {
        let recording = Recording::begin(&self.coupled, self.tops(), parts, axles);
        self.block().recording = Some(recording);
    }

    /// Reports the beds when the leading wheel, at a place (m), reaches the sleepers beside the structure.
    pub(super) fn tell_beds(
        &mut self,
        parts: Parts<'_>,
        recording: &mut Recording,
        leading: Option<f64>,
        follow: &mut Following<'_>,
    ) -> Result<(), NodeError> {
        let Some((leading, place)) = leading.zip(parts.beside_structure()) else { return Ok(()) };
        if !recording.wheel_comes(leading, place) {
            return Ok(());
        }
        let beds = self.look(parts, &recording.tops)?;
        going_on(follow(Told::Beds(beds)))
    }

    /// The record of the passage under way, taken out for some steps: of the first one of the block only, and only
    /// where `wanted`.
    pub(super) fn recording(&mut self, wanted: bool) -> Option<Recording> {
        let underway = self.block();
        if underway.runs > 0 || underway.passages > 0 || !wanted { None } else { underway.recording.take() }
    }

    /// Puts a record back that was taken out.
    pub(super) fn go_on_recording(&mut self, recording: Option<Recording>) {
        if recording.is_some() {
            self.block().recording = recording;
        }
    }

    /// The records of the block under way.
    pub fn recorded(&mut self) -> Vec<VolumeSample> {
        let recording = self.underway.as_mut().and_then(|underway| underway.recording.take());
        recording.map(|recording| recording.samples).unwrap_or_default()
    }
}

impl Parts<'_> {
    /// Chainage of the third sleeper before the structure, m. Forces are kept when the leading wheel is there: a bogie
    /// then stands where tracks settle most.
    fn beside_structure(&self) -> Option<f64> {
        let seats = &self.track.seats;
        let sleepers = &self.grains.stretches.first()?.sleepers;
        let x = |sleeper: &SleeperOnGrains| seats[sleeper.seat].x;
        let behind = seats.get(sleepers.last()?.seat + 1);
        let at_right = behind.is_some_and(|seat| !seat.is_ballasted());
        let third = THIRD.min(sleepers.len() - 1);
        Some(x(&sleepers[if at_right { sleepers.len() - 1 - third } else { third }]))
    }
}

impl GrainGround<'_> {
    /// Lets a train pass over a copy, only to record it as one after so many axles.
    pub(super) fn record_copy(
        &self,
        axles: u64,
        load: &Load<'_>,
        follow: &mut Following<'_>,
    ) -> Result<Vec<VolumeSample>, NodeError> {
        let parts = self.parts();
        if !parts.grains.volumes.iter().any(|volume| volume.after.contains(&axles)) {
            return Ok(Vec::new());
        }
        let mut copy = self.live_at_rest()?.clone();
        copy.begin_record(parts, axles);
        // a run does not go on from a copy
        copy.pass(parts, load, &mut |told| match told {
            Told::Stage(..) | Told::Beds(_) => follow(told),
            Told::State(_) => ControlFlow::Continue(()),
        })?;
        Ok(copy.recorded())
    }
}
