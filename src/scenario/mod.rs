//! The complete scene in SI units, made by `check` from the text and read by `lower`.
//!
//! Pure data. Every quantity is for **one rail**: a value for a whole sleeper, vehicle or slab has been halved.
//! Chainage x grows to the right, and x = 0 is the first transition. Downward displacement, settlement and force are
//! positive. Every number that may be written in the text has its [`Origin`].

mod bed;
mod far_field;
mod given;
mod grading;
mod law;
mod library;
mod material;
mod profile;
mod repeats;
pub mod response;
mod study;
mod track;
mod traffic;

pub use crate::graph::{Tamping, Update};
pub use crate::solvers::track::{Integrator, Order, Sequence, Share, Spring};
pub use bed::{Base, Bed, BedEnds, Grains, Tier, Volume, VolumeRecord};
pub use given::{Given, Origin};
pub use grading::{Grading, Passing};
pub use law::{SettlementLaw, law_argument, law_form};
pub use library::{Evidence, LibraryEntry};
pub use material::{Bond, Contact, Granular, Layer, Material, Packing, Shape, Soil, Strength, Surface, Surfaces};
pub use profile::{Cubic, Curve, Piece, Profile, Varying};
pub use repeats::Repeats;
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

/// A complete scene, ready for the planner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    pub title: String,
    pub track: Track,
    /// The loads on the track; `None` for a scene that can be drawn but not run.
    pub loading: Option<Loading>,
    pub tampings: Vec<Tamping>,
    pub solve: Solve,
    pub records: Vec<Record>,
    /// Records of volumes of grains.
    pub volumes: Vec<VolumeRecord>,
    pub expectations: Vec<response::Expectation>,
    /// Silenced physics rules, each with a reason.
    pub allow: Vec<(String, String)>,
    /// Physics rules that become errors.
    pub deny: Vec<String>,
    /// Physics rules that are off by default and that the scene switches on.
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

/// Settings of the computation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Solve {
    /// The settlement law of the supports.
    pub law: SettlementLaw,
    /// Further laws that are evaluated under the same forces.
    pub other_laws: Vec<SettlementLaw>,
    pub update: Update,
    /// Place of the value of `update_every`, for messages.
    pub update_span: Option<Span>,
    /// The method that computes the support of a sleeper from the layers.
    pub support_method: Method,
    pub integrator: Integrator,
    /// Beam theory of the rail.
    pub beam: Given<Beam>,
    /// Beam elements between two neighbouring rail seats.
    pub elements_per_bay: Given<u32>,
    pub time_step: TimeStep,
    /// Chainage of the leading wheel at the start and at the end of a passage, m; `None` if the planner chooses it.
    pub start: Option<Given>,
    pub finish: Option<Given>,
    /// m/s^2.
    pub gravity: Given,
    pub seed: u64,
    /// Settings for grains and soil.
    pub grains: Grains,
}

/// Beam theory of the rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Beam {
    /// Euler-Bernoulli: bending only.
    Euler,
    /// Timoshenko: bending, shear, and rotary inertia of the cross-section.
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
    /// Steps as long as the tolerance allows: the error of a step relative to the largest deflection.
    Adaptive { tolerance: Given },
}

impl TimeStep {
    /// Place in the text that sets it.
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

/// A requested history.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub quantities: Vec<response::Response>,
    /// Indices into [`Track::seats`].
    pub seats: Vec<usize>,
    /// Axle counts at which a passage is recorded.
    pub after: Vec<u64>,
    /// Sampling interval, s; `None` if the planner chooses it. The run uses the shortest interval of all records.
    pub every: Option<Given>,
    /// Kept only while a wheel is nearer to the seat than this, m; `None` keeps the whole passage.
    pub near: Option<f64>,
    /// Whether the complete state of rail and sleepers is kept at these counts.
    pub states: bool,
}
