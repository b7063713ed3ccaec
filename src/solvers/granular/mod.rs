//! Grains: spheres and clumps in three dimensions by the discrete element method.
//!
//! A [`Bed`] holds bodies and walls. Each [`Bed::step`] computes every contact once, in lanes, and then sums the forces
//! on every body in a fixed order. The results are the same bits for any number of threads, any width of lanes and any
//! reach of the neighbour lists.
//!
//! ```
//! use trackbed::solvers::granular::*;
//!
//! let law = ContactLaw::Linear(Linear {
//!     normal_stiffness: 1.3e7,
//!     shear_stiffness: 1.3e7,
//!     friction: 0.7,
//!     dashpot: Dashpot::Ratio { normal: 0.3, shear: 0.3 },
//!     mode: DashpotMode::default(),
//!     limit: FrictionLimit::default(),
//! });
//! let mut bed: Bed = Bed::new(Domain::open(), ContactLaws::single(law));
//! let grain = bed.add_sphere(&Sphere { centre: [0.0, 0.0, 0.031], radius: 0.03, density: 2700.0, surface: 0 });
//! let floor = bed.add_plane([0.0; 3], [0.0, 0.0, 1.0], 0);
//! bed.set_gravity(Gravity::EARTH);
//! bed.set_time_step(2e-5);
//! bed.run(20_000)?;
//!
//! let weight = bed.body_state(grain).mass * 9.81;
//! assert!((bed.wall(floor).felt().force.z / -weight - 1.0).abs() < 1e-3);
//! # Ok::<(), Failure>(())
//! ```

mod bed;
mod body;
mod bonds;
mod build;
mod check;
mod checkpoint;
pub mod clump;
mod contacts;
mod cost;
mod critical;
mod domain;
mod energy;
mod entry;
mod failure;
mod fault;
mod force;
pub mod grains;
mod gravity;
mod incidence;
mod inspect;
mod integrate;
mod join;
mod lanes;
mod law;
mod listen;
mod lists;
pub mod measure;
pub mod motion;
mod order;
pub mod packing;
mod prefetch;
pub mod probe;
mod reach;
mod record;
mod remove;
mod replicate;
mod rest;
pub mod rig;
pub mod rotation;
mod scaling;
mod search;
pub mod shape;
mod sheet;
mod snapshot;
mod step;
mod stride;
mod tasks;
mod timings;
mod union;
mod vector;
mod walls;
mod watch;

pub use bed::{Bed, BodyState, PebbleState, Placed, Sphere};
pub use body::BodyId;
pub use bonds::Glue;
pub use checkpoint::{Checkpoint, RestoreError};
pub use critical::{CriticalStep, Limit, LimitSeat};
pub use domain::Domain;
pub use energy::Energy;
pub use failure::{Culprit, Failure, Limits};
pub use fault::{Fault, Subject};
pub use gravity::Gravity;
pub use inspect::{Finding, Other};
pub use lanes::Real;
pub use law::{
    ContactLaw, ContactLaws, Dashpot, DashpotMode, FrictionLimit, HertzMindlin, LawError, Linear, Surface, in_series,
};
pub use listen::Answer;
pub use motion::{Felt, Pose, Push, WallMotion};
pub use rest::Fading;
pub use scaling::Scaling;
pub use shape::Shape;
pub use sheet::{Corner, Sheet};
pub use snapshot::{ContactState, Party, Snapshot};
pub use step::Guided;
pub use stride::{Sharing, Stride};
pub use timings::Timings;
pub use walls::{Wall, WallId};
