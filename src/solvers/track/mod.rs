//! One rail on its seats, and the vehicles that run over it: statics with lift-off, and passages in time.
//!
//! The rail and the slabs are Euler–Bernoulli beams of cubic Hermite elements, pads are springs and dampers, a sleeper is a
//! mass on a support that can only push, and a vehicle is ten rigid-body unknowns on Hertz contacts. Displacements and forces
//! are positive downward, moments positive where the rail sags, x grows to the right.
//!
//! [`TrackModel`] says what there is; [`Track`] is its mesh and matrices; [`solve_static`] finds the state at rest;
//! [`Stepper`] factors one time step for all passages over that track; [`Passage`] runs one train over it and shows every
//! step to an [`Observer`].

mod beam;
mod contact;
mod error;
mod mesh;
mod model;
mod scheme;
mod statics;
mod vehicle;

pub use contact::SupportPhase;
pub use error::TrackError;
pub use mesh::Track;
pub use model::{Foot, RailEnds, RailSection, Seat, Slab, TrackLevel, TrackModel};
pub use scheme::Scheme;
pub use statics::{Balance, Loads, StaticState, solve_static};
pub use vehicle::{Direction, Train, Vehicle};
