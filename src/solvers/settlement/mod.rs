//! Settlement of a support after the wheels that it has carried: the laws, and the state of each.
//!
//! A law uses, for every wheel, the [`Peak`] at its support. The number of wheels in one cycle is the [`CyclePer`] of
//! the law: publications differ, and some do not specify it. A [`SupportState`] has one law and keeps it.

mod calibration;
pub mod fit;
mod guerin;
mod hardening;
mod hettler;
mod law;
mod nasrollahi;
mod peak;
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
pub use law::{CyclePer, Form, Law};
pub use nasrollahi::Nasrollahi;
pub use peak::Peak;
pub use power::Power;
pub use sato::Sato;
pub use shenton::Shenton;
pub use support::SupportState;
pub use varandas::Varandas;
