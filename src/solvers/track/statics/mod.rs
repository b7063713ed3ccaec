//! The track at rest: gravity, point loads and standing vehicles, on supports that may have lost contact.

mod loads;
mod solve;
mod standing;
mod state;
mod stiffness;
mod wandering;

pub use loads::Loads;
pub use solve::solve_static;
pub use state::{Balance, StaticState};
pub use wandering::{forces_under_wheels, standing_deflections, standing_stiffness};

pub(super) use loads::Inertia;
pub(super) use solve::solve_with_inertia;
