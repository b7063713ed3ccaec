//! Places along the track: where sections and seats lie, which of them a scene names, and what profiles say there. Records in,
//! chainages out.

pub mod along;
pub mod chainage;
pub mod chosen;
pub mod cover;
pub mod geometry;
mod random_field;
mod scatter;
pub mod spacing;
