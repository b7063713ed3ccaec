//! The stiffness of an element as a matrix, computed by the same code as its forces.

use super::kernel;
use super::lanes::{LANES, Lanes};
use super::shape::Shape;
use super::tensor::Corners;
use nalgebra::DMatrix;

/// Degrees of freedom of an element: three axes of the first corner, then of the second, and so on.
pub const FREEDOMS: usize = 24;

/// Forces that hold the corners of an element per unit of their displacements \[N/m\]; symmetric.
pub fn stiffness(shape: &Shape) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(FREEDOMS, FREEDOMS);
    for axis in 0..3 {
        // each lane moves a different corner
        let mut u: Corners = [[Lanes::ZERO; 8]; 3];
        (0..LANES).for_each(|l| u[axis][l].0[l] = 1.0);
        let mut force: Corners = [[Lanes::ZERO; 8]; 3];
        kernel::elastic(shape, &u, &mut force);
        for (moved, corner, along) in (0..LANES).flat_map(|m| (0..8).flat_map(move |c| (0..3).map(move |a| (m, c, a))))
        {
            matrix[(3 * corner + along, 3 * moved + axis)] = -force[along][corner].0[moved];
        }
    }
    // symmetric except for rounding
    (&matrix + matrix.transpose()) * 0.5
}

/// Largest squared frequency of a free element \[1/s²\]: no mesh of such elements has a larger one.
pub fn fastest(shape: &Shape) -> f64 {
    let root: Vec<f64> = shape.masses.iter().flat_map(|mass| [mass.sqrt().recip(); 3]).collect();
    let mut matrix = stiffness(shape);
    for i in 0..FREEDOMS {
        for j in 0..FREEDOMS {
            matrix[(i, j)] *= root[i] * root[j];
        }
    }
    matrix.symmetric_eigenvalues().max()
}
