//! One cell under trains of one's own choice: the settlement of the grains of a scene, measured apart from its track.

use super::cell::{Cell, HOLD, Passed};
use super::forces::TrainForces;
use super::{Parts, built, recipe};
use crate::nodes::NodeError;
use crate::nodes::on_grains::{SHARING, Telling};
use crate::solvers::granular::{Failure, Stride};
use serde::Serialize;

/// A cell of a scene, with the trains that have passed it so far.
#[derive(Clone)]
pub struct Specimen {
    cell: Cell,
    gravity: f64,
    recipe: String,
}

impl Specimen {
    /// A cell of the scene that no train has passed, by its index in the plan.
    pub fn build(parts: Parts<'_>, cell: usize, tell: &mut Telling<'_>) -> Result<Specimen, NodeError> {
        let plan = &parts.cells.cells[cell];
        let (cell, _) = built(parts, plan, tell)?;
        Ok(Specimen { cell, gravity: parts.cells.gravity, recipe: recipe(parts, plan) })
    }

    /// Hash of what determines how it was built.
    pub fn recipe(&self) -> &str {
        &self.recipe
    }

    /// The same cell with another largest inertia added / mass; the step is the longest that it allows.
    pub fn with_added(&self, share: f64) -> Result<Specimen, NodeError> {
        let mut other = self.clone();
        other.cell.stride = Stride::with_added(&mut other.cell.bed, SHARING, share)?.step;
        Ok(other)
    }

    /// The step of the cell as it stands, and what limits it.
    pub fn step(&self) -> Result<StepOfCell, NodeError> {
        let mut cell = self.cell.clone();
        let added = Stride { step: cell.stride, sharing: SHARING }.hold(&mut cell.bed)?;
        let limit = cell.bed.critical_step(0.0)?.network.step;
        Ok(StepOfCell { step: cell.hold()?, limit, added })
    }

    /// The cell under a static load on every sleeper, about that of a 20 t axle.
    pub fn pressed(&self) -> Result<Specimen, NodeError> {
        let mut pressed = self.clone();
        pressed.cell.press(self.gravity)?;
        Ok(pressed)
    }

    /// Runs a copy for some steps of another length, s, with the inertia that its own step needs; the failure if it is
    /// stopped.
    pub fn try_step(&self, step: f64, steps: u64) -> Result<Option<Failure>, NodeError> {
        let (mut bed, stride) = (self.cell.bed.clone(), Stride { step: self.cell.stride, sharing: SHARING });
        for done in (0..steps).step_by(HOLD as usize) {
            stride.hold(&mut bed)?;
            bed.set_time_step(step);
            if let Err(failure) = bed.run(HOLD.min(steps - done)) {
                return Ok(Some(failure));
            }
        }
        Ok(None)
    }

    /// Lets one train pass.
    pub fn pass(&mut self, train: &TrainForces) -> Result<Passed, NodeError> {
        self.cell.pass(train, self.gravity)
    }
}

/// The time step of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StepOfCell {
    /// s.
    pub step: f64,
    /// Longest stable step of the whole network of contacts with the inertia added, s.
    pub limit: f64,
    /// Inertia added / mass of all grains.
    pub added: f64,
}
