//! Results of the track node: the track at rest, and the effects of a passage.

use crate::graph::{History, TrackNode};
use crate::solvers::settlement::Peak;
use serde::{Deserialize, Serialize};

/// The track without a train.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unloaded {
    /// Every rail node, left to right.
    pub rail: Vec<RailPoint>,
    pub seats: Vec<UnloadedSeat>,
    /// The rail as a measuring wheel finds it, left to right; empty if nobody records it.
    pub profile: Vec<RailPlace>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RailPoint {
    /// Chainage, m.
    pub x: f64,
    /// Below the level as built, m.
    pub deflection: f64,
    /// Sagging, N m.
    pub moment: f64,
}

/// A place on the rail where wheels run, four to a bay and one over each seat.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RailPlace {
    /// Chainage, m.
    pub x: f64,
    /// Unloaded, below the level as built, m.
    pub level: f64,
    /// Unloaded, sagging, N m.
    pub moment: f64,
    /// The train's mean wheel load at rest here, divided by the deflection that it adds, N/m.
    pub stiffness: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct UnloadedSeat {
    /// Permanent downward move of the support, m.
    pub settlement: f64,
    /// Sleeper below its level as built, m.
    pub sleeper_level: f64,
    /// Gap under the sleeper, m.
    pub void: f64,
    /// Sleeper on support, N.
    pub contact_force: f64,
    /// Rail on pad, N.
    pub seat_load: f64,
    /// Stiffness of the support as the ground answers, N/m; 0 without a sleeper.
    pub support_stiffness: f64,
}

/// Effects of one passage on the track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PassageOutcome {
    pub seats: Vec<SeatOutcome>,
    /// Largest force of each wheel of the train on the support of every seat.
    pub peaks: Vec<Vec<Peak>>,
    /// N.
    pub max_wheel_force: f64,
    pub min_wheel_force: f64,
    /// Largest ratio of a wheel's force to its static force, and the largest unloading of a wheel as a share of its
    /// static force; `None` without gravity.
    pub amplification: Option<f64>,
    pub unloading: Option<f64>,
    /// Largest sagging moment, N m, and downward displacement from the unloaded state, m, of the rail nodes that every
    /// wheel passes.
    pub max_rail_moment: f64,
    pub max_rail_displacement: f64,
    /// Smallest and largest sagging moment of every rail node, N m.
    pub rail_moments: Vec<(f64, f64)>,
    /// Smallest and largest downward displacement of every rail node from the unloaded state, m.
    pub rail_displacements: Vec<(f64, f64)>,
    pub time_steps: u64,
    pub newton_iterations: u64,
    /// Histories; empty if the passage is not recorded.
    pub samples: Vec<Sample>,
    /// The force of every sleeper on its support over the passage, if the substructure needs it.
    pub forces: Option<SeatForces>,
    /// Place and force of every wheel, if the substructure needs them.
    pub wheels: Option<WheelHistories>,
}

/// Wheels of a train over a passage, at equal intervals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WheelHistories {
    /// Time between two instants, s.
    pub interval: f64,
    /// Largest speed of the train, m/s.
    pub speed: f64,
    /// Number of wheels.
    pub wheels: usize,
    /// Chainage, m, and force on the rail, N, of each wheel, instant after instant.
    pub values: Vec<(f64, f64)>,
}

impl WheelHistories {
    /// How many instants there are.
    pub fn instants(&self) -> usize {
        self.values.len() / self.wheels.max(1)
    }

    /// All wheels at an instant.
    pub fn instant(&self, at: usize) -> &[(f64, f64)] {
        &self.values[at * self.wheels..(at + 1) * self.wheels]
    }
}

/// Forces of sleepers on their supports at equal intervals, R(t).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatForces {
    /// Time between two values, s.
    pub interval: f64,
    /// The values at each seat, N; empty for a seat without a sleeper.
    pub seats: Vec<Vec<f64>>,
}

/// Extremes of one seat over a passage.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SeatOutcome {
    /// N.
    pub max_rail_seat_load: f64,
    pub max_contact_force: f64,
    /// From the unloaded state, m.
    pub max_sleeper_displacement: f64,
    /// Time without contact of sleeper and support, s.
    pub contact_loss: f64,
}

/// One value of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// s.
    pub time: f64,
    pub quantity: History,
    pub part: SampledPart,
    /// Chainage, m.
    pub x: f64,
    /// SI.
    pub value: f64,
}

/// The part of the track or of the train whose history a sample is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SampledPart {
    /// Index of a seat.
    Seat(usize),
    /// 0 leads.
    Wheel(usize),
}

impl SampledPart {
    /// Its name in tables.
    pub fn name(self, track: &TrackNode) -> String {
        match self {
            SampledPart::Seat(seat) => track.seats[seat].name.clone(),
            SampledPart::Wheel(wheel) => format!("wheel {}", wheel + 1),
        }
    }
}
