//! A finished bed as data.

use super::super::bed::Bed;
use super::super::checkpoint::{Checkpoint, RestoreError};
use super::super::grains::Sample;
use super::super::lanes::Real;
use super::describe::Stage;
use super::packed::Packed;
use serde::{Deserialize, Serialize};

/// What [`Packed`] holds, to be kept. A bed that comes back goes on bit by bit as the one that was kept.
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

    /// Fails where what was kept is damaged.
    pub fn restore(stored: StoredBed<R>) -> Result<Packed<R>, RestoreError> {
        let StoredBed { bed, plan, densities, bodies, samples, levels, stages } = stored;
        Ok(Packed { bed: Bed::restore(bed)?, plan, densities, bodies, samples, levels, stages })
    }
}
