//! Cases with known answers, by what they exercise.

mod adaptive;
mod beams;
mod dynamics;
mod ends;
mod reference;
mod scenes;
mod standing;
mod statics;
mod uneven;
mod vehicles;
