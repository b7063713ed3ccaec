//! Cell of each seat. Seats share a cell as long as trains load them equally; a seat with other forces gets its own
//! cell.

use crate::graph::{CellPlan, CellsNode, seats_alike};
use serde::{Deserialize, Serialize};

/// The present cells. Cells after the planned ones were split off from others during the run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub plans: Vec<CellPlan>,
    /// The cell that answers for each seat; `None` for a seat without grains below.
    pub cell_of: Vec<Option<usize>>,
    /// For each cell after the planned ones: the cell from which it was split off, and its seat.
    parted: Vec<[usize; 2]>,
}

/// The splits that lead from the plan to the present layout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct StoredLayout {
    cell_of: Vec<Option<usize>>,
    parted: Vec<[usize; 2]>,
}

impl Layout {
    /// The cells as planned.
    pub fn planned(node: &CellsNode) -> Layout {
        Layout { plans: node.cells.clone(), cell_of: node.cell_of.clone(), parted: Vec::new() }
    }

    pub fn store(&self) -> StoredLayout {
        StoredLayout { cell_of: self.cell_of.clone(), parted: self.parted.clone() }
    }

    /// The layout that was stored; `None` of another track.
    pub fn restore(node: &CellsNode, stored: StoredLayout) -> Option<Layout> {
        let mut layout = Layout::planned(node);
        for [from, seat] in stored.parted {
            layout.add(node, from, seat)?;
        }
        let is_whole = stored.cell_of.len() == node.cell_of.len()
            && stored.cell_of.iter().flatten().all(|cell| *cell < layout.plans.len());
        layout.cell_of = stored.cell_of;
        is_whole.then_some(layout)
    }

    /// Gives a seat its own cell if its load differs from the load of its cell's main seat by more than `tolerance` of
    /// the largest load, N. Seats with equal loads share the new cell. `loads` has no value for seats that a train does
    /// not pass with every wheel; they keep their cell. Returns for each new cell the cell whose grains it takes over.
    pub fn part(&mut self, node: &CellsNode, loads: &[Option<f64>], tolerance: f64) -> Vec<usize> {
        let largest = loads.iter().flatten().fold(0.0, |most: f64, load| most.max(*load));
        let apart = tolerance * largest;
        let mut from = Vec::new();
        for cell in 0..self.plans.len() {
            for group in seats_alike(self.parted(cell, loads, apart), 2.0 * apart) {
                let (_, typical) = group[group.len() / 2];
                let Some(added) = self.add(node, cell, typical) else { continue };
                group.iter().for_each(|(_, seat)| self.cell_of[*seat] = Some(added));
                from.push(cell);
            }
        }
        from
    }

    /// Seats of a cell whose load differs from the load of its main seat, each with its load, N.
    fn parted(&self, cell: usize, loads: &[Option<f64>], apart: f64) -> Vec<(f64, usize)> {
        let Some(own) = loads.get(self.plans[cell].seat()).copied().flatten() else { return Vec::new() };
        let members = self.cell_of.iter().zip(loads).enumerate().filter(|(_, (of, _))| **of == Some(cell));
        let with_load = members.filter_map(|(seat, (_, load))| Some(((*load)?, seat)));
        with_load.filter(|(load, _)| (load - own).abs() > apart).collect()
    }

    /// Adds a cell that parts from another one, at a seat; gives its number, `None` if there is no such cell or seat.
    fn add(&mut self, node: &CellsNode, from: usize, seat: usize) -> Option<usize> {
        let at = node.seats.get(seat)?.as_ref()?;
        let mut plan = CellPlan { x: at.x, ..self.plans.get(from)?.clone() };
        plan.sleepers.iter_mut().zip(&at.loaded_by).for_each(|(sleeper, seat)| sleeper.seat = *seat);
        self.plans.push(plan);
        self.parted.push([from, seat]);
        Some(self.plans.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::{SeatOnCell, SleeperOnGrains};

    fn node(seats: usize) -> CellsNode {
        let sleeper = SleeperOnGrains {
            seat: 0,
            place: [0.3, 0.0],
            size: [0.3, 1.2, 0.2],
            mass: 150.0,
            rail_mass: 36.0,
            pad: None,
            pitch: None,
            buffer: false,
        };
        let plan = CellPlan {
            bed: 0,
            x: 0.0,
            copies: 1,
            sleepers: vec![sleeper],
            middle: 0,
            soil: None,
            crib: None,
            glued: Vec::new(),
        };
        let seat = |seat: usize| Some(SeatOnCell { x: 0.6 * seat as f64, loaded_by: vec![seat], passed: true });
        CellsNode {
            beds: Vec::new(),
            cells: vec![plan],
            cell_of: vec![Some(0); seats],
            seats: (0..seats).map(seat).collect(),
            settlement: vec![0.0; seats],
            headway_time: None,
            damping_time: 1e-3,
            gravity: 9.81,
            time_step: None,
            added_inertia: 0.02,
            tolerance: 0.05,
            trains: 10,
        }
    }

    #[test]
    fn seats_part_where_their_loads_do_and_those_that_are_alike_share_a_cell() {
        let node = node(6);
        let mut layout = Layout::planned(&node);
        let loads = |kilonewton: [f64; 6]| kilonewton.map(|load| Some(1e3 * load));
        assert!(layout.part(&node, &loads([40.0, 40.5, 39.5, 40.0, 41.9, 38.1]), 0.05).is_empty());
        assert_eq!(layout.part(&node, &loads([40.0, 40.0, 40.0, 44.0, 25.0, 27.0]), 0.05), [0, 0]);
        assert_eq!(layout.cell_of, [Some(0), Some(0), Some(0), Some(2), Some(1), Some(1)]);
        assert_eq!((layout.plans[1].seat(), layout.plans[2].seat()), (5, 3));
        assert!((layout.plans[2].x - 1.8).abs() < 1e-9);
        // a cell that has parted may part again
        assert_eq!(layout.part(&node, &loads([40.0, 40.0, 40.0, 44.0, 5.0, 27.0]), 0.05), [1]);
        assert_eq!(layout.cell_of[4..], [Some(3), Some(1)]);
        // what is stored makes the same layout, and none of another track
        assert_eq!(Layout::restore(&node, layout.store()), Some(layout.clone()));
        assert_eq!(Layout::restore(&self::node(5), layout.store()), None);
    }

    #[test]
    fn seats_that_a_train_does_not_pass_whole_stay() {
        let node = node(3);
        let mut layout = Layout::planned(&node);
        assert!(layout.part(&node, &[Some(40e3), Some(40e3), None], 0.05).is_empty());
        assert!(layout.part(&node, &[None, Some(40e3), Some(10e3)], 0.05).is_empty());
    }
}
