//! The solver graph: nodes that own state, edges that carry one quantity each, and the schedule that runs them block by
//! block (Fig. 3 of the paper).
//!
//! The graph is data: it is printed by `trackbed plan`, costed before a run, and executed by [`execute`].

mod blocks;
mod control;
mod exchange;
mod execute;
mod listing;
pub mod model;
mod oscillation;
mod profile;
mod sampler;
mod step;
mod substructure;
mod system;
mod track;

pub use blocks::Due;
pub use control::Control;
pub use execute::{Checkpoint, Recorder, RunError, execute, execute_all, passage_as_built};
pub use listing::Listing;
pub use profile::between;
pub use step::Measured;
pub use substructure::SubstructureState;
pub use system::{RUNAWAY, Steps};
pub use track::{PassageOutcome, RailPlace, RailPoint, Sample, SeatOutcome, Target, Unloaded, UnloadedSeat};

use crate::scenario::{Beam, Direction, Integrator, Record, Sequence, StaticLoad, Tamping, Track, Train, Update};
use crate::solvers::settlement::Law;
use serde::{Deserialize, Serialize};

/// A lowered scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Graph {
    pub track: TrackNode,
    pub substructure: SubstructureNode,
    pub schedule: Schedule,
    pub records: Vec<Record>,
    /// What each pass decided, and why.
    pub decisions: Vec<Decision>,
    pub estimate: Estimate,
}

/// The 2D track with the vehicles on it: one coupled system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackNode {
    pub track: Track,
    pub beam: Beam,
    pub elements_per_bay: u32,
    /// m/s^2.
    pub gravity: f64,
}

/// What carries the sleepers: forces in, stiffness and settlement out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SubstructureNode {
    /// A settlement law under each sleeper; stiffness as the scene gives it. `followers` are evaluated under the forces
    /// that the driving law leads to.
    Law { law: NamedLaw, followers: Vec<NamedLaw> },
    /// Nothing settles: a track at rest under test loads.
    Fixed,
}

/// A settlement law under the name that the scene gives it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedLaw {
    pub name: String,
    pub law: Law,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Schedule {
    /// One state of equilibrium.
    Static { loads: Vec<StaticLoad> },
    /// Blocks of trains, each with one exchange of forces and settlement.
    Blocks(Box<Blocks>),
}

/// The loop over axles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Blocks {
    /// The train that leads the traffic, and how its passages are integrated.
    pub train: Train,
    pub passage: PassagePlan,
    /// Trains of other kinds.
    pub others: Vec<(Train, PassagePlan)>,
    /// Which train runs when.
    pub sequence: Sequence,
    /// How long the blocks are.
    pub update: Update,
    /// Whether a fixed or geometric block that overshoots is done again in halves. Off, the oscillation shows.
    pub cure: bool,
    /// Axle counts at which the state of the track is recorded, ascending.
    pub recorded: Vec<u64>,
    pub tampings: Vec<Tamping>,
    /// Axle counts at which a block ends, ascending: those, the counts of tampings and those at which another kind of train
    /// begins.
    pub stops: Vec<u64>,
    /// Axles of the whole run.
    pub total: u64,
}

/// How one passage is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PassagePlan {
    /// Chainage of the wheel nearest to the left end while the train stands at the left, m, and of the wheel nearest
    /// to the right end while it stands at the right.
    pub left: f64,
    pub right: f64,
    /// s; the longest one where steps vary.
    pub time_step: f64,
    /// Steps are halved down to `time_step / 2^halvings` where their error asks for it.
    pub adaptive: Option<AdaptiveSteps>,
    pub integrator: Integrator,
    /// Interval of histories, in time steps, the longest ones where they vary.
    pub sample_every: u64,
}

impl PassagePlan {
    /// Chainages between which every wheel of a train comes and goes, m.
    pub fn passed(&self, train: &Train) -> std::ops::Range<f64> {
        let base = train.wheel_base();
        self.left + base + APPROACH..self.right - base - APPROACH
    }

    /// The shortest step that a passage may take, s.
    pub fn shortest_step(&self) -> f64 {
        self.time_step * self.adaptive.map_or(1.0, |steps| 0.5f64.powi(steps.halvings as i32))
    }

    /// A step as it is on average, for estimates, s: where steps vary, a quarter of the longest.
    pub fn usual_step(&self) -> f64 {
        if self.adaptive.is_some() { self.time_step / 4.0 } else { self.time_step }
    }
}

/// How the length of a time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveSteps {
    /// Error that a step may make, as part of the largest deflection of the rail under the standing train.
    pub tolerance: f64,
    pub halvings: u32,
}

/// Trains that run between two exchanges.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// Axles that have passed before.
    pub before: u64,
    pub axles: u64,
    /// How many trains of each kind run in each direction.
    pub runs: Vec<(Runner, u64)>,
}

/// Trains that do the same to the track as it lies: one passage stands for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Runner {
    /// Index of the kind of train in the traffic, 0 leads it.
    pub kind: usize,
    /// Forward or backward.
    pub direction: Direction,
}

/// What a pass did and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    pub pass: String,
    pub what: String,
    pub why: String,
}

/// What the run will take: an estimate, from the counts of steps and unknowns. Blocks that are prescribed are counted, as if
/// none overshot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    pub unknowns: usize,
    pub blocks: u64,
    /// Axles of the shortest and of the longest block.
    pub block_axles: [u64; 2],
    pub passages: u64,
    pub steps: u64,
    /// On one core, s.
    pub seconds: f64,
    pub bytes: u64,
}

/// Distance that a wheel runs before it counts as passing a seat, m: about the half-width of a deflection bowl.
const APPROACH: f64 = 1.0;

impl Blocks {
    /// Chainages between which every wheel of the leading train comes and goes: seats there see the whole train.
    pub fn passed(&self) -> std::ops::Range<f64> {
        self.passage.passed(&self.train)
    }

    /// The direction of the passage of the leading train that shows a state of the track.
    pub fn leading_direction(&self) -> Direction {
        blocks::leading_direction(&self.train)
    }
}
