//! The scene in SI units, complete: what `check` makes of the text and what `lower` reads.
//!
//! Pure data. Every quantity is of **one rail**: a whole sleeper, vehicle or slab has been halved where the text says
//! that its value is of a whole. Chainage x grows to the right, x = 0 is the first transition; downward displacement,
//! settlement and force are positive; every number a person may have written carries its [`Origin`].

mod bed;
mod far_field;
mod given;
mod grading;
mod law;
mod library;
mod material;
mod profile;
pub mod response;
mod study;
mod track;
mod traffic;

pub use crate::graph::{Tamping, Update};
pub use crate::solvers::track::{Integrator, Order, Sequence, Share, Spring};
pub use bed::{Base, Bed, BedEnds, Grains, Tier, Volume, VolumeRecord};
pub use given::{Given, Origin};
pub use grading::{Grading, Passing};
pub use law::{SettlementLaw, law_argument};
pub use library::{Evidence, LibraryEntry};
pub use material::{Bond, Contact, Granular, Layer, Material, Packing, Shape, Soil, Strength, Surface, Surfaces};
pub use profile::{Cubic, Curve, Piece, Profile, Varying};
pub use study::{Axis, Choice, Goal, Measured, Objective, Sampling, Setting, Spread, Study, Values, Written};
pub use track::{
    ApproachSlab, AuxiliaryRailSpan, AuxiliaryRails, Crib, Foot, Groundwork, Pad, Rail, RailEnds, Seat, Seating,
    Section, Side, Slab, SleeperBody, Stack, Stretch, Support, Track, Transition, Usp, point_stiffness, seat_stiffness,
};
pub use traffic::{Direction, Force, RigLoad, StaticLoad, Target, Traffic, Train, Vehicle, Wave};

use crate::diag::Span;
use crate::solvers::foundation::Method;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A whole scene, ready to be lowered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    pub title: String,
    pub track: Track,
    /// What acts on the track; `None` is a scene that can be drawn but not run.
    pub loading: Option<Loading>,
    pub tampings: Vec<Tamping>,
    pub solve: Solve,
    pub records: Vec<Record>,
    /// What is wanted from volumes of grains.
    pub volumes: Vec<VolumeRecord>,
    pub expectations: Vec<response::Expectation>,
    /// Physics rules silenced with a reason.
    pub allow: Vec<(String, String)>,
    /// Physics rules made errors.
    pub deny: Vec<String>,
    /// Physics rules that speak only because the scene asks for them.
    pub warn: Vec<String>,
    /// Entries of the standard library that the scene uses.
    pub library: Vec<LibraryEntry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Loading {
    Traffic(Traffic),
    Static(Vec<StaticLoad>),
    Rig(Vec<RigLoad>),
}

/// How the answer is computed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    /// By which the supports settle.
    pub law: SettlementLaw,
    /// Laws that are shown beside it, under the same forces.
    pub other_laws: Vec<SettlementLaw>,
    pub update: Update,
    /// The word after `update_every`, for messages.
    pub update_span: Option<Span>,
    /// By which layers become the support of a sleeper.
    pub support_method: Method,
    pub integrator: Integrator,
    /// Beam theory of the rail.
    pub beam: Given<Beam>,
    /// Beam elements between two neighbouring rail seats.
    pub elements_per_bay: Given<u32>,
    pub time_step: TimeStep,
    /// Chainage of the leading wheel at the start and at the end of a passage, m; `None` is chosen by the planner.
    pub start: Option<Given>,
    pub finish: Option<Given>,
    /// m/s^2.
    pub gravity: Given,
    pub seed: u64,
    /// What models of grains and soil read.
    pub grains: Grains,
}

/// Beam theory of the rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Beam {
    /// Euler and Bernoulli: bends.
    Euler,
    /// Timoshenko: bends and shears, and its cross-section has a rotary inertia.
    Timoshenko,
}

impl fmt::Display for Beam {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Beam::Euler => "euler",
            Beam::Timoshenko => "timoshenko",
        })
    }
}

/// The time step of track and vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum TimeStep {
    /// Chosen by the planner.
    Auto,
    /// s.
    Fixed(Given),
    /// Steps as small as the wanted error of a step, relative to the answer, asks for.
    Adaptive { tolerance: Given },
}

impl TimeStep {
    /// Where the scene says something about it.
    pub fn span(self) -> Option<Span> {
        match self {
            TimeStep::Auto => None,
            TimeStep::Fixed(step) => step.origin.span(),
            TimeStep::Adaptive { tolerance } => tolerance.origin.span(),
        }
    }

    /// The step that the scene states, s.
    pub fn fixed(self) -> Option<Given> {
        if let TimeStep::Fixed(step) = self { Some(step) } else { None }
    }
}

/// A history that a person asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub quantities: Vec<response::Response>,
    /// Indices into [`Track::seats`].
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded.
    pub after: Vec<u64>,
    /// Sampling interval, s; `None` is chosen by the planner. The shortest of all records is that of the run.
    pub every: Option<Given>,
    /// Kept only while a wheel is nearer to the seat than this, m; `None` keeps the whole passage.
    pub near: Option<f64>,
    /// Whether the state of rail and sleepers is kept whole at those counts.
    pub states: bool,
}
