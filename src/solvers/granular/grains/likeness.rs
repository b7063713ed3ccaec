//! How unlike its surface a clump is, of equal volume and about the same centroid, as grains of a bed are.

use super::super::clump::{Pebble, Template};
use super::super::shape::Mesh;
use super::form::Solid;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// Points in the box round both, for volumes: to 0.01 of the surface's.
const POINTS: usize = 50_000;
/// Points on a surface.
const ON_SURFACE: usize = 3000;

/// What a clump gets wrong of a surface; 0 in all four for one that is the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeError {
    /// Volume that is in one of the two only, over the volume of the surface: half of it is missing, half too much.
    pub volume: f64,
    /// Distance of the surfaces, averaged over both, over the diameter of the ball of equal volume. Inside a clump a
    /// point is as far from the surface as it lies below its deepest pebble's, which is a lower bound.
    pub mean_distance: f64,
    /// The largest one (after Hausdorff).
    pub largest_distance: f64,
    /// Frobenius norm of the difference of the inertia tensors over that of the surface: axes count as well as values.
    pub inertia: f64,
}

impl ShapeError {
    /// Of a clump that stands in the frame in which its pebbles were given.
    pub fn between(surface: &Mesh, clump: &Template) -> Self {
        let solid = Solid::of(surface.vertices(), surface.triangles());
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

/// Height of a point over the surface of a union of balls, m: exact outside, a lower bound of the depth inside.
fn height(pebbles: &[Pebble], point: &Vector3<f64>) -> f64 {
    pebbles.iter().map(|p| (point - p.centre).norm() - p.radius).fold(f64::INFINITY, f64::min)
}

/// Volume that is in one of the two only, m³, by points that fill the box evenly (Roberts 2018, the R3 sequence).
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
    // what sticks out most is a corner
    surface.vertices().iter().for_each(|corner| add(height(pebbles, corner).abs(), 0.0));
    (sum / area, largest)
}

/// A point of a surface that stands for a part of it.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// m.
    pub at: Vector3<f64>,
    /// Unit, outward.
    pub normal: Vector3<f64>,
    /// m².
    pub area: f64,
}

/// Points of the surface of a union of balls, `count` on each ball less those that others hide (a spiral of equal areas).
pub fn outside(pebbles: &[Pebble], count: usize) -> Vec<Point> {
    let golden = PI * (3.0 - 5.0f64.sqrt());
    let on = |(number, pebble): (usize, &Pebble)| {
        let others: Vec<Pebble> = pebbles.iter().enumerate().filter(|(i, _)| *i != number).map(|(_, p)| *p).collect();
        let area = 4.0 * PI * pebble.radius.powi(2) / count as f64;
        let pebble = *pebble;
        (0..count).filter_map(move |k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
            let (sine, cosine) = (golden * k as f64).sin_cos();
            let normal = Vector3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z);
            let at = pebble.centre + normal * pebble.radius;
            (height(&others, &at) > 0.0).then_some(Point { at, normal, area })
        })
    };
    pebbles.iter().enumerate().flat_map(on).collect()
}

/// About so many points of a mesh: facets larger than their share are divided, of those smaller every so manyth is taken.
pub fn on_facets(surface: &Mesh, count: usize) -> Vec<Point> {
    let share = surface.area() / count as f64;
    let (mut points, mut waiting) = (Vec::new(), 0.5 * share);
    for (number, corners) in surface.triangles().iter().enumerate() {
        let [a, b, c] = corners.map(|v| surface.vertices()[v as usize]);
        let normal = surface.normal(number as u32);
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        if area < share {
            waiting += area;
            if waiting >= share {
                waiting -= share;
                points.push(Point { at: (a + b + c) / 3.0, normal, area: share });
            }
            continue;
        }
        // n² triangles of equal area
        let n = (area / share).sqrt().ceil() as usize;
        let part = area / (n * n) as f64;
        let at = |i: f64, j: f64| a + (b - a) * (i / n as f64) + (c - a) * (j / n as f64);
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i as f64, j as f64))) {
            points.push(Point { at: at(i + 1.0 / 3.0, j + 1.0 / 3.0), normal, area: part });
            if i + j + 1.0 < n as f64 {
                points.push(Point { at: at(i + 2.0 / 3.0, j + 2.0 / 3.0), normal, area: part });
            }
        }
    }
    points
}
