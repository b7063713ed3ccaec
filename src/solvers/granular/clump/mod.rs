//! Templates of clumps: overlapping spheres that move as one rigid body, with the mass properties of their union.
//!
//! Volume, centroid and inertia are the values of the union; a part inside several pebbles is counted once (PFC's
//! "accounting for overlap"). They are integrated, not sampled: the error is below 1e-11 of the value, compared with
//! closed forms of two and three spheres. Sines come from the platform, so the last digits of a template may differ
//! between machines. A pebble that is hidden only by several others together adds no volume, and cannot touch anything.

mod error;
mod frame;
#[cfg(test)]
mod tests;

pub use super::union::Pebble;
pub use error::TemplateError;

use super::union::moments;
use frame::principal_frame;
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Pebbles still count as touching if their centres are farther apart than the sum of their radii by this share: the
/// rounding of a file.
const TOUCH: f64 = 1e-9;

/// The fifth power of a radius (m) must be a finite number; between this limit and its inverse it is.
const SMALLEST: f64 = 1e-50;

/// A shape of clumps, in its principal frame.
///
/// A point p of the principal frame is `axes * p + centroid` in the frame of the given pebbles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Template {
    /// In the principal frame, about the centroid, in the order given.
    pub pebbles: Vec<Pebble>,
    /// Volume of the union, m³.
    pub volume: f64,
    /// Principal moments of the union about its centroid for unit density, m⁵.
    pub inertia: Vector3<f64>,
    /// Centroid in the given frame, m.
    pub centroid: Vector3<f64>,
    /// Rotation from the principal frame to the given frame. Given axes that are principal axes are kept, and so are
    /// two axes with equal moments.
    pub axes: UnitQuaternion<f64>,
}

impl Template {
    /// The template of these pebbles, in any frame. The computing time grows with the number of pebbles and of their
    /// common corners.
    pub fn from_pebbles(pebbles: &[Pebble]) -> Result<Self, TemplateError> {
        check(pebbles)?;
        if let [pebble] = pebbles {
            return Ok(Self { centroid: pebble.centre, ..Self::ball(pebble.radius) });
        }
        let origin = pebbles.iter().map(|p| p.centre).sum::<Vector3<f64>>() / pebbles.len() as f64;
        let near: Vec<_> = pebbles.iter().map(|p| Pebble { centre: p.centre - origin, ..*p }).collect();
        let whole = moments(&near);
        let centroid = whole.first / whole.volume;
        let (axes, second) = principal_frame(&(whole.second - whole.first * centroid.transpose()));
        let inertia = Vector3::new(second.y + second.z, second.z + second.x, second.x + second.y);
        let turned = |p: &Pebble| Pebble { centre: axes.inverse() * (p.centre - centroid), ..*p };
        Ok(Self {
            pebbles: near.iter().map(turned).collect(),
            volume: whole.volume,
            inertia,
            centroid: origin + centroid,
            axes,
        })
    }

    /// One sphere of `radius` (m) about the origin.
    pub fn sphere(radius: f64) -> Result<Self, TemplateError> {
        Self::from_pebbles(&[Pebble { centre: Vector3::zeros(), radius }])
    }

    fn ball(radius: f64) -> Self {
        let volume = 4.0 / 3.0 * PI * radius * radius * radius;
        Self {
            pebbles: vec![Pebble { centre: Vector3::zeros(), radius }],
            volume,
            inertia: Vector3::repeat(0.4 * volume * radius * radius),
            centroid: Vector3::zeros(),
            axes: UnitQuaternion::identity(),
        }
    }

    /// The same shape, larger by a `factor` above 0 about the origin of the given frame.
    pub fn scaled(&self, factor: f64) -> Self {
        let larger = |p: &Pebble| Pebble { centre: p.centre * factor, radius: p.radius * factor };
        Self {
            pebbles: self.pebbles.iter().map(larger).collect(),
            volume: self.volume * factor.powi(3),
            inertia: self.inertia * factor.powi(5),
            centroid: self.centroid * factor,
            axes: self.axes,
        }
    }

    /// Diameter of the sphere with the same volume, m.
    pub fn equivalent_diameter(&self) -> f64 {
        (6.0 * self.volume / PI).cbrt()
    }

    /// Radius of the sphere about the centroid that holds every pebble, m.
    pub fn bounding_radius(&self) -> f64 {
        self.pebbles.iter().map(|p| p.centre.norm() + p.radius).fold(0.0, f64::max)
    }
}

fn check(pebbles: &[Pebble]) -> Result<(), TemplateError> {
    if pebbles.is_empty() {
        return Err(TemplateError::NoPebbles);
    }
    for (pebble, p) in pebbles.iter().enumerate() {
        if !(SMALLEST..=1.0 / SMALLEST).contains(&p.radius) {
            return Err(TemplateError::Radius { pebble, radius: p.radius });
        }
        if !p.centre.iter().all(|c| c.is_finite()) {
            return Err(TemplateError::Centre { pebble });
        }
        let hides = |(other, q): (usize, &Pebble)| {
            (other != pebble && (q.centre - p.centre).norm() + p.radius <= q.radius).then_some(other)
        };
        if let Some(inside) = pebbles.iter().enumerate().find_map(hides) {
            return Err(TemplateError::Swallowed { pebble, inside });
        }
    }
    apart_from_first(pebbles).map_or(Ok(()), |pebble| Err(TemplateError::Apart { pebble }))
}

/// A pebble that no chain of touching pebbles connects to the first.
fn apart_from_first(pebbles: &[Pebble]) -> Option<usize> {
    let mut joined = vec![false; pebbles.len()];
    joined[0] = true;
    let mut front = vec![0];
    while let Some(i) = front.pop() {
        for j in 0..pebbles.len() {
            let reach = (pebbles[i].radius + pebbles[j].radius) * (1.0 + TOUCH);
            if !joined[j] && (pebbles[i].centre - pebbles[j].centre).norm() <= reach {
                joined[j] = true;
                front.push(j);
            }
        }
    }
    joined.iter().position(|j| !j)
}
