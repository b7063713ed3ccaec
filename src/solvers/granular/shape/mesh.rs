//! A surface of triangles: checked once; edges, corners and search tree are built once.

use super::check::{MeshError, check};
use super::topology::MeshSurface;
use super::tree::Tree;
use super::triangles::{MeshKind, area_vector, volume};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Triangles without faults. A facet keeps the number of its triangle. Sheets need not share vertices at their joints:
/// borders closer than a millionth of the largest coordinate count as joined.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Mesh {
    pub(super) kind: MeshKind,
    pub(super) vertices: Vec<Vector3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) surface: MeshSurface,
    pub(super) tree: Tree,
    /// The largest coordinate, m: the scale of rounding.
    pub(super) extent: f64,
}

/// A mesh in its stored form.
#[derive(Serialize, Deserialize)]
struct Parts {
    kind: MeshKind,
    vertices: Vec<Vector3<f64>>,
    triangles: Vec<[u32; 3]>,
}

impl From<Mesh> for Parts {
    fn from(mesh: Mesh) -> Self {
        Self { kind: mesh.kind, vertices: mesh.vertices, triangles: mesh.triangles }
    }
}

impl TryFrom<Parts> for Mesh {
    type Error = MeshError;

    fn try_from(parts: Parts) -> Result<Self, MeshError> {
        Mesh::new(parts.vertices, parts.triangles, parts.kind)
    }
}

impl Mesh {
    /// A mesh of vertices (m) and of triangles with three vertices each. Vertices at the same place become one, and
    /// unused vertices are left out. Fails with all faults at once.
    pub fn new(vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>, kind: MeshKind) -> Result<Self, MeshError> {
        let places = weld(&vertices);
        check(&vertices, &triangles, &places, kind)?;
        let mut number = vec![u32::MAX; vertices.len()];
        for corner in triangles.iter().flatten() {
            number[places[*corner as usize] as usize] = 0;
        }
        let mut used = Vec::new();
        for (vertex, number) in vertices.iter().zip(&mut number).filter(|(_, number)| **number == 0) {
            *number = used.len() as u32;
            used.push(*vertex);
        }
        let renumbered = triangles.iter().map(|t| t.map(|v| number[places[v as usize] as usize])).collect();
        Ok(Self::build(used, renumbered, kind))
    }

    /// A mesh from valid parts.
    fn build(vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>, kind: MeshKind) -> Self {
        let surface = MeshSurface::new(&vertices, &triangles);
        let tree = Tree::new(&vertices, &triangles);
        let extent = vertices.iter().fold(0.0, |m: f64, v| m.max(v.amax()));
        Self { kind, vertices, triangles, surface, tree, extent }
    }

    pub fn kind(&self) -> MeshKind {
        self.kind
    }

    /// Places of the corners, m.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Three vertices per facet.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The same triangles with the opposite orientation: a solid becomes a container and a container a solid.
    pub fn flipped(&self) -> Self {
        let kind = match self.kind {
            MeshKind::Solid => MeshKind::Container,
            MeshKind::Container => MeshKind::Solid,
            sheet => sheet,
        };
        let triangles = self.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        Self::build(self.vertices.clone(), triangles, kind)
    }

    /// Lowest and highest corner of the bounding box, m.
    pub fn bounds(&self) -> [Vector3<f64>; 2] {
        self.tree.bounds()
    }

    /// Area of the facets, m2; for a sheet, of one side.
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|t| area_vector(&self.vertices, t).norm()).sum()
    }

    /// Volume enclosed by the facets, m3: positive for a solid, negative for a container, without meaning for a sheet.
    pub fn volume(&self) -> f64 {
        volume(&self.vertices, self.triangles.iter())
    }
}

/// For every vertex, the first vertex at the same place.
fn weld(vertices: &[Vector3<f64>]) -> Vec<u32> {
    let mut first = HashMap::new();
    let place = |v: &Vector3<f64>| [v.x, v.y, v.z].map(|x| (x + 0.0).to_bits());
    vertices.iter().enumerate().map(|(i, v)| *first.entry(place(v)).or_insert(i as u32)).collect()
}
