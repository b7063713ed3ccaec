//! States of rest: `K u = f` by a sparse factorisation. For soil that yields, the solution takes several steps with the
//! elastic stiffness (Newton's method with one matrix); a secant along each step gives its length.

use super::chunk::Answer;
use super::error::SoilError;
use super::shape::Shape;
use super::soil::Soil;
use super::step::pull;
use super::stiffness::{FREEDOMS, stiffness};
use crate::linalg::sparse::{Analysis, Cholesky, FactorError, SparseSymmetric};
use nalgebra::DMatrix;

/// Largest number of iterations of a search for the rest of yielding soil.
const ITERATIONS: usize = 400;

/// The factored stiffness of a soil with its supports.
#[derive(Debug, Clone)]
pub struct Factor {
    /// Unknown of each node and axis; `None` if it is held.
    unknowns: Vec<[Option<usize>; 3]>,
    order: usize,
    cholesky: Cholesky,
}

impl Factor {
    /// Replaces forces on the nodes by the displacements that they cause; held nodes have zero displacement.
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
    /// Finds the state of rest under gravity and the forces added so far, starting from the present state; the added
    /// forces are used up. Nodes may stand on springs to the ground \[N/m\]. Quiet faces are rollers during the search,
    /// and keep their reactions afterwards. Driven nodes stay at their present position.
    ///
    /// # Errors
    /// Nothing holds the soil, it yields without limit, or the factor does not fit into memory. The soil is then
    /// unchanged.
    pub fn rest(&mut self, springs: &[(usize, [f64; 3])]) -> Result<(), SoilError> {
        let before = self.nodes.displacement.clone();
        let found = self.seek_rest(springs);
        if found.is_err() {
            self.nodes.displacement = before;
        }
        found
    }

    fn seek_rest(&mut self, springs: &[(usize, [f64; 3])]) -> Result<(), SoilError> {
        let factor = self.factor(springs)?;
        let load = self.load();
        let largest = |forces: &[[f64; 3]], unknowns: &[[Option<usize>; 3]]| {
            let free =
                forces.iter().zip(unknowns).flat_map(|(force, unknowns)| (0..3).map(|i| (force[i], unknowns[i])));
            // a value that is not a number counts as larger than any number
            free.filter(|(_, unknown)| unknown.is_some())
                .fold(0.0, |size: f64, (f, _)| if f.abs() <= size { size } else { f.abs() })
        };
        let mut size = largest(&load, &factor.unknowns);
        let mut left = self.unbalanced(&load, springs);
        size = size.max(largest(&left, &factor.unknowns));
        let plastic = self.shapes.iter().any(|shape| shape.yields.is_some());
        let (most, fine) = if plastic { (ITERATIONS, 1e-7) } else { (2, 0.0) };
        for _ in 0..most {
            if largest(&left, &factor.unknowns) <= fine * size {
                break;
            }
            let way = factor.solve(&left);
            left = self.go(&load, springs, &way, &left, plastic);
        }
        let worst = largest(&left, &factor.unknowns) / size.max(f64::MIN_POSITIVE);
        // written so that a value that is not a number fails; for a soil held only by rounding the balance fails
        match worst <= 1e-6 {
            true => {}
            false if plastic => return Err(SoilError::NoRest { iterations: most, left: worst }),
            false => return Err(SoilError::NotHeld),
        }
        pull(&mut self.chunks, &self.shapes, &self.nodes.displacement, Answer::Remembered);
        self.settle(&left);
        Ok(())
    }

    /// Moves along a direction to the point at which the force along it is zero by a secant, and returns the unbalanced
    /// forces there.
    fn go(
        &mut self,
        load: &[[f64; 3]],
        springs: &[(usize, [f64; 3])],
        way: &[[f64; 3]],
        left: &[[f64; 3]],
        search: bool,
    ) -> Vec<[f64; 3]> {
        let along =
            |left: &[[f64; 3]]| left.iter().flatten().zip(way.iter().flatten()).map(|(f, w)| f * w).sum::<f64>();
        let forward = |soil: &mut Soil, part: f64| {
            for (u, way) in soil.nodes.displacement.iter_mut().zip(way) {
                (0..3).for_each(|axis| u[axis] += part * way[axis]);
            }
        };
        forward(self, 1.0);
        let after = self.unbalanced(load, springs);
        if !search {
            return after;
        }
        let (from, to) = (along(left), along(&after));
        let part = if from > to { (from / (from - to)).clamp(0.2, 8.0) } else { 1.0 };
        if (part - 1.0).abs() < 0.05 {
            return after;
        }
        forward(self, part - 1.0);
        self.unbalanced(load, springs)
    }

    /// Ends a search for rest: stores the reactions of quiet faces, clears the added forces, sets velocities to zero.
    fn settle(&mut self, left: &[[f64; 3]]) {
        let nodes = &mut self.nodes;
        for (node, left) in left.iter().enumerate() {
            for (axis, left) in left.iter().enumerate() {
                let quiet = nodes.quiet[node][axis] && !nodes.held[node][axis];
                if let Some(borne) = nodes.borne.get_mut(node) {
                    borne[axis] = if quiet { -left } else { 0.0 };
                }
            }
        }
        self.nodes.velocity.fill([0.0; 3]);
        self.nodes.clear_forces();
        self.clock.last = 0.0;
    }

    /// Factors the elastic stiffness of the soil with its supports and springs to the ground.
    ///
    /// # Errors
    /// Nothing holds the soil, or the factor does not fit into memory.
    pub fn factor(&self, springs: &[(usize, [f64; 3])]) -> Result<Factor, SoilError> {
        let (mut order, mut unknowns) = (0, vec![[None; 3]; self.nodes.mass.len()]);
        for (node, unknowns) in unknowns.iter_mut().enumerate() {
            for (axis, unknown) in unknowns.iter_mut().enumerate() {
                if !self.nodes.held[node][axis] && !self.nodes.quiet[node][axis] {
                    *unknown = Some(order);
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

    /// Weight of each node and forces of the caller on it \[N\].
    fn load(&self) -> Vec<[f64; 3]> {
        let gravity = self.settings.gravity;
        let loads = self.nodes.mass.iter().zip(self.nodes.externals());
        loads.map(|(mass, external)| [0, 1, 2].map(|axis| mass * gravity[axis] + external[axis])).collect()
    }

    /// Unbalanced part of a load at the present displacements \[N\].
    fn unbalanced(&mut self, load: &[[f64; 3]], springs: &[(usize, [f64; 3])]) -> Vec<[f64; 3]> {
        pull(&mut self.chunks, &self.shapes, &self.nodes.displacement, Answer::Tried);
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
