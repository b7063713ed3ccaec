//! What is left of a soil at rest when only some of its nodes are asked: their flexibility, and its inverse.
//!
//! It stands in for a linear layer that is slow against its own vibrations (a layer of thickness H sounds at c/4H). It is exact at rest.

use super::error::SoilError;
use super::rest::Factor;
use super::soil::Soil;
use nalgebra::DMatrix;

/// The static response of some freedoms of a soil; all others are free of load.
#[derive(Debug, Clone, PartialEq)]
pub struct Condensed {
    /// Node and axis of each freedom.
    pub freedoms: Vec<(usize, usize)>,
    /// Displacement of each freedom per unit of force on each \[m/N\]; symmetric.
    pub flexibility: DMatrix<f64>,
}

impl Condensed {
    /// Forces that hold the freedoms per unit of displacement of each \[N/m\]; `None` where one of them is held already.
    pub fn stiffness(&self) -> Option<DMatrix<f64>> {
        self.flexibility.clone().cholesky().map(|factor| factor.inverse())
    }
}

impl Soil {
    /// Condenses the elastic soil onto some freedoms, node and axis each. Every one costs a solution with the factor.
    ///
    /// # Errors
    /// Nothing holds the soil, or the factor does not fit into memory.
    pub fn condensed(&self, freedoms: &[(usize, usize)]) -> Result<Condensed, SoilError> {
        let factor: Factor = self.factor(&[])?;
        let mut flexibility = DMatrix::zeros(freedoms.len(), freedoms.len());
        let mut force = vec![[0.0; 3]; self.masses().len()];
        for (column, &(node, axis)) in freedoms.iter().enumerate() {
            force[node][axis] = 1.0;
            let u = factor.solve(&force);
            force[node][axis] = 0.0;
            for (row, &(node, axis)) in freedoms.iter().enumerate() {
                flexibility[(row, column)] = u[node][axis];
            }
        }
        let symmetric = (&flexibility + flexibility.transpose()) * 0.5;
        Ok(Condensed { freedoms: freedoms.to_vec(), flexibility: symmetric })
    }
}
