//! Data of each cell in addition to the state of its grains, and the values that follow for the seats of the track.

use super::cell::Passed;
use super::hardening::{Computed, Hardening, Jump};
use super::layout::Layout;
use crate::graph::{CellPlan, CellsNode};
use crate::solvers::track::Spring;
use serde::{Deserialize, Serialize};

/// A load that differs from the previous load by more than this share begins a new run of equal trains.
const ALIKE: f64 = 0.1;

/// The account of a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Book {
    /// Stiffness of the grains, N/m.
    pub stiffness: f64,
    /// By all trains so far, and the standard error of it, m.
    pub settled: f64,
    pub error: f64,
    /// Error added by the last block, m.
    pub error_added: f64,
    /// Settlement added by the last train, m.
    pub rate: f64,
    /// Trains that were computed under about the same load, run by run; the last one goes on.
    pub computed: Vec<Vec<Computed>>,
    /// The load of the last run, N.
    pub load: f64,
}

impl Book {
    /// A cell that no train has passed.
    pub fn new(stiffness: f64) -> Book {
        Book { stiffness, settled: 0.0, error: 0.0, error_added: 0.0, rate: 0.0, computed: vec![Vec::new()], load: 0.0 }
    }

    /// Begins trains of a load, N.
    pub fn begin(&mut self, load: f64) {
        if (load - self.load).abs() > ALIKE * self.load {
            self.load = load;
            if !self.known().is_empty() {
                self.computed.push(Vec::new());
            }
        }
    }

    /// Trains that were computed under such a load as now.
    pub fn known(&self) -> &[Computed] {
        self.computed.last().map_or(&[], Vec::as_slice)
    }

    /// Notes a train that was computed.
    pub fn note(&mut self, passed: &Passed) {
        let age = 1 + self.computed.iter().map(Vec::len).sum::<usize>();
        self.stiffness = passed.stiffness;
        if let Some(run) = self.computed.last_mut() {
            run.push(Computed { age: age as f64, added: passed.added });
        }
    }

    /// Settlement added by a run of trains with the first `now` trains computed, by the law if there is one; `None` if
    /// further trains must be computed.
    pub fn jump(&self, law: Option<&Hardening>, now: usize, passed: u64, trains: u64) -> Option<Jump> {
        let known = self.known();
        match law {
            Some(law) => law.settled(known, now, passed, trains),
            None if now as u64 >= trains => {
                let settled = known[known.len() - now..].iter().map(|train| train.added).sum();
                Some(Jump { settled, error: 0.0 })
            }
            None => None,
        }
    }

    /// Whether a jump is accurate enough: its error and the earlier errors, relative to the largest settlement of all
    /// cells, m. Settlement matters because it moves forces to other sleepers. If it is small compared with the
    /// compression under the train, it moves no forces, and the error is compared with the compression.
    ///
    /// `tolerance` is the part of the tolerance for the trains so far: if early blocks used up all of it, the long
    /// blocks after them would have to compute every train.
    pub fn bears(&self, jump: &Jump, largest: f64, tolerance: f64) -> bool {
        self.error + jump.error <= tolerance * largest.max(self.load / self.stiffness)
    }

    /// Takes over what a run of trains has added.
    pub fn settle(&mut self, jump: &Jump, trains: u64) {
        self.settled += jump.settled;
        self.error += jump.error;
        self.error_added += jump.error;
        self.rate = jump.settled / trains.max(1) as f64;
    }
}

/// The law of the cells on each bed, as far as it is known.
pub(super) fn laws(plans: &[CellPlan], books: &[Book]) -> Vec<Option<Hardening>> {
    let beds = plans.iter().map(|plan| plan.bed + 1).max().unwrap_or(0);
    let of_bed = |bed: usize| {
        let cells = plans.iter().zip(books).filter(|(plan, _)| plan.bed == bed);
        let runs: Vec<&[Computed]> = cells.flat_map(|(_, book)| book.computed.iter().map(Vec::as_slice)).collect();
        Hardening::fitted(&runs)
    };
    (0..beds).map(of_bed).collect()
}

/// Stiffness under every seat: grains, the soil below and the under sleeper pad, in series.
pub(super) fn supports(node: &CellsNode, layout: &Layout, books: &[Book]) -> Vec<Option<Spring>> {
    let spring = |cell: &Option<usize>| {
        let cell = (*cell)?;
        let plan = &layout.plans[cell];
        let series = |k: f64, other: f64| k * other / (k + other);
        let stiffness = plan.soil.map_or(books[cell].stiffness, |soil| series(books[cell].stiffness, soil));
        let ground = Spring { stiffness, damping: node.damping_time * stiffness, seating: None };
        Some(plan.sleepers[plan.middle].pad.map_or(ground, |pad| pad.on(ground)))
    };
    layout.cell_of.iter().map(spring).collect()
}

/// The value of the cell of each seat on top of what the seat had at the start, m.
pub(super) fn settlement(node: &CellsNode, layout: &Layout, value: impl Fn(usize) -> f64) -> Vec<f64> {
    let seats = node.settlement.iter().zip(&layout.cell_of);
    seats.map(|(start, cell)| start + cell.map_or(0.0, &value)).collect()
}
