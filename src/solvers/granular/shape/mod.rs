//! Surfaces that a sphere can touch, each in the frame of its wall: a plane, a block, a mesh of triangles. Lengths in
//! m.
//!
//! A contact is a local minimum of the distance from the centre of the sphere to the surface. So a face is touched if
//! the centre projects into it, an edge if no adjacent face is closer, a corner if no adjacent edge or face is closer.
//! Two faces of a valley give two contacts; a flat face gives one contact, for any division into triangles.

mod block;
mod check;
mod contact;
mod distance;
mod generate;
mod history;
mod inside;
mod mesh;
mod plane;
mod topology;
mod touch;
mod tree;
mod triangles;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::fmt;

pub use check::{FaultKind, MeshError, MeshFault, Place};
pub use distance::Nearest;
pub use history::inherit;
pub use mesh::Mesh;
pub use touch::Touch;
pub use triangles::MeshKind;

#[cfg(test)]
mod tests;

/// The surface of a wall in the frame of the wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// A plane through the origin; the solid lies behind its unit normal.
    Plane { normal: Vector3<f64> },
    /// A solid block round the origin with half lengths (m) along the axes.
    Block { half: Vector3<f64> },
    /// Triangles: a solid, a container, or an open sheet.
    Mesh(Mesh),
}

/// Invalid numbers for a plane or a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShapeError {
    /// The normal of a plane has no direction, or is not a unit vector although one is required.
    Normal { normal: Vector3<f64> },
    /// A half length (m) of a block is not a positive number.
    HalfLength { half: Vector3<f64> },
}

impl Shape {
    /// The plane with a normal of any length.
    pub fn plane(normal: Vector3<f64>) -> Result<Self, ShapeError> {
        // divided by the largest component first, so that large and small vectors stay in the range of numbers
        let scaled = normal / normal.amax();
        let shape = Shape::Plane { normal: scaled / scaled.norm() };
        shape.check().map(|()| shape).map_err(|_| ShapeError::Normal { normal })
    }

    /// The block with these half lengths (m).
    pub fn block(half: Vector3<f64>) -> Result<Self, ShapeError> {
        let shape = Shape::Block { half };
        shape.check().map(|()| shape)
    }

    /// Whether the numbers describe a shape; a mesh was checked when it was made.
    pub fn check(&self) -> Result<(), ShapeError> {
        match self {
            Shape::Plane { normal } => {
                let unit = (normal.norm() - 1.0).abs() <= 1e-12;
                if unit { Ok(()) } else { Err(ShapeError::Normal { normal: *normal }) }
            }
            Shape::Block { half } => {
                let solid = half.iter().all(|h| *h > 0.0 && h.is_finite());
                if solid { Ok(()) } else { Err(ShapeError::HalfLength { half: *half }) }
            }
            Shape::Mesh(_) => Ok(()),
        }
    }

    /// Finds every distinct contact of a sphere of radius `reach` (m) with this centre. The contacts go into `out`,
    /// which is emptied first: nearest first, in an order that does not depend on the order of `facets`.
    ///
    /// For a mesh, `facets` must contain all facets that `near` finds with this reach, and may contain more; a plane
    /// and a block need none. A centre inside the solid gets one contact, towards the outside: at any depth for a plane
    /// or a block, up to a depth of `reach` for a mesh or a one-sided sheet.
    pub fn touches(&self, centre: &Vector3<f64>, reach: f64, facets: &[u32], out: &mut Vec<Touch>) {
        out.clear();
        match self {
            Shape::Plane { normal } => out.extend(plane::touch(normal, centre, reach)),
            Shape::Block { half } => out.extend(block::touch(half, centre, reach)),
            Shape::Mesh(mesh) => mesh.touches(centre, reach, facets, out),
        }
    }

    /// Whether the surface comes within `reach` (m) of the centre, or the centre lies behind a plane or in a block. For
    /// a mesh, `facets` then contains the facets within reach; it is emptied first.
    pub fn near(&self, centre: &Vector3<f64>, reach: f64, facets: &mut Vec<u32>) -> bool {
        facets.clear();
        match self {
            Shape::Plane { normal } => plane::touch(normal, centre, reach).is_some(),
            Shape::Block { half } => block::touch(half, centre, reach).is_some(),
            Shape::Mesh(mesh) => mesh.near(centre, reach, facets),
        }
    }

    /// Whether a point lies inside the solid: behind a plane, in a block or a closed mesh, outside the cavity of a
    /// container. No point lies inside a sheet.
    pub fn contains(&self, point: &Vector3<f64>) -> bool {
        match self {
            Shape::Plane { normal } => normal.dot(point) < 0.0,
            Shape::Block { half } => block::contains(half, point),
            Shape::Mesh(mesh) => mesh.contains(point),
        }
    }

    /// Lowest and highest corner of the bounding box of the surface, m; `None` for a plane, which is infinite.
    pub fn bounds(&self) -> Option<[Vector3<f64>; 2]> {
        match self {
            Shape::Plane { .. } => None,
            Shape::Block { half } => Some([-half, *half]),
            Shape::Mesh(mesh) => Some(mesh.bounds()),
        }
    }

    /// Area of the surface, m2; for a sheet, of one side; infinite for a plane.
    pub fn area(&self) -> f64 {
        match self {
            Shape::Plane { .. } => f64::INFINITY,
            Shape::Block { half } => 8.0 * (half.x * half.y + half.y * half.z + half.z * half.x),
            Shape::Mesh(mesh) => mesh.area(),
        }
    }
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ShapeError::Normal { normal: n } => {
                write!(f, "expected a unit vector as the normal of a plane, found ({}, {}, {})", n.x, n.y, n.z)
            }
            ShapeError::HalfLength { half: h } => {
                write!(f, "expected half lengths of a block above 0 m, found ({}, {}, {})", h.x, h.y, h.z)
            }
        }
    }
}

impl std::error::Error for ShapeError {}
