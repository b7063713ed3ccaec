//! The two overlays of five tetrahedra of a hexahedron (mixed discretisation).
//!
//! Each overlay has a tetrahedron at four corners that share no edge, and one in the middle. The volumetric part of the
//! strain is averaged over an overlay by volume, the deviatoric part stays with each tetrahedron; forces are the mean
//! of both overlays.

/// Corners of the tetrahedra, overlay by overlay; positive volume.
pub(super) const TETRAHEDRA: [[usize; 4]; 10] = [
    [0, 1, 3, 4],
    [2, 3, 1, 6],
    [5, 4, 6, 1],
    [7, 6, 4, 3],
    [1, 6, 3, 4],
    [1, 2, 0, 5],
    [3, 0, 2, 7],
    [4, 7, 5, 0],
    [6, 5, 7, 2],
    [0, 5, 2, 7],
];

/// Gradients and volumes of the ten tetrahedra of a hexahedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Tetrahedra {
    /// Tetrahedron, axis, corner of the tetrahedron \[1/m\].
    pub gradients: [[[f64; 4]; 3]; 10],
    /// \[m³\]
    pub volumes: [f64; 10],
}

impl Tetrahedra {
    /// The tetrahedra between eight corners \[m\]; the error is the volume of a tetrahedron that is turned inside out.
    pub fn new(corners: &[[f64; 3]; 8]) -> Result<Tetrahedra, f64> {
        let mut made = Tetrahedra { gradients: [[[0.0; 4]; 3]; 10], volumes: [0.0; 10] };
        for (at, tetrahedron) in TETRAHEDRA.iter().enumerate() {
            let [origin, ends @ ..] = tetrahedron.map(|corner| corners[corner]);
            let edges = ends.map(|end| [end[0] - origin[0], end[1] - origin[1], end[2] - origin[2]]);
            let normals = [cross(edges[1], edges[2]), cross(edges[2], edges[0]), cross(edges[0], edges[1])];
            let sixfold: f64 = (0..3).map(|axis| edges[0][axis] * normals[0][axis]).sum();
            if sixfold.is_nan() || sixfold <= 0.0 {
                return Err(sixfold / 6.0);
            }
            made.volumes[at] = sixfold / 6.0;
            for axis in 0..3 {
                let slopes = normals.map(|normal| normal[axis] / sixfold);
                made.gradients[at][axis] = [-(slopes[0] + slopes[1] + slopes[2]), slopes[0], slopes[1], slopes[2]];
            }
        }
        Ok(made)
    }
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
