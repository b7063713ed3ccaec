//! The largest step of a pair of matrices: 4 - dt^2 K - 2 dt C positive definite, with inertia scaled to one.

use nalgebra::{SMatrix, SVector};

/// Largest number of iterations for the limit of one body.
const ROUNDS: usize = 60;

/// The step at which `a dt^2 + 2 b dt = 4` \[s\]; infinite without stiffness and dashpot.
pub(super) fn step(a: f64, b: f64) -> f64 {
    4.0 / (b + (b * b + 4.0 * a).sqrt())
}

/// Stiffness and dashpots on the six motions of one body, inertia scaled to one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pencil {
    pub stiffness: SMatrix<f64, 6, 6>,
    pub dashpots: SMatrix<f64, 6, 6>,
}

impl Pencil {
    pub fn zero() -> Pencil {
        Pencil { stiffness: SMatrix::zeros(), dashpots: SMatrix::zeros() }
    }

    pub fn at_step(&self, dt: f64) -> SMatrix<f64, 6, 6> {
        self.stiffness * (dt * dt) + self.dashpots * (2.0 * dt)
    }

    /// Whether a step is below the limit.
    pub fn allows(&self, dt: f64) -> bool {
        (SMatrix::<f64, 6, 6>::identity() * 4.0 - self.at_step(dt)).cholesky().is_some()
    }

    /// Factor of inertia that makes `dt` the limit; 1 if the limit is above `dt` already.
    pub fn inertia_factor(&self, dt: f64) -> f64 {
        self.at_step(dt).symmetric_eigenvalues().max() / 4.0
    }

    /// The limit \[s\]: iterated from above by the mode that grows fastest at the present step; it converges like
    /// Newton's iteration.
    pub fn limit(&self) -> f64 {
        let mut dt = step(self.stiffness.trace(), self.dashpots.trace()) * 6.0;
        if !dt.is_finite() {
            return f64::INFINITY;
        }
        for _ in 0..ROUNDS {
            let eigen = self.at_step(dt).symmetric_eigen();
            let mode: SVector<f64, 6> = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned();
            let next = step(mode.dot(&(self.stiffness * mode)), mode.dot(&(self.dashpots * mode)));
            if (next / dt - 1.0).abs() < 1e-14 {
                return next;
            }
            dt = next;
        }
        dt
    }
}
