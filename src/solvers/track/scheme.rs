//! Time integration by one family of second-order methods: generalised-α, whose damping of high frequencies is set by
//! one number, with HHT-α and Newmark as special cases.
//!
//! ```text
//! M a_{n+1-αm} + C v_{n+1-αf} + K u_{n+1-αf} = f_{n+1-αf},    x_{n+1-α} = (1-α) x_{n+1} + α x_n
//! u_{n+1} = u* + β Δt² a_{n+1},   u* = u_n + Δt v_n + (½-β) Δt² a_n
//! v_{n+1} = v* + γ Δt a_{n+1},    v* = v_n + (1-γ) Δt a_n
//! γ = ½ - αm + αf,   β = ¼ (1 - αm + αf)²
//!
//! generalised-α:  αm = (2ρ-1)/(ρ+1),  αf = ρ/(ρ+1)     Chung and Hulbert (1993), doi 10.1115/1.2900803
//! HHT-α:          αm = 0,             αf = α            Hilber, Hughes and Taylor (1977), doi 10.1002/eqe.4290050306
//! Newmark:        αm = 0,             αf = 0            the average acceleration, without damping of its own
//! ```
//!
//! Nonlinear forces take the same mean of both ends of the step as the linear forces.

use super::error::{TrackError, TrackParameter};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A method of time integration, without its step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Integrator {
    /// Spectral radius at infinite frequency, 0 .. 1.
    GeneralisedAlpha { rho: f64 },
    /// Hilber, Hughes and Taylor: alpha from 0 to 1/3; a larger alpha damps high frequencies more.
    Hht { alpha: f64 },
    /// Average acceleration (beta 1/4, gamma 1/2): no damping.
    Newmark,
}

impl Integrator {
    /// The method in steps of `time_step` (s).
    pub fn scheme(self, time_step: f64) -> Result<Scheme, TrackError> {
        match self {
            Integrator::GeneralisedAlpha { rho } => Scheme::generalised_alpha(time_step, rho),
            Integrator::Hht { alpha } => Scheme::hht(time_step, alpha),
            Integrator::Newmark => Scheme::newmark(time_step),
        }
    }
}

/// The method as it is written in a scene.
impl fmt::Display for Integrator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Integrator::GeneralisedAlpha { rho } => write!(f, "generalised_alpha({rho})"),
            Integrator::Hht { alpha } => write!(f, "hht({alpha})"),
            Integrator::Newmark => f.write_str("newmark"),
        }
    }
}

/// Coefficients of one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// s.
    pub time_step: f64,
    pub(super) alpha_m: f64,
    pub(super) alpha_f: f64,
    pub(super) beta: f64,
    pub(super) gamma: f64,
}

impl Scheme {
    /// Generalised-α in steps of `time_step` (s). `spectral_radius` (0 to 1) is the share of a motion much faster than
    /// the step that is left after one step: a smaller value damps more.
    pub fn generalised_alpha(time_step: f64, spectral_radius: f64) -> Result<Self, TrackError> {
        let rho = within("spectral radius", spectral_radius, 1.0, "from 0 to 1")?;
        Self::with_means(time_step, (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// HHT-α in steps of `time_step` (s); `alpha` from 0 (Newmark) to 1/3 (damps most).
    pub fn hht(time_step: f64, alpha: f64) -> Result<Self, TrackError> {
        Self::with_means(time_step, 0.0, within("alpha of HHT", alpha, 1.0 / 3.0, "from 0 to 1/3")?)
    }

    /// Newmark's average acceleration in steps of `time_step` (s).
    pub fn newmark(time_step: f64) -> Result<Self, TrackError> {
        Self::with_means(time_step, 0.0, 0.0)
    }

    fn with_means(time_step: f64, alpha_m: f64, alpha_f: f64) -> Result<Self, TrackError> {
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(TrackError::Parameter {
                name: TrackParameter::TimeStep,
                value: time_step,
                expected: "above 0",
            });
        }
        let excess = 1.0 - alpha_m + alpha_f;
        Ok(Self { time_step, alpha_m, alpha_f, beta: 0.25 * excess * excess, gamma: excess - 0.5 })
    }

    /// The same method in steps of another length, s.
    pub fn with_time_step(self, time_step: f64) -> Result<Self, TrackError> {
        Self::with_means(time_step, self.alpha_m, self.alpha_f)
    }

    /// β Δt²: displacement per acceleration at the end of the step, s^2.
    #[inline]
    pub(super) fn displacement_share(&self) -> f64 {
        self.beta * self.time_step * self.time_step
    }

    /// γ Δt: velocity per acceleration, s.
    #[inline]
    pub(super) fn velocity_share(&self) -> f64 {
        self.gamma * self.time_step
    }

    /// γ/(β Δt): velocity per displacement, 1/s.
    #[inline]
    pub(super) fn rate(&self) -> f64 {
        self.gamma / (self.beta * self.time_step)
    }

    /// The matrix coefficients (of M, C, K) of the equation for a_{n+1}.
    pub(super) fn effective(&self) -> (f64, f64, f64) {
        let new = 1.0 - self.alpha_f;
        (1.0 - self.alpha_m, new * self.velocity_share(), new * self.displacement_share())
    }
}

fn within(name: &'static str, value: f64, most: f64, expected: &'static str) -> Result<f64, TrackError> {
    if (0.0..=most).contains(&value) {
        Ok(value)
    } else {
        Err(TrackError::Parameter { name: TrackParameter::Damping(name), value, expected })
    }
}
