//! The scene in SI units, complete: what `check` makes of the text and what `lower` reads.
//!
//! Pure data. Every quantity is of **one rail**: a whole sleeper, vehicle or slab has been halved where the text says
//! that its value is of a whole. Chainage x grows to the right, x = 0 is the first transition; downward displacement,
//! settlement and force are positive; every number a person may have written carries its [`Origin`].

mod given;
pub mod response;
mod track;
mod traffic;

pub use given::{Given, Origin};
pub use track::{Foot, Pad, Rail, RailEnds, Seat, Section, Side, Slab, Support, Track, Transition};
pub use traffic::{Direction, LawForm, SettlementLaw, StaticLoad, Target, Traffic, Train, Vehicle};

use crate::diag::Span;
use serde::{Deserialize, Serialize};

/// A whole scene, ready to be lowered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    pub title: String,
    pub track: Track,
    /// What acts on the track; `None` is a scene that can be drawn but not run.
    pub loading: Option<Loading>,
    pub solve: Solve,
    pub records: Vec<Record>,
    pub expectations: Vec<response::Expectation>,
    /// Physics rules silenced with a reason.
    pub allow: Vec<(String, String)>,
    /// Physics rules made errors.
    pub deny: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Loading {
    Traffic(Traffic),
    Static(Vec<StaticLoad>),
}

/// How the answer is computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    pub law: SettlementLaw,
    pub update: Update,
    /// The word after `update_every`, for messages.
    pub update_span: Option<Span>,
    pub integrator: Integrator,
    /// Beam elements between two neighbouring rail seats.
    pub elements_per_bay: Given<u32>,
    /// s; `None` is chosen by the planner.
    pub time_step: Option<Given>,
    /// Chainage of the leading wheel at the start and at the end of a passage, m; `None` is chosen by the planner.
    pub start: Option<Given>,
    pub finish: Option<Given>,
    /// m/s^2.
    pub gravity: Given,
    pub seed: u64,
}

/// After how many axles forces and settlement are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Update {
    /// The same number of axles each time.
    Fixed { axles: u64 },
    /// `first` axles, then blocks of `ratio` times the axles so far, never smaller than `first`.
    Geometric { first: u64, ratio: f64 },
    /// Blocks as long as their estimated error of settlement allows: at most `tolerance` at any seat, m. `cap` bounds the
    /// settlement of a block as well, m.
    Adaptive { tolerance: f64, cap: Option<f64> },
}

/// Time integration of the track and vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Integrator {
    /// Spectral radius at infinite frequency, 0 .. 1.
    GeneralisedAlpha { rho: f64 },
}

/// A history that a person asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub quantities: Vec<response::Response>,
    /// Indices into [`Track::seats`].
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded.
    pub after: Vec<u64>,
    /// Sampling interval, s; `None` is chosen by the planner.
    pub every: Option<f64>,
}
