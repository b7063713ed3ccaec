//! The generalised-α method of Chung and Hulbert (1993), doi 10.1115/1.2900803: second order, with damping of high frequencies
//! set by one number.
//!
//! ```text
//! M a_{n+1-αm} + C v_{n+1-αf} + K u_{n+1-αf} = f_{n+1-αf},    x_{n+1-α} = (1-α) x_{n+1} + α x_n
//! u_{n+1} = u* + β Δt² a_{n+1},   u* = u_n + Δt v_n + (½-β) Δt² a_n
//! v_{n+1} = v* + γ Δt a_{n+1},    v* = v_n + (1-γ) Δt a_n
//! αm = (2ρ-1)/(ρ+1),   αf = ρ/(ρ+1),   γ = ½ - αm + αf,   β = ¼ (1 - αm + αf)²
//! ```
//!
//! Forces that are not linear take the same mean of both ends of the step as the linear ones.

use super::TrackError;

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
    /// A step of `time_step` (s); `spectral_radius` (0 to 1) is what is left after one step of a motion much faster than it:
    /// smaller damps more.
    pub fn new(time_step: f64, spectral_radius: f64) -> Result<Self, TrackError> {
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(TrackError::Parameter { name: "time step", value: time_step, expected: "above 0" });
        }
        if !(0.0..=1.0).contains(&spectral_radius) {
            return Err(TrackError::Parameter {
                name: "spectral radius",
                value: spectral_radius,
                expected: "from 0 to 1",
            });
        }
        let rho = spectral_radius;
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let excess = 1.0 - alpha_m + alpha_f;
        Ok(Self { time_step, alpha_m, alpha_f, beta: 0.25 * excess * excess, gamma: excess - 0.5 })
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
