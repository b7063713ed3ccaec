//! Map of the exchange of forces and settlement: in which blocks a disturbance of the settlement grows, against theory,
//! and how far the blocks of the scene are from there.

use super::Planned;
use crate::execute::{Disturbance, RunError, blocks_of_run, disturbances};
use crate::graph::Graph;
use serde::Serialize;

/// Growth of a sawtooth over axles that have passed and axles of a block.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExchangeMap {
    /// Count by count, short blocks first.
    pub cells: Vec<Disturbance>,
    /// Axles before each block of the scene, and its axles.
    pub blocks: Vec<[u64; 2]>,
    /// Whether the forces follow the settlement within the blocks of the scene.
    pub adaptive: bool,
}

/// Shares of all axles after which the track is disturbed.
const COUNTS: [f64; 4] = [0.0, 0.02, 0.1, 0.3];
/// Blocks of at most so many sizes, each twice the one before.
const SIZES: usize = 8;
/// A at which a disturbance neither grows nor decays.
const GROWS: f64 = 2.0;
/// Distance from the limit, in growth and in A, within which theory and measurement may disagree.
const NEAR: f64 = 0.15;

impl ExchangeMap {
    /// The largest growth of a disturbance in cells whose blocks follow the settlement, as adaptive ones do.
    pub fn largest_following(&self) -> f64 {
        self.cells.iter().map(|cell| cell.follows).fold(0.0, f64::max)
    }

    /// Cells of the last count up to so many axles, short blocks first.
    fn row(&self, axles: u64) -> impl Iterator<Item = &Disturbance> {
        let counts = self.cells.iter().map(|cell| cell.axles).filter(move |count| *count <= axles);
        let last = counts.max();
        self.cells.iter().filter(move |cell| Some(cell.axles) == last)
    }

    /// Axles of the shortest block that lets a disturbance grow after so many axles, in theory: A is 2. `None` if no
    /// block of the map does.
    pub fn limit(&self, axles: u64) -> Option<f64> {
        let mut before = [0.0, 0.0];
        for cell in self.row(axles) {
            let here = [cell.block_axles as f64, cell.amplification];
            if here[1] > GROWS {
                let share = (GROWS - before[1]) / (here[1] - before[1]);
                return Some(before[0] + share * (here[0] - before[0]));
            }
            before = here;
        }
        None
    }

    /// The longest block of the map after so many axles.
    pub fn longest(&self, axles: u64) -> u64 {
        self.row(axles).map(|cell| cell.block_axles).max().unwrap_or(0)
    }

    /// The block of the scene nearest to its limit: axles before it, its axles, and limit / axles. Where no block of
    /// the map grows, the longest one is the least limit.
    pub fn margin(&self) -> Option<([u64; 2], f64)> {
        let limit = |axles: u64| self.limit(axles).unwrap_or(self.longest(axles) as f64);
        let margin = |block: &[u64; 2]| (*block, limit(block[0]) / block[1] as f64);
        self.blocks.iter().map(margin).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Cells in which a disturbance grows against theory, or decays against it.
    pub fn against_theory(&self) -> usize {
        let grows = |factor: f64| (factor > 1.0 + NEAR, factor < 1.0 - NEAR);
        let differ = |cell: &&Disturbance| {
            let ((theory_grows, theory_decays), (grows, decays)) = (grows(cell.in_theory), grows(cell.stays));
            theory_grows && decays || theory_decays && grows
        };
        let is_clear = |cell: &&Disturbance| (cell.amplification / GROWS - 1.0).abs() > NEAR;
        self.cells.iter().filter(is_clear).filter(differ).count()
    }
}

/// Maps the exchange of a scene by a law; `None` for a scene on grains, and if nothing settles.
pub fn exchange_map(planned: &Planned, tell: &mut dyn FnMut()) -> Result<Option<ExchangeMap>, RunError> {
    let graph: &Graph = &planned.graph;
    if graph.has_grains_under_track() || graph.laws().next().is_none() {
        return Ok(None);
    }
    let blocks = &planned.blocks;
    let counts = COUNTS.map(|share| (share * blocks.total as f64) as u64);
    let sizes: Vec<u64> = (0..SIZES).map(|power| 1 << power).collect();
    let cells = disturbances(graph, &counts, &sizes, tell)?;
    let map = ExchangeMap { cells, blocks: blocks_of_run(graph)?, adaptive: blocks.adaptive().is_some() };
    Ok(map.cells.iter().all(|cell| cell.stays.is_finite() && cell.follows.is_finite()).then_some(map))
}

/// Cells that a map has at most.
pub fn most_cells() -> usize {
    COUNTS.len() * SIZES
}
