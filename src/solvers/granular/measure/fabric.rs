//! Directions of contacts: the fabric tensor of their normals, and roses.
//!
//! The tensor is defined by Satake (1982, IUTAM Conference on Deformation and Failure of Granular Materials, Delft,
//! 63-68), `F = (1/N) Σ n ⊗ n`, of trace 1. A normal and its opposite are the same direction.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Bins of an inclination, from the vertical to the horizontal.
const INCLINATIONS: usize = 9;
/// Bins of half a turn in a vertical plane.
const AZIMUTHS: usize = 18;

/// Distribution of the normals of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fabric {
    pub contacts: usize,
    /// Rows; a third of the unit matrix without a preferred direction, 0 without contacts.
    pub tensor: [[f64; 3]; 3],
}

impl Fabric {
    /// Fabric of unit normals.
    pub fn from_normals(normals: impl IntoIterator<Item = [f64; 3]>) -> Fabric {
        let (mut contacts, mut sum) = (0, Matrix3::zeros());
        for normal in normals.into_iter().map(Vector3::from) {
            contacts += 1;
            sum += normal * normal.transpose();
        }
        let tensor = sum / f64::from(contacts.max(1));
        Fabric { contacts: contacts as usize, tensor: rows(&tensor) }
    }

    /// `√(3/2 D : D)` of the deviator D: 0 without a preferred direction, 1 if there is only one direction. If two
    /// principal values are equal it is the difference between them and the third value.
    pub fn deviator(&self) -> f64 {
        if self.contacts == 0 { 0.0 } else { equivalent(&self.tensor) }
    }

    /// Amplitude `a` of the density of directions, `(1 + a : n n)/(4π)` with `a = 15/2 D` (Kanatani 1984, Int. J. Eng.
    /// Sci. 22, 149-164), as one number, `√(3/2 a : a)`.
    pub fn anisotropy(&self) -> f64 {
        7.5 * self.deviator()
    }
}

/// Von Mises' measure of a symmetric tensor, `√(3/2 D : D)`.
pub(super) fn equivalent(tensor: &[[f64; 3]; 3]) -> f64 {
    let tensor = Matrix3::from_fn(|row, column| tensor[row][column]);
    let deviator = tensor - Matrix3::identity() * (tensor.trace() / 3.0);
    (1.5 * deviator.component_mul(&deviator).sum()).sqrt()
}

pub(super) fn rows(tensor: &Matrix3<f64>) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| tensor[(row, column)]))
}

/// Densities of directions, each divided by the isotropic density: 1 everywhere in an isotropic bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rose {
    /// By the angle from the vertical, 0 to 90 degrees in steps of 10.
    pub inclination: Vec<f64>,
    /// By the angle from the horizontal of the projection on the vertical plane along x, 0 to 180 degrees in steps of
    /// 10.
    pub along: Vec<f64>,
    /// The same for the vertical plane along y.
    pub across: Vec<f64>,
}

impl Rose {
    /// Rose of unit normals; zero everywhere without normals.
    pub fn from_normals(normals: impl IntoIterator<Item = [f64; 3]>) -> Rose {
        let mut inclination = vec![0.0; INCLINATIONS];
        let mut planes = [vec![0.0; AZIMUTHS], vec![0.0; AZIMUTHS]];
        for [x, y, z] in normals {
            let step = std::f64::consts::FRAC_PI_2 / INCLINATIONS as f64;
            // the tangent is accurate also if the cosine is not
            inclination[bin(x.hypot(y).atan2(z.abs()), step, INCLINATIONS)] += 1.0;
            for (plane, across) in planes.iter_mut().zip([x, y]) {
                let step = std::f64::consts::PI / AZIMUTHS as f64;
                plane[bin(z.atan2(across).rem_euclid(std::f64::consts::PI), step, AZIMUTHS)] += 1.0;
            }
        }
        let edge = |k: usize| (k as f64 * std::f64::consts::FRAC_PI_2 / INCLINATIONS as f64).cos();
        let isotropic: Vec<f64> = (0..INCLINATIONS).map(|k| edge(k) - edge(k + 1)).collect();
        let [along, across] = planes.map(|counts| over(counts, &[1.0 / AZIMUTHS as f64; AZIMUTHS]));
        Rose { inclination: over(inclination, &isotropic), along, across }
    }
}

fn bin(angle: f64, step: f64, count: usize) -> usize {
    ((angle / step) as usize).min(count - 1)
}

/// Counts as shares of their sum, divided by the isotropic shares.
fn over(counts: Vec<f64>, isotropic: &[f64]) -> Vec<f64> {
    let all: f64 = counts.iter().sum();
    counts.iter().zip(isotropic).map(|(count, share)| if all > 0.0 { count / all / share } else { 0.0 }).collect()
}
