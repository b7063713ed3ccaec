//! Cells as data, to go on with in another process, bit by bit.

use super::book::Book;
use super::cell::Cell;
use super::layout::{Layout, StoredLayout};
use super::{Live, Parts, Underway};
use crate::nodes::NodeError;
use crate::solvers::granular::{Bed, Checkpoint, WallId};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Content of [`Live`].
#[derive(Serialize, Deserialize)]
struct Stored {
    layout: StoredLayout,
    cells: Vec<StoredCell>,
    books: Vec<Book>,
    passed: u64,
    revision: u64,
    underway: Option<Underway>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct StoredCell {
    bed: Checkpoint<f32>,
    walls: Vec<WallId>,
    stride: f64,
    forces: Vec<f64>,
    weights: Vec<f64>,
    middle: usize,
    height: f64,
    stiffness: f64,
    unloaded: f64,
}

impl Cell {
    pub fn store(&self) -> StoredCell {
        StoredCell {
            bed: self.bed.checkpoint(),
            walls: self.walls.clone(),
            stride: self.stride,
            forces: self.forces.clone(),
            weights: self.weights.clone(),
            middle: self.middle,
            height: self.height,
            stiffness: self.stiffness,
            unloaded: self.unloaded,
        }
    }

    /// The cell that was stored; it must have so many sleepers.
    pub fn restore(stored: StoredCell, sleepers: usize) -> Result<Cell, NodeError> {
        let StoredCell { bed, walls, stride, forces, weights, middle, height, stiffness, unloaded } = stored;
        let bed = Bed::restore(bed).map_err(foreign)?;
        let is_whole = [walls.len(), forces.len(), weights.len()] == [sleepers; 3] && middle < sleepers;
        if !is_whole || walls.iter().any(|wall| wall.0 as usize >= bed.walls().len()) {
            return Err(foreign("one cell has other sleepers"));
        }
        Ok(Cell { bed, walls, stride, forces, weights, middle, height, stiffness, unloaded })
    }
}

impl Live {
    /// The state as data.
    pub fn save(&self) -> Result<serde_json::Value, NodeError> {
        let stored = Stored {
            layout: self.layout.store(),
            cells: self.cells.iter().map(Cell::store).collect(),
            books: self.books.clone(),
            passed: self.passed,
            revision: self.revision,
            underway: self.underway.clone(),
        };
        let bytes = postcard::to_stdvec(&stored).map_err(foreign)?;
        Ok(serde_json::Value::String(STANDARD.encode(bytes)))
    }

    /// The cells of these parts that were saved.
    pub fn restore(parts: Parts<'_>, state: &serde_json::Value) -> Result<Live, NodeError> {
        let text = state.as_str().ok_or_else(|| foreign("it holds no cells"))?;
        let bytes = STANDARD.decode(text).map_err(foreign)?;
        let Stored { layout, cells, books, passed, revision, underway } =
            postcard::from_bytes(&bytes).map_err(foreign)?;
        let other = || foreign("it holds another number of cells");
        let layout = Layout::restore(parts.cells, layout).ok_or_else(other)?;
        if [cells.len(), books.len()] != [layout.plans.len(); 2] {
            return Err(other());
        }
        let plans = layout.plans.iter();
        let cells = cells.into_iter().zip(plans).map(|(stored, plan)| Cell::restore(stored, plan.sleepers.len()));
        Ok(Live { cells: cells.collect::<Result<_, _>>()?, layout, books, passed, revision, underway })
    }
}

fn foreign(why: impl ToString) -> NodeError {
    NodeError::Foreign { node: "cells of grains", why: why.to_string() }
}
