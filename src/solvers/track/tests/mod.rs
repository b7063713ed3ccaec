//! Cases with known answers, by what they exercise.

mod beams;
mod dynamics;
mod ends;
mod harsh;
mod reference;
mod scenes;
mod statics;
mod uneven;
mod vehicles;
