//! Solvers. All inputs and results are numbers in SI units.

pub mod continuum;
pub mod foundation;
pub mod granular;
pub mod settlement;
pub mod track;
