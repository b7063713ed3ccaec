//! Solvers: SI numbers in, SI numbers out.

pub mod continuum;
pub mod foundation;
pub mod granular;
pub mod settlement;
pub mod track;
