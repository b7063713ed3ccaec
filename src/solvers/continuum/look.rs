//! Stresses of elements and forces of supports.

use super::chunk::ELEMENTS;
use super::flow::Memory;
use super::kernel::elastic;
use super::lanes::Lanes;
use super::soil::Soil;
use super::tensor::{COMPONENT, Corners};

impl Soil {
    /// Mean stress of an element \[Pa\] at the present displacements, tension positive: xx, yy, zz, xy, yz, zx.
    pub fn stress(&self, element: usize) -> [f64; 6] {
        let mut u: Corners = [[Lanes::ZERO; 8]; 3];
        for (corner, &node) in self.mesh.elements()[element].nodes.iter().enumerate() {
            (0..3).for_each(|axis| u[axis][corner].0[0] = self.nodes.displacement[node as usize][axis]);
        }
        let shape = &self.shapes[self.kinds[element] as usize];
        let mut force: Corners = [[Lanes::ZERO; 8]; 3];
        match (&shape.yields, self.chunks[element / ELEMENTS].memory(element)) {
            (Some(yields), Some((memory, lane))) => {
                let mut memory: Memory = memory.clone();
                u.iter_mut().flatten().for_each(|values| values.0[lane] = values.0[0]);
                memory.pull(shape, yields, &u, &mut force);
                memory.mean_stress(shape).map(|component| component.0[lane])
            }
            _ => {
                elastic(shape, &u, &mut force);
                let corners = self.mesh.corners(element);
                mean_stress(&force, &corners, shape.volume)
            }
        }
    }

    /// The force of the elements on a node at the displacements of the last step \[N\]. At a held node at rest, the
    /// reaction of the support is the opposite force minus gravity and the forces of the caller.
    pub fn internal_force(&self, node: usize) -> [f64; 3] {
        self.nodes.pull(&self.chunks, node)
    }
}

/// Mean stress of a body from its forces on its corners: `σ = -Σ f x / V`.
fn mean_stress(force: &Corners, corners: &[[f64; 3]; 8], volume: f64) -> [f64; 6] {
    let mut stress = [0.0; 6];
    for (i, j) in (0..3).flat_map(|i| (0..=i).map(move |j| (i, j))) {
        let sum = |i: usize, j: usize| (0..8).map(|c| force[i][c].0[0] * (corners[c][j] - corners[0][j])).sum::<f64>();
        stress[COMPONENT[i][j]] = -0.5 * (sum(i, j) + sum(j, i)) / volume;
    }
    stress
}
