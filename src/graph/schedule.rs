//! Schedules: one state of rest, blocks of axles, or the cycles of actuators.

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
    /// A schedule of another program, which also runs it.
    Custom { kind: String, parameters: serde_json::Value },
}

impl Schedule {
    /// The unit of the counts of the schedule.
    pub fn clock(&self) -> fn(u64) -> Clock {
        match self {
            Schedule::Actuators(_) => Clock::Cycles,
            Schedule::Static { .. } | Schedule::Blocks(_) | Schedule::Custom { .. } => Clock::Axles,
        }
    }
}

/// A constant force, N, positive downwards.
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
    /// The seed of the first packing minus the seed of the bed.
    #[serde(default)]
    pub first: u32,
    /// Number of packings at most; their seeds are consecutive.
    pub packings: u32,
    /// Number of packings at least: a listener ends an open range where it has enough.
    #[serde(default)]
    pub least: u32,
    /// Cycles whose loops of force and depth and sensor readings are kept; the first cycle is 1.
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
    /// The order of the trains.
    pub sequence: Sequence,
    /// The policy for the length of the blocks.
    pub update: Update,
    /// Whether a fixed or geometric block that overshoots is repeated in halves. If not, the settlement can oscillate.
    pub cure: bool,
    /// Whether one passage is used for all equal trains of a block. If not, each train is a block.
    pub share: bool,
    /// Axle counts at which the state of the track is recorded, ascending.
    pub recorded: Vec<u64>,
    pub tampings: Vec<Tamping>,
    /// Axle counts at which a block ends, ascending: the recorded counts, the counts of tampings, and the counts at
    /// which another kind of train begins.
    pub stops: Vec<u64>,
    /// Axles of the whole run.
    pub total: u64,
    /// Comparison with a finer passage on the way; `None` if the scene states elements and steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<Compared>,
}

/// Comparison of a passage with one that has twice the elements and shorter steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// It is due at the first exchange after so many axles.
    pub after: u64,
    /// Difference of the settlement by one train / its largest settlement, above which the finer passages are taken.
    pub limit: f64,
}

/// Number of axles between two exchanges of forces and settlement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Update {
    /// The same number of axles each time.
    Fixed { axles: u64 },
    /// `first` axles, then blocks of `ratio` times the axles so far, never smaller than `first`.
    Geometric { first: u64, ratio: f64 },
    /// Blocks as long as the estimated error of settlement allows: at most `tolerance` at any seat, m. `cap` also
    /// limits the settlement of a block, m.
    Adaptive { tolerance: f64, cap: Option<f64> },
}

impl Update {
    /// Axles of the block that begins after `before` axles, if the policy does not depend on forces.
    pub fn axles_after(&self, before: u64) -> Option<u64> {
        match *self {
            Update::Fixed { axles } => Some(axles),
            Update::Geometric { first, ratio } => Some(first.max((ratio * before as f64) as u64)),
            Update::Adaptive { .. } => None,
        }
    }
}

/// Sleepers that are lifted and packed again at some counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tamping {
    pub name: String,
    /// Axle counts after which the sleepers are tamped, each once.
    pub after: Vec<u64>,
    /// Indices of seats, ascending, all of them on ballast.
    pub seats: Vec<usize>,
    /// Share of the settlement that remains, 0 .. 1.
    pub left: f64,
}

/// Parameters of the time integration of a passage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PassagePlan {
    /// Chainage of the leftmost wheel while the train stands at the left, m, and of the rightmost wheel while the train
    /// stands at the right.
    pub left: f64,
    pub right: f64,
    /// Time step, s; the longest step if steps are adaptive.
    pub time_step: f64,
    /// Adaptive steps: halved down to `time_step / 2^halvings` if their error is too large.
    pub adaptive: Option<AdaptiveSteps>,
    pub integrator: Integrator,
    /// Interval of histories in time steps; in longest steps if steps are adaptive.
    pub sample_every: u64,
}

/// Parameters of adaptive time steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveSteps {
    /// Largest error of a step / largest deflection of the rail under the standing train.
    pub tolerance: f64,
    pub halvings: u32,
}

/// Tolerance of steps half as long / tolerance of the steps: see [`PassagePlan::usual_step`].
const FINER: f64 = 0.17;

/// Distance that a wheel must run before and behind a seat to count as passing it, m: about half the width of a
/// deflection bowl.
const APPROACH: f64 = 1.0;

impl PassagePlan {
    /// Chainages between which every wheel of a train passes every seat, m.
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

    /// The same with steps about half as long.
    #[must_use]
    pub fn finer(self) -> PassagePlan {
        match self.adaptive {
            Some(AdaptiveSteps { tolerance, halvings }) => {
                let adaptive = AdaptiveSteps { tolerance: FINER * tolerance, halvings: halvings + 1 };
                PassagePlan { adaptive: Some(adaptive), ..self }
            }
            None => PassagePlan { time_step: 0.5 * self.time_step, sample_every: 2 * self.sample_every, ..self },
        }
    }

    /// The shortest step that a passage may take, s.
    pub fn shortest_step(&self) -> f64 {
        self.time_step * self.adaptive.map_or(1.0, |steps| 0.5f64.powi(steps.halvings as i32))
    }

    /// Average step for estimates, s. Adaptive steps of the shipped passages have 0.36 ms on average with a tolerance
    /// of 1e-4, 0.16 ms with 1e-5 and 0.06 ms with 1e-6.
    pub fn usual_step(&self) -> f64 {
        let usual = |steps: AdaptiveSteps| 3.7e-4 * (steps.tolerance / 1e-4).powf(0.4);
        self.adaptive.map_or(self.time_step, |steps| usual(steps).clamp(self.shortest_step(), self.time_step))
    }
}

/// Trains that run between two exchanges.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// Axles that have passed before.
    pub before: u64,
    pub axles: u64,
    /// Number of trains of each kind in each direction.
    pub runs: Vec<(Runner, u64)>,
}

/// Trains with the same effect on the track at a given state: one passage is used for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Runner {
    /// Index of the kind of train in the traffic; 0 is the leading kind.
    pub kind: usize,
    pub direction: Direction,
}

impl Blocks {
    /// The same with finer passages.
    #[must_use]
    pub fn finer(&self) -> Blocks {
        let others = self.others.iter().map(|(train, plan)| (train.clone(), plan.finer())).collect();
        Blocks { passage: self.passage.finer(), others, ..self.clone() }
    }

    /// Chainages between which every wheel of the leading train passes every seat.
    pub fn passed(&self) -> std::ops::Range<f64> {
        self.passage.passed(&self.train)
    }

    /// Chainages between which every wheel of a train passes every seat, for each kind of train.
    pub fn passed_by_kind(&self) -> Vec<std::ops::Range<f64>> {
        let kinds = (0..=self.others.len()).map(|kind| self.kind(kind));
        kinds.map(|(train, plan)| plan.passed(train)).collect()
    }

    /// The direction of the passage of the leading train that is recorded for a state of the track.
    pub fn leading_direction(&self) -> Direction {
        self.train.leading_direction()
    }
}

/// Progress of a schedule, in its own unit.
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
