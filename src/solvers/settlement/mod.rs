//! How far a support has settled after the wheels that it has carried: the laws, and what each remembers.
//!
//! A law sees, of every wheel, the [`Peak`] of what its support felt. How many wheels make one of its cycles is the law's
//! [`CyclePer`]: publications differ, and some do not say. A [`SupportState`] begins under one law and stays under it.

mod calibration;
pub mod fit;
mod guerin;
mod hardening;
mod hettler;
mod law;
mod nasrollahi;
mod power;
mod sato;
mod shenton;
mod support;
#[cfg(test)]
mod tests;
mod varandas;

pub use calibration::{Measured, Wanted, calibrate, curve};
pub use guerin::Guerin;
pub use hettler::{Hettler, Logarithm};
pub use law::{CyclePer, Form, Law, Peak};
pub use nasrollahi::Nasrollahi;
pub use power::Power;
pub use sato::Sato;
pub use shenton::Shenton;
pub use support::SupportState;
pub use varandas::Varandas;
