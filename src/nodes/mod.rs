//! Solvers behind ports: the traits that a schedule needs of superstructure and substructure, and one adapter for each
//! node.
//!
//! A node is built from its data in the graph ([`build`]). Data between two nodes have a type of this folder; name,
//! unit and rate of a port are in the graph.

mod build;
mod check;
mod error;
mod grains;
mod law;
mod on_cells;
mod on_grains;
mod outcome;
mod profile;
mod sampler;
mod standing;
mod steps;
mod track;
pub mod turns;

pub use build::Builders;
pub use check::CheckingCells;
pub use error::NodeError;
pub use grains::{BedUnderActuators, TestState, Tested};
pub use law::LawGround;
pub use on_cells::{CellGround, Checked, Parts as CellParts, Passed, Specimen, StepOfCell, TrainForces};
pub use on_grains::{
    BedUnderTrack, Following, GrainGround, Parted, Parts as GrainParts, PassageEnergy, Riders, Stage, Telling,
    TimedSteps, Told, VolumeSample, mass_for_step,
};
pub use outcome::{
    PassageOutcome, RailPlace, RailPoint, Sample, SampledPart, SeatForces, SeatOutcome, Unloaded, UnloadedSeat,
    WheelHistories,
};
pub use profile::between;
pub use standing::StandingForces;
pub use steps::Steps;
pub use track::{RUNAWAY, TrackSystem};

use crate::graph::{PointLoad, Responses, Runner};
use crate::solvers::granular::{Bed, Real};
use crate::solvers::settlement::Peak;
use serde::{Deserialize, Serialize};
use std::any::Any;

/// Records of a passage in addition to its outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    Nothing,
    Histories,
    /// Histories, and the unloaded rail under the mean wheel of the train.
    Profile,
}

/// Forces of a passage that a substructure needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Forces {
    /// The peak under each wheel.
    Peaks,
    /// Peaks and the whole history at every seat.
    Histories,
    /// Peaks, and place and force of every wheel.
    Wheels,
}

/// A passage to be computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request<'a> {
    /// Axles that have passed.
    pub axles: u64,
    /// Settlement of every seat, m.
    pub settlement: &'a [f64],
    pub runner: Runner,
    pub kept: Kept,
    pub forces: Forces,
}

/// Rails, sleepers and vehicles: settlement and responses of the ground in, states of rest and passages out.
pub trait Superstructure: Sync {
    /// Takes the responses of the ground. It costs no time if their revision is known.
    fn stand_on(&mut self, responses: &Responses) -> Result<(), NodeError>;

    /// The track at rest under test loads, on the settlement of every seat, m.
    fn equilibrium(&self, settlement: &[f64], loads: &[PointLoad]) -> Result<Unloaded, NodeError>;

    /// One train over the settled track, and the track at rest before it.
    fn passage(&self, request: Request<'_>) -> Result<(Unloaded, PassageOutcome), NodeError>;
}

/// Trains that pass one after the other with the forces of one computed passage.
#[derive(Debug, Clone, Copy)]
pub struct Load<'a> {
    pub passage: &'a PassageOutcome,
    /// Largest forces of its wheels where they have followed the settlement since; index by seat, then by wheel.
    pub followed: Option<&'a [Vec<Peak>]>,
    pub trains: u64,
    pub joined: Joined,
}

/// Whether equal trains run directly ahead of a run of trains and directly behind it, where trains follow each other
/// closely. Such a run begins and ends between the two halves of a train, where the track between them carries nothing;
/// a run without neighbours has its first and its last half in addition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Joined {
    pub ahead: bool,
    pub behind: bool,
}

impl<'a> Load<'a> {
    /// Trains with the forces of a passage as it was computed, with no other train ahead or behind.
    pub fn new(passage: &'a PassageOutcome, trains: u64) -> Load<'a> {
        Load { passage, followed: None, trains, joined: Joined::default() }
    }

    /// Largest force of each wheel of a train on the support of every seat.
    pub fn peaks(&self) -> &'a [Vec<Peak>] {
        self.followed.unwrap_or(&self.passage.peaks)
    }
}

/// Number of bonds between glued grains, by their state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Bonds {
    pub intact: u64,
    /// Since the grains were glued.
    pub broken: u64,
}

impl Bonds {
    /// Bonds of a bed.
    pub fn in_bed<R: Real>(bed: &Bed<R>) -> Bonds {
        Bonds { intact: bed.bonds() as u64, broken: bed.broken_bonds() }
    }

    /// All that were made.
    pub fn made(self) -> u64 {
        self.intact + self.broken
    }
}

