//! The schedule of trains that ride on a rail over grains: nothing is exchanged between blocks; a block only sets when
//! the state is reported.

use super::Between;
use super::blocks::{Restored, bearable, restored};
use super::event::{Checkpoint, Event, Listener, ScheduleState, tell_of_trains, tell_stage};
use super::machine::{Ending, Machine, RunError};
use super::step::BlockMeasures;
use crate::graph::{Blocks, Clock, Control};
use crate::nodes::{GrainGround, NodeError, PassageOutcome, Riders, Substructure};

/// Runs the trains of a graph, from the beginning or from a checkpoint.
pub(super) fn run(
    machine: &Machine<'_>,
    blocks: &Blocks,
    listener: &mut dyn Listener,
    from: Option<Checkpoint>,
) -> Result<Ending, RunError> {
    let at = |axles: u64| move |cause: NodeError| RunError::node(Clock::Axles(axles), cause);
    let no_grains = || NodeError::Other { node: "grains".into(), why: "the scene has no grains under a track".into() };
    let parts = machine.grain_parts().ok_or_else(no_grains).map_err(at(0))?;
    let Restored { blocks: mut done, mut axles, ground: state, .. } = restored(from, blocks)?;
    let mut ground = GrainGround::new(parts);
    let begun = match &state {
        Some(state) => ground.restore(state),
        None => ground.prepare(&mut |stage, share| tell_stage(listener, stage, share)),
    };
    match begun {
        Err(NodeError::Stopped) => return Ok(Ending::Stopped),
        begun => begun.map_err(at(axles))?,
    }
    loop {
        let last = axles >= blocks.total;
        let trains = blocks.wanted(axles).unwrap_or(1).max(1);
        let block = blocks.block(axles, trains);
        let shown = blocks.recorded.binary_search(&axles).is_ok();
        let told = ground.is_underway();
        let unloaded = ground.at_rest().map_err(at(axles))?;
        if shown && !told && listener.hear(&Event::Rest { axles, state: &unloaded }).is_break() {
            return Ok(Ending::Stopped);
        }
        if shown && !told {
            let beds = ground.look().map_err(at(axles))?;
            if listener.hear(&Event::Beds { axles, under_train: false, beds: &beds }).is_break() {
                return Ok(Ending::Stopped);
            }
        }
        let before = ground.settlement();
        let runs =
            if last { blocks.leading().into_iter().map(|runner| (runner, 1)).collect() } else { block.runs.clone() };
        let mut passages = ground.begin_rides().map_err(at(axles))?;
        for (runner, trains) in runs.into_iter().skip(passages.len()) {
            let records = shown.then_some(machine.graph.records.as_slice());
            let riders = Riders { blocks, runner, trains, axles, records };
            let began = (axles, done as usize, Control::default());
            let passage = match ground.ride(&riders, &mut |told| tell_of_trains(listener, began, told)) {
                Err(NodeError::Stopped) => return Ok(Ending::Stopped),
                passage => passage.map_err(at(axles))?,
            };
            if shown
                && passages.is_empty()
                && listener.hear(&Event::Passage { axles, runner, passage: &passage }).is_break()
            {
                return Ok(Ending::Stopped);
            }
            passages.push(passage);
        }
        ground.end_rides().map_err(at(axles))?;
        let samples = ground.recorded();
        if !samples.is_empty() && listener.hear(&Event::Volumes { axles, samples: &samples }).is_break() {
            return Ok(Ending::Stopped);
        }
        let passages: Vec<&PassageOutcome> = passages.iter().collect();
        let after = if last { before.clone() } else { ground.settlement() };
        bearable(axles + block.axles, &after)?;
        let steps = passages.iter().map(|passage| passage.time_steps).sum();
        let (passages_done, bonds) = (passages.len() as u64, ground.bonds());
        let measured = BlockMeasures { passages: passages_done, time_steps: steps, bonds, ..BlockMeasures::default() };
        let told = (!last).then_some((&block, &measured));
        let event = Event::Block { axles, block: told, passages: &passages, before: &before, after: &after };
        let all = blocks.planned().map_or(done + 1, |planned| planned.len() as u64 + 1);
        if listener.hear(&event).is_break() || last && listener.hear(&Event::Progress { done: all, all }).is_break() {
            return Ok(Ending::Stopped);
        }
        if last {
            return Ok(Ending::Finished);
        }
        (axles, done) = (axles + block.axles, done + 1);
        let state = || {
            let ground = ground.save()?;
            let state = ScheduleState::Blocks {
                blocks: done as usize,
                control: Control::default(),
                ground,
                check: None,
                compared: None,
            };
            Ok(Checkpoint { clock: Clock::Axles(axles), state })
        };
        let between = Event::Between(Between::new(false, &state));
        if listener.hear(&between).is_break() || listener.hear(&Event::Progress { done, all }).is_break() {
            return Ok(Ending::Stopped);
        }
    }
}
