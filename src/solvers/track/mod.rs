//! One rail on its seats, and the vehicles that run over it: statics with lift-off, and passages in time.
//!
//! The rail is a beam after Euler–Bernoulli or Timoshenko, slabs and auxiliary rails are beams after Euler–Bernoulli, pads are
//! springs and dampers, a sleeper is a mass on a support that can only push, and a vehicle is a linear multibody system on
//! wheels that press on the rail by the law of Hertz, a spring or a given force. Displacements and forces are positive
//! downward, moments positive where the rail sags, x grows to the right.
//!
//! [`TrackModel`] says what there is; [`Track`] is its mesh and matrices; [`solve_static`] finds the state at rest;
//! [`Stepper`] factors one time step for all passages over that track; [`Passage`] runs one train over it and shows every
//! step to an [`Observer`].

mod adaptive;
mod assembly;
mod beam;
mod contact;
mod counters;
mod ends;
mod envelope;
mod error;
mod influence;
mod interface;
mod irregularity;
mod ladder;
mod leapfrog;
mod mesh;
mod model;
mod motion;
mod multibody;
mod numbering;
mod passage;
mod quasi_static;
mod reach;
mod run;
mod running;
mod scheme;
mod sequence;
mod statics;
mod support;
mod train;
mod vehicle;
mod view;

pub use counters::Counters;
pub use envelope::Envelope;
pub use error::{Explicit, Flaw, TrackError, TrackParameter, Unsettled, Wild};
pub use influence::Stepper;
pub use irregularity::{Cubic, Irregularity};
pub use ladder::Ladder;
pub use leapfrog::{EnergyAccount, FootMotion, Leapfrog, LeapfrogState, LeapfrogView, StepLimit, WheelLoads};
pub use mesh::Track;
pub use model::{
    AuxiliaryRail, Foot, Pitch, RailEnds, RailSection, Seat, Shear, Slab, TrackLevel, TrackModel, UnderPad,
};
pub use motion::Motion;
pub use multibody::{Multibody, Wheel, WheelContact};
pub use passage::{Passage, Run};
pub use scheme::{Integrator, Scheme};
pub use sequence::{Order, Sequence, Share};
pub use statics::{
    Balance, Loads, StaticState, forces_under_wheels, solve_static, standing_deflections, standing_stiffness,
};
pub use support::{Seating, Spring, SupportPhase};
pub use train::{Direction, Train};
pub use vehicle::Vehicle;
pub use view::{Observer, StepView};

#[cfg(test)]
mod tests;
