//! Distance of a point from a mesh, and the nearest point of the mesh.

use super::mesh::Mesh;
use super::topology::Facet;
use nalgebra::Vector3;
use std::cell::Cell;

/// The point of a mesh that is nearest to a given point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// m.
    pub at: Vector3<f64>,
    pub facet: u32,
    /// m.
    pub distance: f64,
}

impl Mesh {
    /// The nearest point of the surface within `within` (m) of the point; `None` if there is none.
    pub fn nearest(&self, point: &Vector3<f64>, within: f64) -> Option<Nearest> {
        let square = Cell::new(within * within);
        let mut nearest = None;
        let enter = |low: &Vector3<f64>, high: &Vector3<f64>| {
            let outside = (low - point).sup(&(point - high)).sup(&Vector3::zeros());
            outside.norm_squared() < square.get()
        };
        self.tree.search(enter, |facet| {
            let at = nearest_place(&self.surface.facets[facet as usize], point);
            let found = (at - point).norm_squared();
            if found < square.get() {
                square.set(found);
                nearest = Some(Nearest { at, facet, distance: found.sqrt() });
            }
        });
        nearest
    }

    /// Unit normal of a facet, out of the solid.
    pub fn normal(&self, facet: u32) -> Vector3<f64> {
        self.surface.facets[facet as usize].normal
    }
}

fn nearest_place(facet: &Facet, point: &Vector3<f64>) -> Vector3<f64> {
    let from_edge = |k: usize| facet.inward[k].dot(&(point - facet.places[k]));
    if (0..3).all(|k| from_edge(k) >= 0.0) {
        return point - facet.normal * facet.normal.dot(&(point - facet.places[0]));
    }
    let on_edge = |k: usize| {
        let (start, along) = (facet.places[k], facet.places[(k + 1) % 3] - facet.places[k]);
        start + along * ((point - start).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
    };
    // the nearest point lies on an edge that faces the point
    let mut best = (f64::INFINITY, facet.places[0]);
    for k in (0..3).filter(|k| from_edge(*k) < 0.0) {
        let at = on_edge(k);
        let square = (at - point).norm_squared();
        if square < best.0 {
            best = (square, at);
        }
    }
    best.1
}
