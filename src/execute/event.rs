//! Events of a run and their listeners: one type of event for every schedule.

use super::{BlockMeasures, Comparison};
use crate::graph::{BedRecipe, Block, Clock, Control, Runner};
use crate::nodes::{
    BedUnderTrack, Checked, NodeError, PassageOutcome, Stage, TestState, Tested, Told, Unloaded, VolumeSample,
};
use crate::solvers::granular::Bed;
use crate::solvers::granular::packing::Progress;
use crate::store::FoundBed;
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// An event. Nothing is computed twice, so a listener must store the data that it needs.
pub enum Event<'a> {
    /// The track at rest, without test loads and under them.
    Equilibrium { unloaded: &'a Unloaded, loaded: &'a Unloaded },
    /// The track without a train, at an axle count that is recorded.
    Rest { axles: u64, state: &'a Unloaded },
    /// The beds of grains under the track at an axle count that is recorded: at rest, or under the leading bogie of the
    /// next train.
    Beds { axles: u64, under_train: bool, beds: &'a [BedUnderTrack<'a>] },
    /// A passage at a recorded count; there is one of each kind of train, the leading one first.
    Passage { axles: u64, runner: Runner, passage: &'a PassageOutcome },
    /// Volumes of grains in a passage at a recorded count, after the passage.
    Volumes { axles: u64, samples: &'a [VolumeSample] },
    /// A block is done: the passages at its start, and the settlement of every seat before and after it, m. `block` is
    /// `None` for the passages after the last block.
    Block {
        axles: u64,
        block: Option<(&'a Block, &'a BlockMeasures)>,
        passages: &'a [&'a PassageOutcome],
        before: &'a [f64],
        after: &'a [f64],
    },
    /// Seats are tamped: the settlement of every seat before and after it, m. The records of that count were reported
    /// before, and show the track before tamping.
    Tamped { axles: u64, seats: &'a [usize], before: &'a [f64], after: &'a [f64] },
    /// Settlement of every seat by each law, the driving one first, m: as built, after each block and after each
    /// tamping.
    Laws { axles: u64, settlement: &'a [Vec<f64>] },
    /// A passage was compared with a finer one.
    Compared(&'a Comparison),
    /// Cells of grains have passed the trains so far: by seat, the settlement that trains have added, m, and of its
    /// cell.
    Checked { axles: u64, seats: &'a [usize], settled: &'a [f64], cells: &'a [Checked] },
    /// A bed is being packed.
    Packing(&'a Progress),
    /// A bed is finished.
    Packed { bed: &'a BedRecipe, found: &'a FoundBed },
    /// A test is over; the bed is as it ended.
    Tested { tested: &'a Tested, bed: &'a Bed<f32> },
    /// An event of a schedule of another program.
    Custom { clock: Clock, what: &'a serde_json::Value },
    /// Between two steps of the schedule, or while trains on grains are under way: the state may be stored here.
    Between(Between<'a>),
    /// Steps of the schedule done, and to be done in all; the latter is an estimate that changes while the run goes on.
    Progress { done: u64, all: u64 },
}

/// Reports the stage of a track on grains, and its progress.
pub(super) fn tell_stage(listener: &mut dyn Listener, stage: Stage, share: f64) -> ControlFlow<()> {
    let progress = Progress { stage: stage.to_string(), share, bodies: 0, steps: 0 };
    listener.hear(&Event::Packing(&progress))
}

/// Reports trains on grains in a block that began after so many axles, with so many blocks done and this control: their
/// progress, and the states from which a run can continue.
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
                let state = ScheduleState::Blocks { blocks, control, ground: ground()?, check: None, compared: None };
                Ok(Checkpoint { clock: Clock::Axles(axles), state })
            };
            listener.hear(&Event::Between(Between { is_last: false, state: &state }))
        }
    }
}

/// A moment at which a run can be interrupted and taken up again.
pub struct Between<'a> {
    /// Whether only the writing of results follows: a loss here would lose the whole run.
    pub is_last: bool,
    pub(super) state: &'a dyn Fn() -> Result<Checkpoint, NodeError>,
}

impl<'a> Between<'a> {
    /// A moment of a schedule of another program; `state` is called only if a listener stores the state.
    pub fn new(is_last: bool, state: &'a dyn Fn() -> Result<Checkpoint, NodeError>) -> Between<'a> {
        Between { is_last, state }
    }

    /// The present state. For a large bed this takes some time.
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

/// State of a schedule and its nodes.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScheduleState {
    /// Blocks done, the data for the length of the next block, and the state of the ground.
    Blocks {
        blocks: usize,
        control: Control,
        ground: serde_json::Value,
        /// The state of the cells that check the ground.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        check: Option<serde_json::Value>,
        /// The comparison of a passage with a finer one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        compared: Option<Comparison>,
    },
    /// Tests that are over, and the one under way.
    Tests { done: Vec<Tested>, running: Option<Box<TestState>> },
    /// The state of a schedule of another program.
    Custom(serde_json::Value),
}

/// A listener of a run.
pub trait Listener {
    /// Gets an event. A break ends the run; the listener must store the reason itself.
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
