//! One cell under trains of one's own choice: the settlement of the grains of a scene, measured apart from its track.

use super::cell::{Cell, Passed};
use super::forces::TrainForces;
use super::{Parts, built, recipe};
use crate::nodes::NodeError;
use crate::nodes::on_grains::Telling;

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

    /// Lets one train pass.
    pub fn pass(&mut self, train: &TrainForces) -> Result<Passed, NodeError> {
        self.cell.pass(train, self.gravity)
    }
}
