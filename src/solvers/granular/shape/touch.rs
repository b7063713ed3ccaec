//! The contact point of a sphere with a surface.

use nalgebra::Vector3;

/// One contact of a sphere with a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Unit, from the surface to the centre of the sphere; out of the solid if the centre lies inside it.
    pub normal: Vector3<f64>,
    /// From the surface to the centre along the normal, m; negative if the centre lies behind the surface. A sphere of
    /// radius r overlaps by r - distance.
    pub distance: f64,
    /// The face, edge or corner that is touched: always the same number for the same part of the same shape.
    pub feature: u32,
}
