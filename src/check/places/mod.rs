//! Places along the track: the chainages of sections and seats, the seats that a scene names, and the values of
//! profiles there.

pub mod along;
pub mod chainage;
pub mod chosen;
pub mod cover;
pub mod geometry;
mod random_field;
mod scatter;
pub mod spacing;
