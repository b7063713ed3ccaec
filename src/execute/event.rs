//! What a run tells, and to whom: one kind of event for every schedule.

use super::BlockMeasures;
use crate::graph::{BedRecipe, Block, Clock, Control, Runner};
use crate::nodes::{BedUnderTrack, NodeError, PassageOutcome, Stage, TestState, Tested, Told, Unloaded, VolumeSample};
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::Progress;
use crate::store::FoundBed;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Something that has happened. Nothing is computed twice, so who listens must keep what is needed.
pub enum Event<'a> {
    /// The track at rest, without test loads and under them.
    Equilibrium { unloaded: &'a Unloaded, loaded: &'a Unloaded },
    /// The track without a train, at an axle count that is recorded.
    Rest { axles: u64, state: &'a Unloaded },
    /// The beds of grains under the track at an axle count that is recorded: at rest, or as the leading bogie of the next train passes.
    Beds { axles: u64, under_train: bool, beds: &'a [BedUnderTrack<'a>] },
    /// A passage at a recorded count; there is one of each kind of train, the leading one first.
    Passage { axles: u64, runner: Runner, passage: &'a PassageOutcome },
    /// Volumes of grains in a passage at a recorded count, after the passage.
    Volumes { axles: u64, samples: &'a [VolumeSample] },
    /// A block is done: the passages at its start, and the settlement of every seat before and after it, m. `block` is `None` for
    /// the passages after the last block.
    Block {
        axles: u64,
        block: Option<(&'a Block, &'a BlockMeasures)>,
        passages: &'a [&'a PassageOutcome],
        before: &'a [f64],
        after: &'a [f64],
    },
    /// Seats are tamped: the settlement of every seat before and after it, m. What is recorded at that count has been told, and
    /// shows the track before.
    Tamped { axles: u64, seats: &'a [usize], before: &'a [f64], after: &'a [f64] },
    /// Settlement of every seat by each law, the driving one first, m: as built, after each block and after each tamping.
    Laws { axles: u64, settlement: &'a [Vec<f64>] },
    /// A bed is being packed.
    Packing(&'a Progress),
    /// A bed is there.
    Packed { bed: &'a BedRecipe, found: &'a FoundBed },
    /// A test is over; the bed is as it ended.
    Tested { tested: &'a Tested, bed: &'a Bed<f32> },
    /// Something that only a schedule of another program knows.
    Custom { clock: Clock, what: &'a serde_json::Value },
    /// Between two steps of the schedule, or where trains on grains are under way: the state may be kept here.
    Between(Between<'a>),
    /// Steps of the schedule done, and to be done in all; the latter is an estimate that changes while the run goes on.
    Progress { done: u64, all: u64 },
}

/// Tells what a track on grains is busy with, and how far it is.
pub(super) fn tell_stage(listener: &mut dyn Listener, stage: Stage, share: f64) -> ControlFlow<()> {
    let progress = Progress { stage: stage.to_string(), share, bodies: 0, steps: 0 };
    listener.hear(&Event::Packing(&progress))
}

/// Tells what trains on grains do in a block that began after so many axles, with so many blocks done and this control: how far they are,
/// and the states from which they can be gone on with.
pub(super) fn tell_of_trains(
    listener: &mut dyn Listener,
    (axles, blocks, control): (u64, usize, Control),
    told: Told<'_>,
) -> ControlFlow<()> {
    match told {
        Told::Stage(stage, share) => tell_stage(listener, stage, share),
        Told::Beds(beds) => listener.hear(&Event::Beds { axles, under_train: true, beds: &beds }),
        Told::State(ground) => {
            let state = || {
                let state = ScheduleState::Blocks { blocks, control, ground: ground()? };
                Ok(Checkpoint { clock: Clock::Axles(axles), state })
            };
            listener.hear(&Event::Between(Between { is_last: false, state: &state }))
        }
    }
}

/// A moment at which a run can be interrupted and taken up again.
pub struct Between<'a> {
    /// Whether nothing but the writing of results follows: what is lost here is lost whole.
    pub is_last: bool,
    pub(super) state: &'a dyn Fn() -> Result<Checkpoint, NodeError>,
}

impl<'a> Between<'a> {
    /// A moment of a schedule of another program; `state` is asked only where somebody keeps it.
    pub fn new(is_last: bool, state: &'a dyn Fn() -> Result<Checkpoint, NodeError>) -> Between<'a> {
        Between { is_last, state }
    }

    /// The state of now. Of a large bed it takes a moment.
    pub fn checkpoint(&self) -> Result<Checkpoint, NodeError> {
        (self.state)()
    }
}

/// The state between two steps of a schedule: a run that starts from it gives the same bits as one that never stopped.
#[derive(Serialize, Deserialize)]
pub struct Checkpoint {
    pub clock: Clock,
    pub state: ScheduleState,
}

/// What a schedule and its nodes hold.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScheduleState {
    /// Blocks done, what the length of the next one hangs on, and the state of the ground.
    Blocks { blocks: usize, control: Control, ground: serde_json::Value },
    /// Tests that are over, and the one under way.
    Tests { done: Vec<Tested>, running: Option<Box<TestState>> },
    /// The state of a schedule of another program.
    Custom(serde_json::Value),
}

/// Hears what a run tells.
pub trait Listener {
    /// Hears an event. A break ends the run; the reason is the listener's own to keep.
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()>;
}

/// Two listeners hear the same, one after the other; each may end the run.
pub struct Both<'a>(pub &'a mut dyn Listener, pub &'a mut dyn Listener);

impl Listener for Both<'_> {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        let (first, second) = (self.0.hear(event), self.1.hear(event));
        if first.is_break() { first } else { second }
    }
}

/// Nobody listens.
impl Listener for () {
    fn hear(&mut self, _: &Event<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// A function listens.
impl<F: FnMut(&Event<'_>) -> ControlFlow<()>> Listener for F {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        self(event)
    }
}
