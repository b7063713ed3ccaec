//! Meshes of simple solids around the origin.

use super::check::{FaultKind, MeshError};
use super::mesh::Mesh;
use super::triangles::MeshKind;
use nalgebra::Vector3;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Largest number of subdivisions; it gives a sphere of five million facets.
const MOST_SUBDIVISIONS: u32 = 9;

impl Mesh {
    /// The twelve triangles of a block with half lengths (m) along the axes.
    pub fn block(half: Vector3<f64>) -> Result<Self, MeshError> {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let vertices = (0..8).map(|i| half.component_mul(&Vector3::new(sign(i, 0), sign(i, 1), sign(i, 2)))).collect();
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Self::new(vertices, triangles, MeshKind::Solid)
    }

    /// A sphere (radius in m) whose vertices lie on it: an icosahedron whose triangles are split into four
    /// `subdivisions` times.
    pub fn sphere(radius: f64, subdivisions: u32) -> Result<Self, MeshError> {
        if subdivisions > MOST_SUBDIVISIONS {
            return Err(MeshError::single(FaultKind::TooMany));
        }
        let g = (1.0 + 5.0f64.sqrt()) / 2.0;
        let mut vertices: Vec<Vector3<f64>> = Vec::new();
        for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
            vertices.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(|v| Vector3::from(v).normalize()));
        }
        let mut triangles = icosahedron(&vertices);
        for _ in 0..subdivisions {
            triangles = split(&mut vertices, &triangles);
        }
        Self::new(vertices.iter().map(|v| v * radius).collect(), triangles, MeshKind::Solid)
    }

    /// A cylinder along z (radius and height in m) over a polygon of `sides` corners on its circle.
    pub fn cylinder(radius: f64, height: f64, sides: u32) -> Result<Self, MeshError> {
        if sides > 20 << (2 * MOST_SUBDIVISIONS) {
            return Err(MeshError::single(FaultKind::TooMany));
        }
        let half = height / 2.0;
        let mut vertices = vec![Vector3::new(0.0, 0.0, -half), Vector3::new(0.0, 0.0, half)];
        let mut triangles = Vec::new();
        for i in 0..sides {
            let angle = TAU * f64::from(i) / f64::from(sides);
            let (x, y) = (radius * angle.cos(), radius * angle.sin());
            vertices.extend([Vector3::new(x, y, -half), Vector3::new(x, y, half)]);
            let (low, next) = (2 + 2 * i, 2 + 2 * ((i + 1) % sides));
            triangles.extend([[0, next, low], [1, low + 1, next + 1], [low, next, next + 1], [low, next + 1, low + 1]]);
        }
        Self::new(vertices, triangles, MeshKind::Solid)
    }
}

/// Triples of neighbours, with normals outward.
fn icosahedron(vertices: &[Vector3<f64>]) -> Vec<[u32; 3]> {
    // neighbours are at an angle of 63 degrees, all other pairs above 116
    let near = |a: u32, b: u32| vertices[a as usize].dot(&vertices[b as usize]) > 0.0;
    let mut triangles = Vec::new();
    for (a, b, c) in (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c)))) {
        if near(a, b) && near(b, c) && near(c, a) {
            let [p, q, r] = [a, b, c].map(|v| vertices[v as usize]);
            triangles.push(if p.dot(&q.cross(&r)) > 0.0 { [a, b, c] } else { [a, c, b] });
        }
    }
    triangles
}

/// Splits each triangle into four; the new corners lie on the unit sphere.
fn split(vertices: &mut Vec<Vector3<f64>>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
            vertices.len() as u32 - 1
        })
    };
    let four = |&[a, b, c]: &[u32; 3]| {
        let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
        [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
    };
    triangles.iter().flat_map(four).collect()
}
