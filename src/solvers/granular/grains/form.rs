//! The form of a grain: its lengths, and the indices computed from them.
//!
//! L, I and S are the sides of the smallest box around the grain (Blott and Pye 2008, Sedimentology 55(1)). Flatness is
//! S/I and elongation I/L (Zingg 1935), both 1 for a cube and a ball and smaller for plates and needles. Sphericity is
//! the surface of the ball of the same volume divided by the surface of the grain (Wadell 1932).

use super::super::shape::Mesh;
use super::random::Random;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// Frames in which the box is measured before the best frames are rotated further.
const FRAMES: usize = 300;
/// Frames that are rotated further, and the step at which the search ends, rad.
const TURNED: usize = 6;
const LAST_STEP: f64 = 1e-5;
/// Number of rotations tried before the step is halved.
const TRIES: usize = 9;

/// Form of a grain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GrainForm {
    /// Shortest, intermediate and longest side of the smallest box, m.
    pub sides: [f64; 3],
    /// Their directions, unit.
    pub axes: [Vector3<f64>; 3],
    /// m³.
    pub volume: f64,
    /// Area of the surface, m².
    pub area: f64,
}

impl GrainForm {
    /// Form of a closed surface.
    pub fn of_surface(surface: &Mesh) -> Self {
        let vertices = surface.vertices();
        let Box { sides, axes } = Box::round(|n| extent(vertices, n));
        Self { sides, axes, volume: surface.volume(), area: surface.area() }
    }

    /// Flatness, S/I.
    pub fn flatness(&self) -> f64 {
        self.sides[0] / self.sides[1]
    }

    /// Elongation, I/L.
    pub fn elongation(&self) -> f64 {
        self.sides[1] / self.sides[2]
    }

    /// Sphericity after Wadell, at most 1.
    pub fn sphericity(&self) -> f64 {
        PI.cbrt() * (6.0 * self.volume).powf(2.0 / 3.0) / self.area
    }
}

/// Length of a cloud of points along a unit vector, m.
pub fn extent(points: &[Vector3<f64>], along: &Vector3<f64>) -> f64 {
    let (low, high) = points
        .iter()
        .map(|p| p.dot(along))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}

/// The box of the smallest volume around a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box {
    /// Ascending, m.
    pub sides: [f64; 3],
    /// Directions of the sides, in the same order.
    pub axes: [Vector3<f64>; 3],
}

impl Box {
    /// The box around a body given by its extent (m) along every unit vector: the best of many frames, rotated until no
    /// small rotation reduces the volume. The result is always the same for the same body.
    pub fn round(extent: impl Fn(&Vector3<f64>) -> f64) -> Self {
        let volume = |frame: &UnitQuaternion<f64>| axes(frame).iter().map(&extent).product::<f64>();
        let mut random = Random::new(0, 0);
        let mut frames: Vec<(f64, UnitQuaternion<f64>)> = (0..FRAMES)
            .map(|_| UnitQuaternion::from_scaled_axis(random.direction() * random.between(0.0, PI)))
            .chain([UnitQuaternion::identity()])
            .map(|frame| (volume(&frame), frame))
            .collect();
        frames.sort_by(|a, b| a.0.total_cmp(&b.0));
        frames.truncate(TURNED);
        for (least, frame) in &mut frames {
            let mut step = 0.2;
            while step > LAST_STEP {
                let better = (0..TRIES).find_map(|_| {
                    let turned = UnitQuaternion::from_scaled_axis(random.direction() * step) * *frame;
                    let less = volume(&turned);
                    (less < *least).then_some((less, turned))
                });
                match better {
                    Some(turned) => (*least, *frame) = turned,
                    None => step *= 0.5,
                }
            }
        }
        let best = frames.iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(UnitQuaternion::identity, |f| f.1);
        let mut sides = axes(&best).map(|axis| (extent(&axis), axis));
        sides.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { sides: sides.map(|s| s.0), axes: sides.map(|s| s.1) }
    }
}

fn axes(frame: &UnitQuaternion<f64>) -> [Vector3<f64>; 3] {
    [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| frame * axis)
}

/// Volume (m³), centroid (m) and second moments `∫ x xᵀ dV` about the centroid (m⁵) of the body inside a closed
/// surface: sums over tetrahedra with a vertex at the first corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    pub volume: f64,
    pub centroid: Vector3<f64>,
    pub second: Matrix3<f64>,
}

impl Solid {
    pub fn inside(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Self {
        let tip = triangles.first().map_or_else(Vector3::zeros, |t| vertices[t[0] as usize]);
        let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for corners in triangles {
            let [a, b, c] = corners.map(|v| vertices[v as usize] - tip);
            let part = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += part;
            first += sum * (part / 4.0);
            // of a tetrahedron with corners 0, a, b, c: V/20 (s sᵀ + Σ p pᵀ)
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (sum * sum.transpose() + squares) * (part / 20.0);
        }
        let centroid = first / volume;
        Self { volume, centroid: tip + centroid, second: second - first * centroid.transpose() }
    }

    /// Moments of inertia for unit density, m⁵.
    pub fn inertia(&self) -> Matrix3<f64> {
        Matrix3::identity() * self.second.trace() - self.second
    }
}
