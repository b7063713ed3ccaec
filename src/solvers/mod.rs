//! Solvers: SI numbers in, SI numbers out.

pub mod settlement;
pub mod track;
