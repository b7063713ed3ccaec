//! Whether a point lies inside a closed mesh: the winding number of the surface around the point.

use super::mesh::Mesh;
use super::triangles::{MeshKind, winding};
use nalgebra::Vector3;

/// Directions of the rays, none along an axis or a common diagonal.
const DIRECTIONS: [[f64; 3]; 4] =
    [[0.8017, 0.2672, 0.5345], [-0.2113, 0.7731, 0.5981], [0.3713, -0.5571, 0.7428], [-0.6247, -0.4685, -0.6247]];

/// A ray that passes an edge, or starts in front of a facet, closer than this (in facet sizes) gives no reliable
/// result.
const CERTAIN: f64 = 1e-9;

/// Nor does a ray nearly parallel to a facet, by the sine of the angle between them.
const ALONG: f64 = 1e-6;

impl Mesh {
    /// Whether a point lies inside the solid; never inside a sheet.
    pub fn contains(&self, point: &Vector3<f64>) -> bool {
        match self.kind {
            MeshKind::OneSided | MeshKind::TwoSided => false,
            MeshKind::Solid => self.winding(point) > 0,
            MeshKind::Container => self.winding(point) >= 0,
        }
    }

    /// 1 in a solid, -1 in the cavity of a container, 0 outside; larger if bodies of one mesh overlap.
    fn winding(&self, point: &Vector3<f64>) -> i64 {
        let [low, high] = self.bounds();
        if (0..3).any(|k| point[k] < low[k] || point[k] > high[k]) {
            return 0;
        }
        let by_ray = DIRECTIONS.iter().find_map(|d| self.crossings(point, &Vector3::from(*d)));
        by_ray.unwrap_or_else(|| winding(&self.vertices, self.triangles.iter(), point))
    }

    /// Number of exits of a ray through the surface minus number of entries; `None` if that is not reliable.
    fn crossings(&self, point: &Vector3<f64>, direction: &Vector3<f64>) -> Option<i64> {
        let inverse = direction.map(f64::recip);
        let enter = |low: &Vector3<f64>, high: &Vector3<f64>| {
            let (a, b) = ((low - point).component_mul(&inverse), (high - point).component_mul(&inverse));
            a.inf(&b).max().max(0.0) <= a.sup(&b).min() * (1.0 + CERTAIN)
        };
        let mut sum = Some(0);
        self.tree.search(enter, |facet| {
            let facet = &self.surface.facets[facet as usize];
            sum = sum.and_then(|sum| Some(sum + crossing(&facet.places, point, direction)?));
        });
        sum
    }
}

/// 1 if the ray leaves through the triangle, -1 if it enters, 0 if it passes the triangle (Moeller and Trumbore 1997).
fn crossing(places: &[Vector3<f64>; 3], point: &Vector3<f64>, direction: &Vector3<f64>) -> Option<i64> {
    let (first, second, from) = (places[1] - places[0], places[2] - places[0], point - places[0]);
    let normal = first.cross(&second);
    let across = direction.dot(&normal);
    if across.abs() <= ALONG * normal.norm() {
        return None;
    }
    let turn = from.cross(direction);
    let u = -second.dot(&turn) / across;
    let v = first.dot(&turn) / across;
    let ahead = -from.dot(&normal) / across;
    let scale = (first.norm() + second.norm()).max(from.norm());
    let least = u.min(v).min(1.0 - u - v);
    if least < -CERTAIN || ahead < -CERTAIN * scale {
        return Some(0);
    }
    (least > CERTAIN && ahead > CERTAIN * scale).then_some(if across > 0.0 { 1 } else { -1 })
}
