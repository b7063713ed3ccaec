//! Periodic cells of grains, each under the forces of its own sleepers: the node of tier `cells`.

use super::{BedPlan, SleeperOnGrains};
use crate::solvers::granular::rig::{Crib, Glued};
use serde::{Deserialize, Serialize};

/// A cell of grains for each distinct sleeper.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellsNode {
    /// Different beds; sections with equal layers share a bed.
    pub beds: Vec<BedPlan>,
    pub cells: Vec<CellPlan>,
    /// Index of the cell of each seat; `None` for a seat without grains.
    pub cell_of: Vec<Option<usize>>,
    /// Data from the track for a cell of this seat alone; `None` for a seat without grains.
    pub seats: Vec<Option<SeatOnCell>>,
    /// Settlement of every seat of the track at the start, m.
    pub settlement: Vec<f64>,
    /// Time between the fronts of two trains that follow each other, s; `None` if the track comes to rest between
    /// trains.
    pub headway_time: Option<f64>,
    /// Damping / stiffness of a support, s.
    pub damping_time: f64,
    /// Gravitational acceleration, m/s^2.
    pub gravity: f64,
    /// Time step of the grains, s; `None` for the longest step that `added_inertia` allows.
    pub time_step: Option<f64>,
    /// Largest added inertia / mass of a bed; added inertia allows a longer step.
    pub added_inertia: f64,
    /// Error of the settlement of a cell / largest settlement or compression under the train, below which the other
    /// trains of a block are not computed; 0 computes all trains.
    pub tolerance: f64,
    /// Trains of the whole run: each block gets the share of the tolerance that its trains have of these.
    pub trains: u64,
}

/// A seat that may get its own cell during the run, if its load differs from the load of the seats that share its cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatOnCell {
    /// Chainage, m.
    pub x: f64,
    /// Seats whose forces load the bays of its cell, from left to right.
    pub loaded_by: Vec<usize>,
    /// Whether every wheel of a train starts far before the seat and stops far behind it.
    pub passed: bool,
}

/// One or several bays, periodic along the track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellPlan {
    /// Index into [`CellsNode::beds`].
    pub bed: usize,
    /// Chainage of the sleeper whose results are used, m.
    pub x: f64,
    /// Cells of the bed side by side.
    pub copies: u32,
    /// Sleepers from left to right; each has the forces of its seat.
    pub sleepers: Vec<SleeperOnGrains>,
    /// Index of the sleeper whose results are used.
    pub middle: usize,
    /// Stiffness of the soil under this sleeper, N/m; `None` if the grains lie on a rigid base.
    pub soil: Option<f64>,
    /// Grains between and beside the sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
    /// Layers whose grains are glued.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub glued: Vec<Glued>,
}

impl CellPlan {
    /// Data that determine how a cell is built. The place of its seat and the soil below do not matter, so cells that
    /// differ only in these are built once.
    pub fn anywhere(&self) -> CellPlan {
        let mut plan = CellPlan { x: 0.0, soil: None, ..self.clone() };
        plan.sleepers.iter_mut().for_each(|sleeper| sleeper.seat = 0);
        plan
    }

    /// Whether two cells are built alike.
    pub fn is_built_alike(&self, other: &CellPlan) -> bool {
        self.anywhere() == other.anywhere()
    }

    /// The seat whose forces load the sleeper in the middle.
    pub fn seat(&self) -> usize {
        self.sleepers[self.middle].seat
    }
}

impl CellsNode {
    /// Number of seats that use a cell.
    pub fn seats_of(&self, cell: usize) -> usize {
        self.cell_of.iter().filter(|of| **of == Some(cell)).count()
    }
}

/// Groups of seats whose values differ by at most `apart`; the values ascend from group to group and within each group.
pub fn seats_alike(mut seats: Vec<(f64, usize)>, apart: f64) -> Vec<Vec<(f64, usize)>> {
    seats.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut groups: Vec<Vec<(f64, usize)>> = Vec::new();
    for one in seats {
        match groups.last_mut() {
            Some(group) if one.0 - group[0].0 <= apart => group.push(one),
            _ => groups.push(vec![one]),
        }
    }
    groups
}
