//! Stand-in.
pub mod settlement;
pub mod track;
