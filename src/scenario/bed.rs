//! What only models of grains and soil read: the bed that they fill, how they are computed, and the volumes in which
//! their answers are wanted.

use super::{Given, Origin, response::Response};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// The box that holds the layers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bed {
    /// Half its width, from the centre line of the track to the side wall, m; `None` is that of the longest sleeper
    /// and its shoulder.
    pub half_width: Option<Given>,
    pub ends: BedEnds,
    pub base: Base,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BedEnds {
    Walls,
    Periodic,
}

/// What lies under the lowest layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Base {
    Rigid,
    /// Lets waves out.
    Quiet,
}

impl Default for Bed {
    fn default() -> Self {
        Bed { half_width: None, ends: BedEnds::Walls, base: Base::Rigid }
    }
}

/// The model under the sleepers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tier {
    /// The cheapest that answers.
    Auto,
    /// A settlement law under each sleeper.
    Law,
    /// Grains in a periodic cell under each sleeper that differs.
    Cells,
    /// Grains under the bays that differ.
    Zone,
    /// Grains under the whole softer side.
    Full,
}

impl Tier {
    /// Whether it computes with grains.
    pub fn has_grains(self) -> bool {
        matches!(self, Tier::Cells | Tier::Zone | Tier::Full)
    }
}

/// How grains and soil are computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grains {
    pub tier: Given<Tier>,
    /// Chainages between which grains are modelled, m, one span a transition; `None` is chosen by the planner.
    pub window: Option<Vec<[f64; 2]>>,
    /// Whether track and grains are solved together, step by step, instead of in turn.
    pub monolithic: bool,
    /// Whether trains of a block follow each other coupler to coupler, instead of one by one.
    pub continuous: Given<bool>,
    /// Whether grains give the stiffness of supports from the forces of a passage, instead of from a static load.
    pub support_from_passage: bool,
    /// Whether sleepers on grains turn about their axis across the track, instead of staying level.
    pub sleepers_pitch: bool,
    /// Bays of a periodic cell of grains: 1, 2 or 3.
    pub cell_bays: u32,
    /// Time step, s; `None` is chosen by the planner.
    pub step: Option<Given>,
    /// Size of the elements of soil, m; `None` is chosen by the planner.
    pub soil_element: Option<Given>,
    /// Error that the planner may make, as share of the largest settlement.
    pub tolerance: f64,
    /// Time that the run may take, s.
    pub budget: Option<Given>,
    /// Memory that it may take, bytes.
    pub memory: Option<Given>,
    /// Whether the bed of both rails is modelled, instead of that of one.
    pub both_rails: bool,
    /// Packings, each with its own seed.
    pub repeats: u32,
}

impl Default for Grains {
    fn default() -> Self {
        Grains {
            tier: Given { value: Tier::Auto, origin: Origin::Default },
            window: None,
            monolithic: false,
            continuous: Given { value: false, origin: Origin::Default },
            support_from_passage: false,
            sleepers_pitch: false,
            cell_bays: 1,
            step: None,
            soil_element: None,
            tolerance: 0.05,
            budget: None,
            memory: None,
            both_rails: false,
            repeats: 1,
        }
    }
}

/// Answers that a person wants from volumes of the layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeRecord {
    pub quantities: Vec<Response>,
    /// Indices into [`super::Track::seats`]: a volume under each.
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded.
    pub after: Vec<u64>,
    /// Sampling interval, s; `None` is chosen by the planner.
    pub every: Option<f64>,
    /// Below the sleeper's base, m; `None` is half the top layer.
    pub depth: Option<f64>,
    pub volume: Volume,
    /// Where it is asked for; `None` where the default holds.
    pub span: Option<Span>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Volume {
    /// m.
    Sphere { radius: f64 },
    /// m; across `None` is the whole bed.
    Box { along: f64, across: Option<f64>, height: f64 },
}
