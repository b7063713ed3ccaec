//! States of rest: `K u = f` by a sparse factorisation.

use super::error::SoilError;
use super::shape::Shape;
use super::soil::Soil;
use super::step::pull;
use super::stiffness::{FREEDOMS, stiffness};
use crate::linalg::sparse::{Analysis, Cholesky, FactorError, SparseSymmetric};
use nalgebra::DMatrix;

/// The factored stiffness of a soil with its supports.
#[derive(Debug, Clone)]
pub struct Factor {
    /// Unknown of each node and axis; `None` where it is held.
    unknowns: Vec<[Option<usize>; 3]>,
    order: usize,
    cholesky: Cholesky,
}

impl Factor {
    /// Replaces forces on the nodes by the displacements that they cause, zero where the soil is held.
    pub fn solve(&self, forces: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut side = vec![0.0; self.order];
        for (unknowns, force) in self.unknowns.iter().zip(forces) {
            for axis in 0..3 {
                if let Some(unknown) = unknowns[axis] {
                    side[unknown] = force[axis];
                }
            }
        }
        self.cholesky.solve_in_place(&mut side, self.order);
        self.unknowns.iter().map(|unknowns| unknowns.map(|unknown| unknown.map_or(0.0, |at| side[at]))).collect()
    }
}

impl Soil {
    /// Puts the soil at rest under gravity and the forces added so far, which are spent by it; nodes may stand on springs to the
    /// ground \[N/m\]. Quiet faces are rollers meanwhile, and go on bearing what they bore then. Driven nodes stand still where they are.
    ///
    /// # Errors
    /// Nothing holds the soil, or the factor does not fit into memory.
    pub fn rest(&mut self, springs: &[(usize, [f64; 3])]) -> Result<(), SoilError> {
        let factor = self.factor(springs)?;
        let load = self.load();
        for node in 0..load.len() {
            // what is held keeps its place
            for axis in 0..3 {
                if factor.unknowns[node][axis].is_some() {
                    self.nodes.displacement[node][axis] = 0.0;
                }
            }
        }
        let largest = |forces: &[[f64; 3]]| forces.iter().flatten().fold(0.0, |size: f64, f| size.max(f.abs()));
        let mut size = largest(&load);
        // the second time mends what rounding left
        for _ in 0..2 {
            let left = self.unbalanced(&load, springs);
            size = size.max(largest(&left));
            let step = factor.solve(&left);
            for (u, step) in self.nodes.displacement.iter_mut().zip(&step) {
                (0..3).for_each(|axis| u[axis] += step[axis]);
            }
        }
        let left = self.unbalanced(&load, springs);
        let mut worst = 0.0f64;
        for (unknowns, left) in factor.unknowns.iter().zip(&left) {
            worst =
                (0..3).filter(|&axis| unknowns[axis].is_some()).fold(worst, |worst, axis| worst.max(left[axis].abs()));
        }
        // written so that what is no number fails; a soil that is free but for rounding balances nothing
        if !(worst <= 1e-6 * size) {
            return Err(SoilError::NotHeld);
        }
        self.settle(&left);
        Ok(())
    }

    /// Ends a search for rest: what quiet faces bear is kept, forces are spent, nothing moves.
    fn settle(&mut self, left: &[[f64; 3]]) {
        for node in 0..left.len() {
            for axis in 0..3 {
                let quiet = self.nodes.quiet[node][axis] && self.nodes.driven[node][axis].is_none();
                self.nodes.borne[node][axis] = if quiet { -left[node][axis] } else { 0.0 };
                self.nodes.position[node][axis] = self.mesh.nodes()[node][axis] + self.nodes.displacement[node][axis];
            }
        }
        self.nodes.velocity.fill([0.0; 3]);
        self.nodes.external.fill([0.0; 3]);
        self.clock.last = 0.0;
    }

    /// Factors the elastic stiffness of the soil with its supports and springs to the ground.
    ///
    /// # Errors
    /// Nothing holds the soil, or the factor does not fit into memory.
    pub fn factor(&self, springs: &[(usize, [f64; 3])]) -> Result<Factor, SoilError> {
        let (mut order, mut unknowns) = (0, vec![[None; 3]; self.nodes.mass.len()]);
        for node in 0..unknowns.len() {
            for axis in 0..3 {
                if self.nodes.driven[node][axis].is_none() && !self.nodes.quiet[node][axis] {
                    unknowns[node][axis] = Some(order);
                    order += 1;
                }
            }
        }
        let places: Vec<[Option<usize>; FREEDOMS]> = self
            .mesh
            .elements()
            .iter()
            .map(|element| std::array::from_fn(|i| unknowns[element.nodes[i / 3] as usize][i % 3]))
            .collect();
        let groups: Vec<Vec<usize>> = places.iter().map(|places| places.iter().flatten().copied().collect()).collect();
        let mut matrix = SparseSymmetric::from_groups(order, &groups);
        let mut known: Vec<Option<DMatrix<f64>>> = vec![None; self.shapes.len()];
        for (places, &kind) in places.iter().zip(&self.kinds) {
            let shape: &Shape = &self.shapes[kind as usize];
            let element = known[kind as usize].get_or_insert_with(|| stiffness(shape));
            for (i, j) in (0..FREEDOMS).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                if let (Some(row), Some(column)) = (places[i], places[j]) {
                    matrix.add(row, column, element[(i, j)]);
                }
            }
        }
        for &(node, stiffness) in springs {
            for axis in 0..3 {
                if let Some(unknown) = unknowns[node][axis] {
                    matrix.add(unknown, unknown, stiffness[axis]);
                }
            }
        }
        let told = |error| match error {
            FactorError::NotDefinite => SoilError::NotHeld,
            FactorError::TooLarge => SoilError::TooLarge { unknowns: order },
        };
        let analysis: Analysis = matrix.analyse().map_err(told)?;
        let cholesky = matrix.factor(&analysis).map_err(told)?;
        Ok(Factor { unknowns, order, cholesky })
    }

    /// Weight and the forces of the caller on each node \[N\].
    fn load(&self) -> Vec<[f64; 3]> {
        let gravity = self.settings.gravity;
        let loads = self.nodes.mass.iter().zip(&self.nodes.external);
        loads.map(|(mass, external)| [0, 1, 2].map(|axis| mass * gravity[axis] + external[axis])).collect()
    }

    /// What is left of a load at the present displacements \[N\].
    fn unbalanced(&mut self, load: &[[f64; 3]], springs: &[(usize, [f64; 3])]) -> Vec<[f64; 3]> {
        pull(&mut self.chunks, &self.shapes, &self.nodes.displacement);
        let mut left: Vec<[f64; 3]> = (0..load.len())
            .map(|node| {
                let pull = self.nodes.pull(&self.chunks, node);
                [0, 1, 2].map(|axis| load[node][axis] + pull[axis])
            })
            .collect();
        for &(node, stiffness) in springs {
            (0..3).for_each(|axis| left[node][axis] -= stiffness[axis] * self.nodes.displacement[node][axis]);
        }
        left
    }
}
