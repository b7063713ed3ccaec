//! Test cases with known results, by subject.

mod adaptive;
mod beams;
mod dynamics;
mod ends;
mod harsh;
mod leapfrog;
mod momentum;
mod oracle;
mod reference;
mod runge_kutta;
mod scenes;
mod standing;
mod statics;
mod uneven;
mod vehicles;
