//! Equal elements share their shape: most elements of a grid have one of a few shapes.

use super::error::SoilError;
use super::mesh::Mesh;
use super::shape::{Formulation, Shape};
use std::collections::HashMap;

/// Edges that differ by less than this share of their size are equal, because grid lines are rounded.
const ALIKE: f64 = 1e-11;

/// The shapes of a mesh, and the shape of each element.
pub fn shapes(mesh: &Mesh, formulation: Formulation) -> Result<(Vec<Shape>, Vec<u32>), SoilError> {
    let mut known: HashMap<(u32, Vec<i64>), u32> = HashMap::new();
    let (mut shapes, mut kinds) = (Vec::new(), Vec::with_capacity(mesh.elements().len()));
    for (number, element) in mesh.elements().iter().enumerate() {
        let corners = mesh.corners(number);
        let edges = corners.map(|corner| [0, 1, 2].map(|axis| corner[axis] - corners[0][axis]));
        // a power of two near the size, so that elements that differ by rounding have the same
        let size = edges.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()));
        let unit = ALIKE * size.log2().round().exp2();
        let key = edges.iter().flatten().map(|x| (x / unit).round() as i64).collect();
        let kind = match known.entry((element.material, key)) {
            std::collections::hash_map::Entry::Occupied(entry) => *entry.get(),
            std::collections::hash_map::Entry::Vacant(entry) => {
                let material = &mesh.materials()[element.material as usize];
                let shape = Shape::new(&corners, material, formulation);
                shapes.push(shape.map_err(|volume| SoilError::Turned { element: number, volume })?);
                *entry.insert(shapes.len() as u32 - 1)
            }
        };
        kinds.push(kind);
    }
    Ok((shapes, kinds))
}
