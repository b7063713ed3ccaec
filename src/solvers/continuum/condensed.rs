//! A soil at rest reduced to some of its nodes: their flexibility, and its inverse.
//!
//! It replaces a linear layer if the loading is slow compared with the vibrations of the layer (a layer of thickness H
//! has the frequency c/4H). It is exact at rest.

use super::error::SoilError;
use super::rest::Factor;
use super::soil::Soil;
use nalgebra::DMatrix;

/// The static response of some degrees of freedom of a soil; all other degrees of freedom carry no load.
#[derive(Debug, Clone, PartialEq)]
pub struct Condensed {
    /// Node and axis of each degree of freedom.
    pub freedoms: Vec<(usize, usize)>,
    /// Displacement of each degree of freedom per unit force on each \[m/N\]; symmetric.
    pub flexibility: DMatrix<f64>,
}

impl Condensed {
    /// Forces that hold the degrees of freedom per unit displacement of each \[N/m\]; `None` if one of them is held
    /// already.
    pub fn stiffness(&self) -> Option<DMatrix<f64>> {
        self.flexibility.clone().cholesky().map(|factor| factor.inverse())
    }
}

impl Soil {
    /// Condenses the elastic soil to some degrees of freedom, given by node and axis. Each costs one solution with the
    /// factor.
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
