//! Difference between a clump and its surface, with equal volumes and centroids, as for the grains of a bed.

use super::super::clump::{Pebble, Template};
use super::super::shape::Mesh;
use super::form::Solid;
use super::points::{height, on_facets, outside};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Number of points in the box around both, for volumes with an error of 0.01 of the volume of the surface.
const POINTS: usize = 50_000;
/// Points on a surface.
const ON_SURFACE: usize = 3000;

/// Differences between a clump and a surface; all four are 0 if they are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Volume inside only one of the two, divided by the volume of the surface: half of it is missing, half is
    /// additional.
    pub volume: f64,
    /// Distance between the surfaces, mean over both, divided by the diameter of the ball of equal volume. For a point
    /// inside a clump the depth below the surface of its deepest pebble is used, which is a lower bound.
    pub mean_distance: f64,
    /// The largest distance (after Hausdorff).
    pub largest_distance: f64,
    /// Frobenius norm of the difference of the inertia tensors divided by the norm of the tensor of the surface: axes
    /// count as well as values.
    pub inertia: f64,
}

impl Misfit {
    /// Differences of a clump that lies in the frame of its given pebbles.
    pub fn between(surface: &Mesh, clump: &Template) -> Self {
        let solid = Solid::inside(surface.vertices(), surface.triangles());
        let scale = (solid.volume / clump.volume).cbrt();
        let pebbles: Vec<Pebble> = clump
            .pebbles
            .iter()
            .map(|p| Pebble { centre: solid.centroid + clump.axes * p.centre * scale, radius: p.radius * scale })
            .collect();
        let axes = clump.axes.to_rotation_matrix();
        let inertia = axes.matrix() * Matrix3::from_diagonal(&clump.inertia) * axes.matrix().transpose();
        let (mean, largest) = distances(surface, &pebbles);
        let diameter = (6.0 * solid.volume / PI).cbrt();
        Self {
            volume: difference(surface, &pebbles) / solid.volume,
            mean_distance: mean / diameter,
            largest_distance: largest / diameter,
            inertia: (inertia * scale.powi(5) - solid.inertia()).norm() / solid.inertia().norm(),
        }
    }
}

/// Volume inside only one of the two, m³, by points that fill the box evenly (Roberts 2018, the R3 sequence).
fn difference(surface: &Mesh, pebbles: &[Pebble]) -> f64 {
    let [mut low, mut high] = surface.bounds();
    for pebble in pebbles {
        low = low.inf(&pebble.centre.add_scalar(-pebble.radius));
        high = high.sup(&pebble.centre.add_scalar(pebble.radius));
    }
    let step = Vector3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_3);
    let size = high - low;
    let unlike = |k: &usize| {
        let share = (step * (*k as f64 + 0.5)).map(f64::fract);
        let point = low + share.component_mul(&size);
        surface.contains(&point) != (height(pebbles, &point) < 0.0)
    };
    (0..POINTS).filter(unlike).count() as f64 / POINTS as f64 * size.product()
}

/// Mean and largest distance of the two surfaces, m.
fn distances(surface: &Mesh, pebbles: &[Pebble]) -> (f64, f64) {
    let (mut sum, mut area, mut largest) = (0.0, 0.0, 0.0f64);
    let mut add = |distance: f64, part: f64| {
        sum += distance * part;
        area += part;
        largest = largest.max(distance);
    };
    for point in outside(pebbles, ON_SURFACE / pebbles.len() + 1) {
        let nearest = surface.nearest(&point.at, f64::MAX.sqrt());
        add(nearest.map_or(0.0, |nearest| nearest.distance), point.area);
    }
    for point in on_facets(surface, ON_SURFACE) {
        add(height(pebbles, &point.at).abs(), point.area);
    }
    // the points that stick out most are corners
    surface.vertices().iter().for_each(|corner| add(height(pebbles, corner).abs(), 0.0));
    (sum / area, largest)
}
