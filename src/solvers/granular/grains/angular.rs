//! Angular grains without a scan: an ellipsoid cut by random planes, with rounded edges.
//!
//! Planes with normals distributed over the sphere cut a ball at random depths. The body between them is stretched to
//! the ellipsoid; the grain is everything within a radius of this body. Roundness is that radius divided by the radius
//! of the largest inscribed ball (Wadell 1932, all corners alike): 0 is a body with sharp edges, 1 would be a ball. The
//! body is stretched again until flatness and elongation of the grain, measured on its smallest box, have the required
//! values.

use super::super::shape::{Mesh, MeshKind};
use super::Random;
use super::form::{Box, Solid, extent};
use super::polyhedron::{Plane, corners, inscribed_radius, rounded};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;

/// Planes that cut a grain, besides the box that closes it.
const CUTS: usize = 16;
/// Distance of cuts from the centre, over the radius of the ball.
const DEPTHS: [f64; 2] = [0.72, 1.0];
/// Number of random normals tried for each cut: the one farthest from its neighbours is taken.
const TRIED: usize = 8;
/// Triangles along an arc of a rounded edge.
const SEGMENTS: usize = 3;
/// Tolerance of the shape indices, as a share of the required values.
pub const TOLERANCE: f64 = 0.01;
/// Largest number of stretching rounds; a round at least halves the error.
const ROUNDS: usize = 30;
/// Number of bodies that are cut before the search fails.
const BODIES: u64 = 20;

/// The required grain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Angular {
    /// Shortest over intermediate side of the smallest box.
    pub flatness: f64,
    /// Intermediate over longest side.
    pub elongation: f64,
    /// Radius of edges and corners divided by the radius of the largest inscribed ball.
    pub roundness: f64,
}

/// Why there is no such grain.
#[derive(Debug, Clone, PartialEq)]
pub enum AngularError {
    /// A flatness, elongation or roundness outside its range.
    Index { name: &'static str, value: f64, range: [f64; 2] },
    /// No body reached the required indices.
    NotReached,
}

impl Angular {
    /// Range of flatness and elongation of a grain.
    pub const FORMS: [f64; 2] = [0.3, 1.0];
    pub const ROUNDNESSES: [f64; 2] = [0.0, 0.6];

    /// A closed surface with equivalent diameter 1 about its centroid, for the seed and the number of the grain.
    pub fn surface(&self, seed: u64, number: u64) -> Result<Mesh, AngularError> {
        let forms = [("flatness", self.flatness, Self::FORMS), ("elongation", self.elongation, Self::FORMS)];
        for (name, value, range) in forms.into_iter().chain([("roundness", self.roundness, Self::ROUNDNESSES)]) {
            if !(range[0]..=range[1]).contains(&value) {
                return Err(AngularError::Index { name, value, range });
            }
        }
        let body = |attempt| {
            let mut random = Random::new(seed, SHAPES + BODIES * number + attempt);
            self.body(cuts(&mut random))
        };
        (0..BODIES).find_map(body).ok_or(AngularError::NotReached)
    }

    /// The grain of planes that cut a ball; `None` if it cannot be stretched to its form.
    fn body(&self, mut planes: Vec<Plane>) -> Option<Mesh> {
        // longest side 1
        let wanted = [self.flatness * self.elongation, self.elongation, 1.0];
        planes = stretched(&planes, &Matrix3::from_diagonal(&Vector3::from(wanted)));
        for _ in 0..ROUNDS {
            let corners = corners(&planes);
            let radius = inscribed_radius(&planes) * self.roundness / (1.0 - self.roundness);
            let (vertices, triangles) = rounded(&planes, &corners, radius, SEGMENTS);
            let around = Box::round(|n| extent(&vertices, n));
            let ratio = |k: usize| around.sides[k] / around.sides[2] / wanted[k];
            if (0..2).all(|k| (ratio(k) - 1.0).abs() < 0.5 * TOLERANCE) {
                return grain(&vertices, triangles);
            }
            // the rounding grows with the shortest side of the sharp body, and is excluded from stretching
            let (length, sharp) = (around.sides[2], around.sides.map(|side| side - 2.0 * radius));
            let rounding = wanted[0] * length * radius / around.sides[0];
            let factor = |k: usize| ((wanted[k] * length - 2.0 * rounding) / sharp[k]).clamp(0.5, 2.0);
            let along = |k: usize| around.axes[k] * around.axes[k].transpose() * factor(k);
            planes = stretched(&planes, &(along(0) + along(1) + along(2)));
        }
        None
    }
}

/// First random stream for shapes.
const SHAPES: u64 = 1 << 32;

/// Planes around the unit ball and through it.
fn cuts(random: &mut Random) -> Vec<Plane> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut planes: Vec<Plane> =
        axes.iter().flat_map(|n| [*n, -n]).map(|normal| Plane { normal, height: 1.1 }).collect();
    for cut in 0..CUTS {
        let crowded = |n: &Vector3<f64>| planes[6..].iter().map(|p| p.normal.dot(n)).fold(-1.0, f64::max);
        let tried: Vec<_> = (0..if cut > 0 { TRIED } else { 1 }).map(|_| random.direction()).collect();
        let normal = tried.into_iter().min_by(|a, b| crowded(a).total_cmp(&crowded(b))).unwrap_or_else(Vector3::x);
        planes.push(Plane { normal, height: random.between(DEPTHS[0], DEPTHS[1]) });
    }
    planes
}

fn stretched(planes: &[Plane], stretch: &Matrix3<f64>) -> Vec<Plane> {
    let inverse = stretch.try_inverse().unwrap_or_else(Matrix3::identity).transpose();
    planes.iter().map(|plane| plane.stretched(&inverse)).collect()
}

/// The surface, with equivalent diameter 1, about its centroid.
fn grain(vertices: &[Vector3<f64>], triangles: Vec<[u32; 3]>) -> Option<Mesh> {
    let solid = Solid::inside(vertices, &triangles);
    let scale = (PI / 6.0 / solid.volume).cbrt();
    let placed = vertices.iter().map(|v| (v - solid.centroid) * scale).collect();
    Mesh::new(placed, triangles, MeshKind::Solid).ok()
}

impl fmt::Display for AngularError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AngularError::Index { name, value, range: [low, high] } => {
                write!(f, "expected a {name} from {low} to {high}, found {value}")
            }
            AngularError::NotReached => {
                write!(f, "no grain with these shape indices was found; make it less flat or less round")
            }
        }
    }
}

impl std::error::Error for AngularError {}
