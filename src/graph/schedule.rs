//! When nodes run: one state of rest, blocks of axles, or the cycles of actuators.

use super::Train;
use crate::solvers::track::{Direction, Integrator, Sequence};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The order in which the nodes of a graph are advanced.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Schedule {
    /// One state of equilibrium under test loads.
    Static { loads: Vec<PointLoad> },
    /// Blocks of trains, each with one exchange of forces and settlement.
    Blocks(Box<Blocks>),
    /// Packings that are tested one after the other.
    Actuators(Tests),
    /// A schedule of another program: whoever runs the graph says how.
    Custom { kind: String, parameters: serde_json::Value },
}

impl Schedule {
    /// What a count of it is of.
    pub fn clock(&self) -> fn(u64) -> Clock {
        match self {
            Schedule::Actuators(_) => Clock::Cycles,
            Schedule::Static { .. } | Schedule::Blocks(_) | Schedule::Custom { .. } => Clock::Axles,
        }
    }
}

/// A constant force, N, positive down.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointLoad {
    pub on: LoadedPart,
    pub force: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadedPart {
    /// The rail at a chainage, m.
    Rail { x: f64 },
    /// The sleeper of a seat.
    Sleeper { seat: usize },
}

/// Tests under actuators.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tests {
    /// Packings, each with the seed after that of the one before.
    pub packings: u32,
    /// Cycles of which loops of force and depth and readings of sensors are kept, the first is 1.
    pub kept: Vec<u64>,
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
    /// Whether one passage stands for all equal trains of a block. Off, each train of a block is a block.
    pub share: bool,
    /// Axle counts at which the state of the track is recorded, ascending.
    pub recorded: Vec<u64>,
    pub tampings: Vec<Tamping>,
    /// Axle counts at which a block ends, ascending: those, the counts of tampings and those at which another kind of train
    /// begins.
    pub stops: Vec<u64>,
    /// Axles of the whole run.
    pub total: u64,
}

/// After how many axles forces and settlement are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Update {
    /// The same number of axles each time.
    Fixed { axles: u64 },
    /// `first` axles, then blocks of `ratio` times the axles so far, never smaller than `first`.
    Geometric { first: u64, ratio: f64 },
    /// Blocks as long as their estimated error of settlement allows: at most `tolerance` at any seat, m. `cap` bounds the
    /// settlement of a block as well, m.
    Adaptive { tolerance: f64, cap: Option<f64> },
}

impl Update {
    /// Axles of the block that begins after so many, where the policy knows without a look at forces.
    pub fn axles_after(&self, before: u64) -> Option<u64> {
        match *self {
            Update::Fixed { axles } => Some(axles),
            Update::Geometric { first, ratio } => Some(first.max((ratio * before as f64) as u64)),
            Update::Adaptive { .. } => None,
        }
    }
}

/// Sleepers that are lifted and packed anew at some counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tamping {
    pub name: String,
    /// Axles that have passed before it, each once.
    pub after: Vec<u64>,
    /// Indices of seats, ascending, all of them on ballast.
    pub seats: Vec<usize>,
    /// Share of the settlement that stays, 0 .. 1.
    pub left: f64,
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

/// How the length of a time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveSteps {
    /// Error that a step may make, as part of the largest deflection of the rail under the standing train.
    pub tolerance: f64,
    pub halvings: u32,
}

/// Distance that a wheel runs before it counts as passing a seat, m: about the half-width of a deflection bowl.
const APPROACH: f64 = 1.0;

impl PassagePlan {
    /// Chainages between which every wheel of a train comes and goes, m.
    pub fn passed(&self, train: &Train) -> std::ops::Range<f64> {
        let base = train.wheel_base();
        self.left + base + APPROACH..self.right - base - APPROACH
    }

    /// Chainage of the leading wheel of a train at the start and at the finish of its passage, m.
    pub fn way(&self, train: &Train, direction: Direction) -> (f64, f64) {
        let base = train.wheel_base();
        match direction {
            Direction::Backward => (self.right - base, self.left),
            Direction::Forward => (self.left + base, self.right),
        }
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
    pub direction: Direction,
}

impl Blocks {
    /// Chainages between which every wheel of the leading train comes and goes: seats there see the whole train.
    pub fn passed(&self) -> std::ops::Range<f64> {
        self.passage.passed(&self.train)
    }

    /// Chainages between which every wheel of a train comes and goes, for each kind of train.
    pub fn passed_by_kind(&self) -> Vec<std::ops::Range<f64>> {
        let kinds = (0..=self.others.len()).map(|kind| self.kind(kind));
        kinds.map(|(train, plan)| plan.passed(train)).collect()
    }

    /// The direction of the passage of the leading train that shows a state of the track.
    pub fn leading_direction(&self) -> Direction {
        self.train.leading_direction()
    }
}

/// How far a schedule is, in what it counts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clock {
    Axles(u64),
    Cycles(u64),
    /// s.
    Time(f64),
}

/// `500 axles`, `1 cycle`, `0.25 s`
impl fmt::Display for Clock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = |count: u64| if count == 1 { "" } else { "s" };
        match self {
            Clock::Axles(axles) => write!(f, "{axles} axle{}", plural(*axles)),
            Clock::Cycles(cycles) => write!(f, "{cycles} cycle{}", plural(*cycles)),
            Clock::Time(time) => write!(f, "{time} s"),
        }
    }
}
