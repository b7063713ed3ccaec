//! Triangles before they form a mesh: the kinds of surfaces, sums over triangles, and their common edges.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The kind of a surface of triangles. Normals follow the right-hand rule along the corners of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MeshKind {
    /// A closed body, normals outward; spheres touch it from outside. Several bodies may form one mesh if they do not
    /// intersect each other.
    Solid,
    /// A closed cavity, normals inward; spheres are inside it.
    Container,
    /// An open sheet with solid behind its normals. Its border is touched from all sides.
    OneSided,
    /// An open sheet without thickness, touched from both sides.
    TwoSided,
}

/// Area times the unit normal, m2.
pub(super) fn area_vector(vertices: &[Vector3<f64>], corners: &[u32; 3]) -> Vector3<f64> {
    let [a, b, c] = corners.map(|v| vertices[v as usize]);
    (b - a).cross(&(c - a)) / 2.0
}

/// Sum of tetrahedra over the facets, m3, with a vertex at a corner of the mesh: this is exact also far from the
/// origin.
pub(super) fn volume<'a>(vertices: &[Vector3<f64>], mut facets: impl Iterator<Item = &'a [u32; 3]>) -> f64 {
    let Some(first) = facets.next() else { return 0.0 };
    let tip = vertices[first[0] as usize];
    let tetrahedron = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| vertices[v as usize] - tip);
        a.dot(&b.cross(&c)) / 6.0
    };
    facets.map(tetrahedron).sum()
}

/// An edge of one facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfEdge {
    /// The lower vertex first.
    pub ends: [u32; 2],
    pub facet: u32,
    pub slot: usize,
    /// Whether the facet runs from the lower vertex to the higher.
    pub forward: bool,
}

/// All sides of all triangles; the sides at one edge are contiguous.
pub(super) fn half_edges(triangles: &[[u32; 3]]) -> Vec<HalfEdge> {
    let side = |facet: usize, corners: &[u32; 3], slot: usize| {
        let (a, b) = (corners[slot], corners[(slot + 1) % 3]);
        HalfEdge { ends: [a.min(b), a.max(b)], facet: facet as u32, slot, forward: a < b }
    };
    let mut sides: Vec<_> =
        triangles.iter().enumerate().flat_map(|(f, t)| [0, 1, 2].map(|slot| side(f, t, slot))).collect();
    sides.sort_unstable_by_key(|s| (s.ends, s.facet, s.slot));
    sides
}

/// Winding number of the triangles around a point, from all solid angles: slower than a ray, but always reliable off
/// the surface (van Oosterom and Strackee 1983, equation 8).
pub(super) fn winding<'a>(
    vertices: &[Vector3<f64>],
    triangles: impl Iterator<Item = &'a [u32; 3]>,
    point: &Vector3<f64>,
) -> i64 {
    let half_angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| vertices[v as usize] - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        a.dot(&b.cross(&c)).atan2(la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb)
    };
    (triangles.map(half_angle).sum::<f64>() / (2.0 * PI)).round() as i64
}