impl std::iter::Sum for Bonds {
    fn sum<I: Iterator<Item = Bonds>>(beds: I) -> Bonds {
        beds.fold(Bonds::default(), |a, b| Bonds { intact: a.intact + b.intact, broken: a.broken + b.broken })
    }
}

/// A state to which a substructure can be rolled back.
pub struct Mark(pub Box<dyn Any + Send>);

/// Whether the settlement of every seat, m, after so many trains of a block is even enough to go on with its forces.
pub type Even<'a> = dyn Fn(&[f64], u64) -> bool + 'a;

/// The ground below the sleepers: forces in, responses and settlement out.
pub trait Substructure: Send + Sync {
    /// Builds the parts that take long to build; `tell` gets the progress. It is not called if the state is restored.
    fn prepare(&mut self, _tell: &mut Telling<'_>) -> Result<(), NodeError> {
        Ok(())
    }

    /// Stiffness, damping and seating of every seat.
    fn responses(&self) -> &Responses;

    /// Settlement of every seat, m: that of the start and what traffic has added.
    fn settlement(&self) -> Vec<f64>;

    /// Settlement of every seat by each of the laws that are compared, the driving one first, m; empty if nothing
    /// settles by laws.
    fn settlement_by_law(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// The forces of a passage that it needs.
    fn forces(&self) -> Forces {
        Forces::Peaks
    }

    /// Whether its settlement depends on the voids under the sleepers.
    fn sees_voids(&self) -> bool {
        false
    }

    /// Settlement of every seat (m) that these trains would leave. Changes nothing.
    fn predict(&self, loads: &[Load<'_>]) -> Result<Vec<f64>, NodeError>;

    /// Whether [`Substructure::predict`] gives exactly the settlement that a block leaves.
    fn foresees(&self) -> bool {
        true
    }

    /// Lets trains pass. After an error the state is that of the last mark only once it is rolled back.
    fn advance(&mut self, loads: &[Load<'_>]) -> Result<(), NodeError>;

    /// The same; `follow` gets the progress and may store the state on the way. If an earlier state is restored, the
    /// same trains continue from there.
    fn advance_and_follow(&mut self, loads: &[Load<'_>], _follow: &mut Following<'_>) -> Result<(), NodeError> {
        self.advance(loads)
    }

    /// The same for trains of one load, until the settlement of the seats (m) after so many of them is no longer
    /// `even`; at least one passes. Returns the number of trains that have passed. A substructure that cannot stop
    /// between two trains lets all of them pass.
    fn advance_while(
        &mut self,
        load: &Load<'_>,
        _even: &Even<'_>,
        follow: &mut Following<'_>,
    ) -> Result<u64, NodeError> {
        self.advance_and_follow(std::slice::from_ref(load), follow)?;
        Ok(load.trains)
    }

    /// Records the first passage of the next block, as a passage after so many axles, if volumes are recorded at that
    /// count.
    fn record(&mut self, _axles: u64) {}

    /// The records of the last block; they are given once.
    fn recorded(&mut self) -> Vec<VolumeSample> {
        Vec::new()
    }

    /// Lets a train pass only to record it, as a passage after so many axles, and changes nothing.
    fn record_alone(
        &mut self,
        _axles: u64,
        _load: &Load<'_>,
        _follow: &mut Following<'_>,
    ) -> Result<Vec<VolumeSample>, NodeError> {
        Ok(Vec::new())
    }

    /// Bonds of all glued grains under the track.
    fn bonds(&self) -> Bonds {
        Bonds::default()
    }

    /// Standard error of the settlement added by the last block, at the worst seat, m.
    fn error_added(&self) -> f64 {
        0.0
    }

    /// Whether it was restored in the middle of a block of trains. Until the block is done it answers as when it began.
    fn is_underway(&self) -> bool {
        false
    }

    /// The beds of grains under the track as they lie now; none if it stands on something else. Reading the beds does
    /// not change later results.
    fn beds(&mut self) -> Result<Vec<BedUnderTrack<'_>>, NodeError> {
        Ok(Vec::new())
    }

    /// The present state, to be rolled back to.
    fn mark(&self) -> Mark;

    /// Goes back to a state that this substructure has marked.
    fn roll_back(&mut self, mark: Mark);

    /// Lifts seats, ascending, until only the share `left` of their settlement stays.
    fn tamp(&mut self, seats: &[usize], left: f64) -> Result<(), NodeError>;

    /// The state as data, to go on from in another process.
    fn save(&self) -> Result<serde_json::Value, NodeError>;

    /// Takes up a state that was saved; fails if it is of another substructure.
    fn restore(&mut self, state: &serde_json::Value) -> Result<(), NodeError>;
}
