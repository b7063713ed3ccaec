//! Cases with known answers, by what they exercise.

mod dynamics;
mod reference;
mod scenes;
mod statics;
mod uneven;
mod vehicles;
