//! Grains: spheres and clumps in three dimensions by the discrete element method.
//!
//! A [`Bed`] holds bodies and walls. Each [`Bed::step`] computes every contact once, in lanes, and then sums for every
//! body the forces on it, in a fixed order: the same bits for any number of threads, any width of lanes and any reach of
//! the neighbour lists.

mod bed;
mod body;
mod build;
pub mod clump;
mod contacts;
mod critical;
mod domain;
mod energy;
mod force;
mod gravity;
mod inspect;
mod integrate;
mod lanes;
mod law;
pub mod measure;
pub mod motion;
mod record;
pub mod rotation;
mod scaling;
mod search;
pub mod shape;
mod snapshot;
mod step;
mod union;
mod vector;
mod walls;
mod watch;

pub use bed::{Bed, BodyState, PebbleState, Placed, Sphere};
pub use body::BodyId;
pub use critical::{CriticalStep, Limit, Seat};
pub use domain::Domain;
pub use energy::Energy;
pub use gravity::Gravity;
pub use inspect::{Finding, Other};
pub use lanes::Real;
pub use law::{Dashpot, DashpotMode, FrictionLimit, HertzMindlin, Law, LawError, Laws, Linear, Surface, in_series};
pub use motion::{Felt, Motion, Pose};
pub use scaling::{HeldEnergy, Scaling};
pub use snapshot::{ContactState, Party, Snapshot};
pub use step::Timings;
pub use walls::{Wall, WallId};
pub use watch::{Culprit, Failure, Limits};
