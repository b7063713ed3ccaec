//! The schedule of test rigs: each bed is packed, or read from the store of beds, and tested.

use super::event::tell_stage;
use super::machine::{Ending, Machine, RunError};
use super::{Between, Checkpoint, Event, Listener, ScheduleState};
use crate::graph::{ActuatorsNode, BedNode, Clock, Tests};
use crate::nodes::{BedUnderActuators, NodeError, TestState, Tested};
use crate::solvers::granular::Bed;

pub(super) fn run(
    machine: &Machine<'_>,
    tests: &Tests,
    listener: &mut dyn Listener,
    from: Option<Checkpoint>,
) -> Result<Ending, RunError> {
    let (mut done, mut running) = match from.map(|checkpoint| checkpoint.state) {
        None => (Vec::new(), None),
        Some(ScheduleState::Tests { done, running }) => (done, running),
        Some(_) => return Err(RunError::ForeignCheckpoint),
    };
    let none = NodeError::NoBuilder { node: "bed".into(), kind: "bed under actuators".into() };
    let (bed, actuators) = machine.graph.bed_under_actuators().ok_or_else(|| failed_after(0, none))?;
    let packings = tests.packings.max(1) as usize;
    while done.len() < packings {
        let mut test = Test { machine, tests, bed, actuators, listener, done: &done };
        let Some((tested, bed)) = test.run(running.take().map(|state| *state))? else { return Ok(Ending::Stopped) };
        done.push(tested);
        if listener.hear(&Event::Tested { tested: &done[done.len() - 1], bed: &bed }).is_break() {
            return Ok(Ending::Stopped);
        }
        // the state before the end of the last test holds its bed, which results show
        let state = || Ok(checkpoint(&done, None));
        let between = Between { is_last: false, state: &state };
        if done.len() < packings && listener.hear(&Event::Between(between)).is_break() {
            return Ok(Ending::Stopped);
        }
    }
    Ok(Ending::Finished)
}

fn failed_after(cycles: u64, cause: NodeError) -> RunError {
    RunError::node(Clock::Cycles(cycles), cause)
}

fn checkpoint(done: &[Tested], running: Option<(u64, TestState)>) -> Checkpoint {
    let before: u64 = done.iter().filter_map(|test| test.cycles.last()).map(|cycle| cycle.number).sum();
    let clock = Clock::Cycles(before + running.as_ref().map_or(0, |(cycles, _)| *cycles));
    let running = running.map(|(_, state)| Box::new(state));
    Checkpoint { clock, state: ScheduleState::Tests { done: done.to_vec(), running } }
}

/// One packing on its way.
struct Test<'a, 'l> {
    machine: &'a Machine<'a>,
    tests: &'a Tests,
    bed: &'a BedNode,
    actuators: &'a ActuatorsNode,
    listener: &'l mut dyn Listener,
    done: &'a [Tested],
}

impl Test<'_, '_> {
    /// Packs and tests, or continues a stored test; `None` if a listener ended it.
    fn run(&mut self, running: Option<TestState>) -> Result<Option<(Tested, Bed<f32>)>, RunError> {
        let seed = self.bed.bed.seed().wrapping_add(u64::from(self.tests.first) + self.done.len() as u64);
        let ready = self.bed.bed.ready(seed).map_err(|cause| failed_after(0, NodeError::Bed(cause)))?;
        let found = self.machine.beds.bed(&ready.recipe, |progress| self.listener.hear(&Event::Packing(progress)));
        let found = match found.map_err(NodeError::from) {
            Err(NodeError::Stopped) => return Ok(None),
            found => found.map_err(|cause| failed_after(0, cause))?,
        };
        if self.listener.hear(&Event::Packed { bed: &ready, found: &found }).is_break() {
            return Ok(None);
        }
        let top = found.packed.levels.last().copied().unwrap_or_default();
        let rig = self.bed.rig(self.actuators, &ready.recipe, top, &self.tests.kept);
        let begun = match running {
            Some(state) => BedUnderActuators::restore(seed, state, &rig),
            None => BedUnderActuators::new(seed, found.packed, self.bed.copies, &rig, &mut |stage, share| {
                tell_stage(self.listener, stage, share)
            }),
        };
        let mut test = match begun {
            Err(NodeError::Stopped) => return Ok(None),
            begun => begun.map_err(|cause| failed_after(0, cause))?,
        };
        loop {
            let advanced = test.advance();
            if !advanced.map_err(|cause| failed_after(test.cycles(), cause))? {
                return Ok(Some(test.finish()));
            }
            let (done, all) = test.pieces();
            let progress = self.listener.hear(&Event::Progress { done, all });
            let state = || Ok(checkpoint(self.done, Some((test.cycles(), test.save()))));
            let between = Between { is_last: done == all, state: &state };
            if progress.is_break() || self.listener.hear(&Event::Between(between)).is_break() {
                return Ok(None);
            }
        }
    }
}
