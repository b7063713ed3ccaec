//! The resonance of a wheel on the track: rule L1012, which [`super::passing_frequency`] reports together with the
//! resonances of bogies.
//!
//! Wheel and track move in phase on the track's stiffness, `f = sqrt(K / (m_w + 3 m / (2 lambda))) / 2 pi`. K is the
//! stiffness of a beam on springs at rail level. `3 m / (2 lambda)` is the mass of the deflection bowl
//! `exp(-lambda x) (cos lambda x + sin lambda x)` that moves with the wheel, with rail and sleepers of m per metre.

use super::winkler::Winkler;
use crate::scenario::Vehicle;

/// Natural frequency of a wheel and the track in phase, Hz.
pub(super) fn resonance(track: &Winkler, vehicle: &Vehicle) -> f64 {
    let mass = *vehicle.wheel_mass + 1.5 * track.mass / track.lambda();
    (track.rail_stiffness() / mass).sqrt() / (2.0 * std::f64::consts::PI)
}
