//! Cells side by side along an open x: copies of one cell, or of several cells packed from different seeds (methods
//! 1.7).

use super::bed::Bed;
use super::body::{Body, BodyId, SPHERE};
use super::bonds::Bonds;
use super::build::Carried;
use super::failure::Failure;
use super::lanes::Real;
use super::walls::Kept;

/// First body of a bay, and the bodies that are kept.
struct Bay {
    cell: usize,
    /// New number of each body of the cell; `None` if it is left out.
    numbers: Vec<Option<u32>>,
}

impl<R: Real> Bed<R> {
    /// Beds of one period of the same length along x, side by side: bay `b` holds cell `order[b]` and lies `first + b`
    /// lengths along x. The ends are open and not connected.
    ///
    /// Contacts continue with their histories inside a bay, and into the next bay if that holds the same cell; between
    /// different cells bodies may overlap. Bodies for which `kept` (bay, body of the cell) is false are left out.
    /// Walls, laws, gravity and damping are taken from the first cell.
    ///
    /// # Panics
    /// If a cell is not one period along x, the lengths differ, a wall has an end, or `order` is empty or names no
    /// cell.
    pub fn side_by_side(
        cells: &mut [Bed<R>],
        order: &[usize],
        first: i32,
        kept: impl Fn(usize, BodyId) -> bool,
    ) -> Result<Bed<R>, Failure> {
        let length = cells[order[0]].period_of_cell();
        assert!(cells.iter().all(|cell| cell.period_of_cell() == length), "cells of one length");
        assert!(cells[0].walls.iter().all(|wall| wall.shape.bounds().is_none()), "walls without ends");
        cells.iter_mut().try_for_each(|cell| cell.refresh())?;
        let mut bed = cells[order[0]].clone();
        bed.domain = bed.domain.bays(length);
        bed.bonds = Bonds::default();
        bed.clear_bodies();
        let mut bays = Vec::with_capacity(order.len());
        for (bay, &cell) in order.iter().enumerate() {
            let numbers = bed.take_over(cells, cell, first + bay as i32, |body| kept(bay, body));
            bays.push(Bay { cell, numbers });
        }
        let (carried, touches) = histories(cells, &bays);
        bed.lists.outdated = true;
        bed.rebuild_with(carried, touches)?;
        Ok(bed)
    }

    fn period_of_cell(&self) -> f64 {
        self.domain.period(0).filter(|_| self.domain.cells(0) == Some(1)).expect("one period along x")
    }

    /// Copies the bodies of a cell into a bay, and returns their new numbers.
    fn take_over(
        &mut self,
        cells: &[Bed<R>],
        number: usize,
        bay: i32,
        kept: impl Fn(BodyId) -> bool,
    ) -> Vec<Option<u32>> {
        let cell = &cells[number];
        // bodies of one cell are equal in all its bays, and different from the bodies of any other cell
        let before: usize = cells[..number].iter().map(Bed::len).sum();
        let copied = |place: &u32| {
            let body = &cell.bodies[*place as usize];
            if !kept(BodyId(body.id)) {
                return None;
            }
            let rank = before as u32 + body.rank;
            let copy = self.copy_body(cell, *place);
            (copy.cell[0], copy.rank) = (bay, rank);
            Some(copy.id)
        };
        cell.index.iter().map(copied).collect()
    }

    /// Adds a copy of a body of another bed, given by its index there, with the next number.
    pub(super) fn copy_body(&mut self, from: &Bed<R>, place: u32) -> &mut Body {
        let (mut body, pebbles) = (from.bodies[place as usize], self.owner.len() as u32);
        let id = self.bodies.len() as u32;
        let own = body.first as usize..body.first as usize + usize::from(body.pebbles);
        if body.clump != SPHERE {
            let mut clump = from.clumps[body.clump as usize];
            let arms = clump.arms as usize..clump.arms as usize + usize::from(body.pebbles);
            clump.arms = self.arms.len() as u64;
            self.arms.extend_from_slice(&from.arms[arms]);
            body.clump = self.clumps.len() as u32;
            self.clumps.push(clump);
        }
        (body.id, body.first) = (id, pebbles);
        self.records.extend_from_slice(&from.records[own.clone()]);
        self.owner.resize(self.owner.len() + own.len(), id);
        self.index.push(id);
        self.bodies.push(body);
        &mut self.bodies[id as usize]
    }

    /// Removes all bodies from their lists; walls and histories stay.
    pub(super) fn clear_bodies(&mut self) {
        self.records.clear();
        self.bodies.clear();
        self.owner.clear();
        self.index.clear();
        self.clumps.clear();
        self.arms.clear();
    }
}

/// Histories of contacts that continue.
fn histories<R: Real>(cells: &[Bed<R>], bays: &[Bay]) -> (Vec<Carried<R>>, Vec<Kept<R>>) {
    let (mut carried, mut touches) = (Vec::new(), Vec::new());
    for (number, cell) in cells.iter().enumerate() {
        let (between, walls) = (cell.carried_with_images(), cell.kept());
        for (here, bay) in bays.iter().enumerate().filter(|(_, bay)| bay.cell == number) {
            for (near, image) in &between {
                // the lower body is in this bay, and its neighbour as many bays away as the image says
                let there = here as i64 - i64::from(super::domain::steps_of(*image)[0]);
                let other = usize::try_from(there).ok().and_then(|there| bays.get(there));
                let Some(other) = other.filter(|other| other.cell == number) else { continue };
                let both = (bay.numbers[near.low.0 as usize], other.numbers[near.high.0 as usize]);
                let (Some(a), Some(b)) = both else { continue };
                let (low, high) = ((a, near.low.1), (b, near.high.1));
                let swap = |v: [R; 3]| if low < high { v } else { v.map(|c| -c) };
                let (shear, damping) = (swap(near.shear), swap(near.damping));
                carried.push(Carried { low: low.min(high), high: low.max(high), shear, damping });
            }
            let moved = |touch: &Kept<R>| Some(Kept { body: bay.numbers[touch.body as usize]?, ..*touch });
            touches.extend(walls.iter().filter_map(moved));
        }
    }
    touches.sort_by_key(|touch| (touch.wall, touch.body, touch.pebble));
    (carried, touches)
}
