//! One rail on its seats, and the vehicles that run over it: statics with lift-off, and passages in the time domain.
//!
//! The rail is an Euler–Bernoulli or Timoshenko beam; slabs and auxiliary rails are Euler–Bernoulli beams; pads are
//! springs and dampers. A sleeper is a mass on a support that can only push. A vehicle is a linear multibody system on
//! wheels that press on the rail by Hertz's law, a spring or a given force. Displacements and forces are positive
//! downward, moments are positive if the rail sags, x increases to the right.
//!
//! [`TrackModel`] describes the track; [`Track`] is its mesh and matrices; [`solve_static`] finds the state at rest;
//! [`Stepper`] factors one time step for all passages over that track; [`Passage`] runs one train over the track and
//! passes every step to an [`Observer`].

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
