//! Periodic cells of grains, each under the forces of its own sleepers: the nodes of tier `cells`.

use super::{BedPlan, SleeperOnGrains};
use crate::solvers::granular::rig::{Crib, Glued};
use serde::{Deserialize, Serialize};

/// A cell of grains for each sleeper that is loaded otherwise than the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellsNode {
    /// Each once: sections with equal layers share one.
    pub beds: Vec<BedPlan>,
    pub cells: Vec<CellPlan>,
    /// The cell that answers for each seat; `None` for a seat without grains below.
    pub cell_of: Vec<Option<usize>>,
    /// What a cell takes from the track that answers for a seat alone; `None` for a seat without grains below.
    pub seats: Vec<Option<SeatOnCell>>,
    /// Settlement of every seat of the track at the start, m.
    pub settlement: Vec<f64>,
    /// Time between the fronts of trains that follow each other closely, s; `None` lets the track come to rest between them.
    pub headway_time: Option<f64>,
    /// Damping of a support over its stiffness, s.
    pub damping_time: f64,
    /// m/s^2.
    pub gravity: f64,
    /// Time step of the grains, s; `None` is the longest for which `added_inertia` suffices.
    pub time_step: Option<f64>,
    /// Share of the mass of a bed that may be added as inertia for the sake of a longer step.
    pub added_inertia: f64,
    /// Error of the settlement of a cell, over the largest settlement or the compression under the train, at which the other trains of a
    /// block are not computed; 0 computes all.
    pub tolerance: f64,
}

/// A seat that may get a cell of its own on the way, where trains load it otherwise than the seats that it shares one with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatOnCell {
    /// Chainage, m.
    pub x: f64,
    /// Seats whose forces load the bays of its cell, from left to right.
    pub loaded_by: Vec<usize>,
    /// Whether every wheel of a train comes from far before it and runs on far behind it.
    pub passed: bool,
}

/// One bay or some, without an end along the track.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellPlan {
    /// Index into [`CellsNode::beds`].
    pub bed: usize,
    /// Chainage of the sleeper whose answers are taken, m.
    pub x: f64,
    /// Cells of the bed side by side.
    pub copies: u32,
    /// From left to right; each is loaded by the forces of its seat.
    pub sleepers: Vec<SleeperOnGrains>,
    /// The sleeper whose answers are taken.
    pub middle: usize,
    /// Stiffness of the soil under it, N/m; `None` where the grains lie on rock.
    pub soil: Option<f64>,
    /// Grains between and beside the sleepers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crib: Option<Crib>,
    /// Layers whose grains are glued.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub glued: Vec<Glued>,
}

impl CellPlan {
    /// The seat whose forces load the sleeper in the middle.
    pub fn seat(&self) -> usize {
        self.sleepers[self.middle].seat
    }
}

impl CellsNode {
    /// How many seats a cell answers for.
    pub fn seats_of(&self, cell: usize) -> usize {
        self.cell_of.iter().filter(|of| **of == Some(cell)).count()
    }
}

/// Seats in groups whose values are no farther apart than this, the values growing from group to group and within each.
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
