//! Cases with known answers, by what they exercise.

mod dynamics;
mod oracle;
mod reference;
mod runge_kutta;
mod scenes;
mod statics;
