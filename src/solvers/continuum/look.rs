//! Stresses of elements, for those who look.

use super::kernel::{mean_strain, stress};
use super::lanes::Lanes;
use super::shape::Corners;
use super::soil::Soil;

impl Soil {
    /// Mean stress of an element \[Pa\], tension positive: xx, yy, zz, xy, yz, zx.
    pub fn stress(&self, element: usize) -> [f64; 6] {
        let mut u: Corners = [[Lanes::ZERO; 8]; 3];
        for (corner, &node) in self.mesh.elements()[element].nodes.iter().enumerate() {
            (0..3).for_each(|axis| u[axis][corner].0[0] = self.nodes.displacement[node as usize][axis]);
        }
        let shape = &self.shapes[self.kinds[element] as usize];
        stress(shape, &mean_strain(shape, &u)).map(|component| component.0[0])
    }
}
