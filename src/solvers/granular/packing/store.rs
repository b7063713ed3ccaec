//! A finished bed as data.

use super::super::bed::Bed;
use super::super::checkpoint::{Checkpoint, RestoreError};
use super::super::grains::Sample;
use super::super::lanes::Real;
use super::describe::Stage;
use super::packed::Packed;
use super::press::LAST;
use serde::{Deserialize, Serialize};

/// The content of [`Packed`], for storage. A restored bed continues bit by bit like the stored bed.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
pub struct StoredBed<R: Real> {
    bed: Checkpoint<R>,
    plan: [f64; 2],
    densities: Vec<f64>,
    bodies: Vec<u32>,
    samples: Vec<Sample>,
    levels: Vec<f64>,
    stages: Vec<Stage>,
}

impl<R: Real> Packed<R> {
    pub fn store(&self) -> StoredBed<R> {
        StoredBed {
            bed: self.bed.checkpoint(),
            plan: self.plan,
            densities: self.densities.clone(),
            bodies: self.bodies.clone(),
            samples: self.samples.clone(),
            levels: self.levels.clone(),
            stages: self.stages.clone(),
        }
    }

    /// Restores a stored bed. Fails if the data are damaged: the lists must match the layers and stages.
    pub fn restore(stored: StoredBed<R>) -> Result<Packed<R>, RestoreError> {
        let StoredBed { bed, plan, densities, bodies, samples, levels, stages } = stored;
        let packed = Packed { bed: Bed::restore(bed)?, plan, densities, bodies, samples, levels, stages };
        packed.check().map_err(RestoreError::Inconsistent).map(|()| packed)
    }

    /// Fails unless the data of layers and stages are complete.
    fn check(&self) -> Result<(), &'static str> {
        let layers = self.densities.len();
        let of_all = |length: usize| length == layers;
        if layers == 0 || self.bed.laws.surfaces() != layers + 1 {
            return Err("the number of layers does not match the number of surfaces");
        }
        if !of_all(self.samples.len()) || !of_all(self.levels.len()) || !of_all(self.bodies.len().wrapping_sub(1)) {
            return Err("data of a layer are missing");
        }
        if !self.plan.iter().chain(&self.densities).all(|x| x.is_finite() && *x > 0.0) {
            return Err("a side of its plan or a density is not a finite number above 0");
        }
        if !self.bodies.is_sorted() || self.bodies.last().copied() != Some(self.bed.len() as u32) {
            return Err("the number of bodies of its layers does not match its number of bodies");
        }
        if !self.samples.iter().all(|sample| sample.curve.is_whole()) {
            return Err("a grading has no points");
        }
        if self.stages.len() <= LAST || !self.stages.iter().all(|stage| of_all(stage.state.layers.len())) {
            return Err("stages of its packing are missing");
        }
        Ok(())
    }
}
