//! Points that represent a surface, each a part of it: the surface of a union of balls, or of a mesh.

use super::super::clump::Pebble;
use super::super::shape::Mesh;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// A point that represents a part of a surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    /// m.
    pub at: Vector3<f64>,
    /// Unit, outward.
    pub normal: Vector3<f64>,
    /// m².
    pub area: f64,
}

/// Points on the surface of a union of balls, `count` on each ball except points inside other balls (a spiral of equal
/// areas).
pub fn outside(pebbles: &[Pebble], count: usize) -> Vec<SurfacePoint> {
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
            (height(&others, &at) > 0.0).then_some(SurfacePoint { at, normal, area })
        })
    };
    pebbles.iter().enumerate().flat_map(on).collect()
}

/// About `count` points of a mesh: facets larger than the share of a point are divided; smaller facets are sampled at
/// equal intervals of area.
pub fn on_facets(surface: &Mesh, count: usize) -> Vec<SurfacePoint> {
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
                points.push(SurfacePoint { at: (a + b + c) / 3.0, normal, area: share });
            }
            continue;
        }
        // n² triangles of equal area
        let n = (area / share).sqrt().ceil() as usize;
        let part = area / (n * n) as f64;
        let at = |i: f64, j: f64| a + (b - a) * (i / n as f64) + (c - a) * (j / n as f64);
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i as f64, j as f64))) {
            points.push(SurfacePoint { at: at(i + 1.0 / 3.0, j + 1.0 / 3.0), normal, area: part });
            if i + j + 1.0 < n as f64 {
                points.push(SurfacePoint { at: at(i + 2.0 / 3.0, j + 2.0 / 3.0), normal, area: part });
            }
        }
    }
    points
}

/// Height of a point above the surface of a union of balls, m: exact outside, a lower bound of the depth inside.
pub fn height(pebbles: &[Pebble], point: &Vector3<f64>) -> f64 {
    pebbles.iter().map(|p| (point - p.centre).norm() - p.radius).fold(f64::INFINITY, f64::min)
}
