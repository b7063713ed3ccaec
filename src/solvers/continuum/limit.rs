//! The longest stable step.
//!
//! The leapfrog is stable below 2/ω of the fastest vibration. No vibration of a mesh is faster than the fastest
//! vibration of its single elements (Fried 1972), which bounds ω from above. Lanczos iterations on the mesh with its
//! supports give ω itself, from below.

use super::chunk::Answer;
use super::error::SoilError;
use super::soil::Soil;
use super::step::pull;

/// Factor on the frequency by Lanczos, because the iteration approaches it from below.
const MARGIN: f64 = 1.01;

impl Soil {
    /// The longest allowed step \[s\]: the bound by elements, or the measured limit less one per cent if it has been
    /// [measured](Soil::measure_limit).
    pub fn limit(&self) -> f64 {
        let bound = self.rates.iter().fold(0.0, |fastest: f64, &rate| fastest.max(rate));
        self.step_of(self.measured.map_or(bound, |measured| measured.min(bound)))
    }

    /// The same with springs at nodes, for example contacts of grains: number of the node and stiffness \[N/m\].
    /// Springs of one node add up.
    pub fn limit_with(&self, springs: &[(usize, f64)]) -> f64 {
        let mut extra = vec![0.0; self.rates.len()];
        for &(node, stiffness) in springs {
            extra[node] += stiffness / self.nodes.mass[node];
        }
        let largest = |rates: &mut dyn Iterator<Item = f64>| rates.fold(0.0, f64::max);
        let bound = largest(&mut self.rates.iter().zip(&extra).map(|(rate, extra)| rate + extra));
        let added = largest(&mut extra.iter().copied());
        self.step_of(self.measured.map_or(bound, |measured| bound.min(measured + added)))
    }

    /// Measures the limit of this mesh with its supports by Lanczos iterations, as elastic soil, and allows steps up to
    /// 0.99 of the limit, which it returns \[s\]. For a block of cubes the limit is a quarter above the bound by
    /// elements, because its elements cannot all vibrate freely at once. Releasing nodes later discards the
    /// measurement.
    ///
    /// # Errors
    /// Zero iterations, or no free node.
    pub fn measure_limit(&mut self, iterations: usize) -> Result<f64, SoilError> {
        super::error::within("the number of iterations", iterations as f64, iterations > 0, "a number above 0")?;
        self.measured = Some(self.lanczos(iterations)? * MARGIN * MARGIN);
        Ok(self.limit())
    }

    /// Largest squared frequency \[1/s²\] by Lanczos, from a start vector with a part of every vibration.
    pub(super) fn lanczos(&self, iterations: usize) -> Result<f64, SoilError> {
        let free = |node: usize, axis: usize| !self.nodes.held[node][axis];
        let mut chunks = self.chunks.clone();
        let root: Vec<f64> = self.nodes.mass.iter().map(|mass| mass.sqrt()).collect();
        let mut now = vec![[0.0; 3]; root.len()];
        let mut random = 1u64;
        for (node, axis) in (0..root.len()).flat_map(|node| (0..3).map(move |axis| (node, axis))) {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            now[node][axis] = if free(node, axis) { (random >> 33) as f64 / 2f64.powi(31) - 0.5 } else { 0.0 };
        }
        let dot = |a: &[[f64; 3]], b: &[[f64; 3]]| {
            a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum::<f64>()
        };
        let scale = |a: &mut [[f64; 3]], factor: f64| a.iter_mut().flatten().for_each(|x| *x *= factor);
        let size = dot(&now, &now).sqrt();
        if size == 0.0 {
            return Err(SoilError::Value {
                what: "the number of free nodes",
                value: 0.0,
                expected: "a number above 0",
            });
        }
        scale(&mut now, 1.0 / size);
        let mut before = vec![[0.0; 3]; root.len()];
        let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        for _ in 0..iterations {
            let moved: Vec<[f64; 3]> = now.iter().zip(&root).map(|(x, root)| x.map(|x| x / root)).collect();
            pull(&mut chunks, &self.shapes, &moved, Answer::Linear);
            let last = beside.last().copied().unwrap_or(0.0);
            let mut next: Vec<[f64; 3]> = (0..root.len()).map(|node| {
                let force = self.nodes.pull(&chunks, node);
                [0, 1, 2].map(|axis| if free(node, axis) { -force[axis] / root[node] } else { 0.0 } - last * before[node][axis])
            }).collect();
            let along = dot(&next, &now);
            next.iter_mut().flatten().zip(now.iter().flatten()).for_each(|(next, now)| *next -= along * now);
            diagonal.push(along);
            let size = dot(&next, &next).sqrt();
            if size <= 1e-12 * along.abs() {
                break;
            }
            scale(&mut next, 1.0 / size);
            beside.push(size);
            before = std::mem::replace(&mut now, next);
        }
        let order = diagonal.len();
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => beside[i.min(j)],
            _ => 0.0,
        };
        Ok(nalgebra::DMatrix::from_fn(order, order, entry).symmetric_eigenvalues().max())
    }

    /// 2/ω, or less if stiffness damping lags by half a step, or if local damping increases the forces that reverse a
    /// node.
    fn step_of(&self, rate: f64) -> f64 {
        let frequency = (rate * (1.0 + self.settings.damping.local)).sqrt();
        let ratio = 0.5 * self.settings.damping.stiffness * frequency;
        2.0 / (frequency * (ratio + (1.0 + ratio * ratio).sqrt()))
    }
}
