//! Cases with known answers, by what they exercise.

mod dynamics;
mod reference;
mod scenes;
mod standing;
mod statics;
