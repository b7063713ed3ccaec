//! Data only for models of grains and soil: the bed, the settings of the computation, and the recorded volumes.

use super::{Given, Origin, Repeats, response::Response};
use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// The box of the layers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bed {
    /// Half its width, from the centre line of the track to the side wall, m; `None` for half the longest sleeper plus
    /// its shoulder.
    pub half_width: Option<Given>,
    pub ends: BedEnds,
    pub base: Base,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum BedEnds {
    Walls,
    Periodic,
}

/// The boundary below the lowest layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Base {
    Rigid,
    /// Waves leave the model.
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
    /// The cheapest tier that can run the scene.
    Auto,
    /// A settlement law under each sleeper.
    Law,
    /// Grains in a periodic cell for each distinct sleeper.
    Cells,
    /// Grains under the bays that differ from the far field.
    Zone,
    /// Grains under the whole softer side.
    Full,
}

impl Tier {
    /// The word of the tier in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Tier::Auto => "auto",
            Tier::Law => "law",
            Tier::Cells => "cells",
            Tier::Zone => "zone",
            Tier::Full => "full",
        }
    }

    /// Whether the tier uses grains.
    pub fn has_grains(self) -> bool {
        matches!(self, Tier::Cells | Tier::Zone | Tier::Full)
    }
}

/// Settings for grains and soil.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grains {
    pub tier: Given<Tier>,
    /// Chainages between which grains are modelled, m, one span for each transition; `None` if the planner chooses
    /// them.
    pub window: Option<Vec<[f64; 2]>>,
    /// Whether track and grains are solved together in each time step, instead of in turn.
    pub monolithic: bool,
    /// Whether trains of a block follow each other coupler to coupler, instead of one by one.
    pub continuous: Given<bool>,
    /// Whether the support stiffness of the grains comes from the forces of a passage instead of a static load.
    pub support_from_passage: bool,
    /// Whether sleepers on grains rotate about their axis across the track.
    pub sleepers_pitch: bool,
    /// Number of bays in a periodic cell of grains: 1, 2 or 3.
    pub cell_bays: u32,
    /// Number of sleepers of each kind that cells of grains check while a law runs.
    pub check_cells: Given<u32>,
    /// Time step, s; `None` if the planner chooses it.
    pub step: Option<Given>,
    /// Size of the soil elements, m; `None` if the planner chooses it.
    pub soil_element: Option<Given>,
    /// Error that the planner may make / largest settlement.
    pub tolerance: Given,
    /// Longest time that the run may take, s.
    pub budget: Option<Given>,
    /// Largest memory that the run may take, bytes.
    pub memory: Option<Given>,
    /// Whether the bed of both rails is modelled instead of the bed of one rail.
    pub both_rails: bool,
    /// Packings, each with its own seed.
    pub repeats: Repeats,
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
            cell_bays: 2,
            check_cells: Given { value: 0, origin: Origin::Default },
            step: None,
            soil_element: None,
            tolerance: Given { value: 0.05, origin: Origin::Default },
            budget: None,
            memory: None,
            both_rails: false,
            repeats: Repeats::ONCE,
        }
    }
}

/// Responses to record in volumes of the layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeRecord {
    pub quantities: Vec<Response>,
    /// Indices into [`super::Track::seats`], with a volume under each seat.
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded.
    pub after: Vec<u64>,
    /// Sampling interval, s; `None` if the planner chooses it.
    pub every: Option<f64>,
    /// Depth below the base of the sleeper, m; `None` for half the top layer.
    pub depth: Option<f64>,
    pub volume: Volume,
    /// Place in the text; `None` for the default.
    pub span: Option<Span>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Volume {
    /// Radius, m.
    Sphere { radius: f64 },
    /// Sizes, m; `across` is `None` for the whole width of the bed.
    Box { along: f64, across: Option<f64>, height: f64 },
}
