//! Search for neighbouring pebbles: grids of cells, one for each size class.
//!
//! A pebble searches its own grid and the grids of larger pebbles, so that a wide grading costs no more than a narrow
//! grading.

use super::domain::{Domain, Image};
use super::vector::{Vec3, dot};
use rayon::prelude::*;

/// Pebbles that one task looks up. The number is fixed, so that the number of threads does not change the results.
pub(super) const CHUNK: usize = 1024;
/// Largest number of grids; each halves the cells of the grid before.
const LEVELS: usize = 5;

/// The data of a pebble for the search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub cell: [i32; 3],
    pub offset: Vec3,
    pub radius: f64,
    /// Pebbles of one body do not touch each other.
    pub body: u32,
}

/// Two pebbles near each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    pub first: u32,
    pub second: u32,
    /// Shift of the first pebble.
    pub image: Image,
}

/// Two neighbouring pebbles that are more than a cell of the domain apart, or that are neighbours in both directions of
/// a period.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellTooSmall;

/// One size class: pebbles by cells.
struct Grid {
    origin: Vec3,
    size: Vec3,
    dims: [i64; 3],
    periodic: [bool; 3],
    /// Largest radius in this class \[m\].
    largest: f64,
    start: Vec<u32>,
    pebbles: Vec<u32>,
}

/// Pebbles in grids.
pub(super) struct Grids<'a> {
    domain: &'a Domain,
    seen: &'a [Seen],
    places: Vec<Vec3>,
    level: Vec<u8>,
    grids: Vec<Grid>,
}

impl<'a> Grids<'a> {
    /// Sorts the pebbles into grids for contacts up to `skin` \[m\] apart.
    pub fn new(domain: &'a Domain, seen: &'a [Seen], skin: f64) -> Grids<'a> {
        let places: Vec<Vec3> = seen
            .iter()
            .map(|s| {
                let place = domain.place(domain.wrap(s.cell), s.offset);
                [0, 1, 2].map(|axis| domain.period(axis).map_or(place[axis], |p| place[axis].rem_euclid(p)))
            })
            .collect();
        let (smallest, largest) =
            seen.iter().fold((f64::INFINITY, 0.0f64), |(lo, hi), s| (lo.min(s.radius), hi.max(s.radius)));
        let coarsest = 2.0 * largest + skin;
        let count = (1..LEVELS).take_while(|&l| coarsest / f64::from(1 << l) >= 2.0 * smallest + skin).count() + 1;
        let level: Vec<u8> = seen
            .iter()
            .map(|s| {
                let fits = |&l: &usize| coarsest / f64::from(1 << l) >= 2.0 * s.radius + skin;
                (1..count).take_while(fits).last().unwrap_or(0) as u8
            })
            .collect();
        let grids = (0..count)
            .map(|l| {
                let members: Vec<u32> = (0..seen.len() as u32).filter(|&p| level[p as usize] == l as u8).collect();
                let largest = members.iter().map(|&p| seen[p as usize].radius).fold(0.0, f64::max);
                Grid::new(domain, &places, &members, coarsest / f64::from(1 << l), largest)
            })
            .collect();
        Grids { domain, seen, places, level, grids }
    }

    /// Pairs up to `skin` \[m\] apart, task by task.
    pub fn pairs(&self, skin: f64) -> Result<Vec<Vec<Pair>>, CellTooSmall> {
        let tasks = self.seen.len().div_ceil(CHUNK);
        (0..tasks)
            .into_par_iter()
            .map(|task| {
                let mut found = Vec::new();
                for pebble in task * CHUNK..((task + 1) * CHUNK).min(self.seen.len()) {
                    self.look_up(pebble, skin, &mut found)?;
                }
                Ok(found)
            })
            .collect()
    }

    fn look_up(&self, pebble: usize, skin: f64, found: &mut Vec<Pair>) -> Result<(), CellTooSmall> {
        let (me, own) = (&self.seen[pebble], self.level[pebble] as usize);
        for (level, grid) in self.grids[..=own].iter().enumerate() {
            let mut fine = Ok(());
            grid.visit(self.places[pebble], me.radius + grid.largest + skin, |other| {
                let it = &self.seen[other as usize];
                if it.body == me.body || (level == own && other as usize <= pebble) {
                    return;
                }
                let apart = self.domain.between((me.cell, me.offset), (it.cell, it.offset));
                let reach = me.radius + it.radius + skin;
                if dot(apart, apart) >= reach * reach {
                    return;
                }
                let both_ways = |axis: usize| {
                    let Some(period) = self.domain.period(axis) else { return false };
                    let round = period - apart[axis].abs();
                    dot(apart, apart) + round * round - apart[axis] * apart[axis] < reach * reach
                };
                match self.domain.image((me.cell, me.offset), (it.cell, it.offset)) {
                    _ if (0..3).any(both_ways) => fine = Err(CellTooSmall),
                    Some(image) => found.push(Pair { first: pebble as u32, second: other, image }),
                    None => fine = Err(CellTooSmall),
                }
            });
            fine?;
        }
        Ok(())
    }

    /// Pebbles whose centre may lie within `reach` of the box from `low` to `high` \[m\], in any image.
    pub fn in_box(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(u32)) {
        self.grids.iter().for_each(|grid| grid.visit_box(low, high, &mut visit));
    }
}

impl Grid {
    fn new(domain: &Domain, places: &[Vec3], members: &[u32], size: f64, largest: f64) -> Grid {
        let mut grid = Grid {
            origin: [0.0; 3],
            size: [size; 3],
            dims: [1; 3],
            periodic: [0, 1, 2].map(|axis| domain.period(axis).is_some()),
            largest,
            start: Vec::new(),
            pebbles: Vec::new(),
        };
        let extent = [0, 1, 2].map(|axis| match domain.period(axis) {
            Some(period) => period,
            None => {
                let (low, high) = members.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &p| {
                    let x = places[p as usize][axis];
                    (lo.min(x), hi.max(x))
                });
                grid.origin[axis] = if low.is_finite() { low } else { 0.0 };
                (high - low).max(0.0)
            }
        });
        // a body that flew far away must not cost memory for all cells up to it
        let (mut side, enough) = (size, 4096.0 + 8.0 * members.len() as f64);
        while extent.iter().map(|e| (e / side).floor().max(0.0) + 1.0).product::<f64>() > enough {
            side *= 1.26;
        }
        for (axis, extent) in extent.into_iter().enumerate() {
            let n = (extent / side).floor().max(1.0);
            grid.dims[axis] = n as i64;
            grid.size[axis] = if grid.periodic[axis] { extent / n } else { side };
            if !grid.periodic[axis] {
                grid.dims[axis] += 1;
            }
        }
        grid.fill(places, members);
        grid
    }

    fn fill(&mut self, places: &[Vec3], members: &[u32]) {
        let cells = self.dims.iter().product::<i64>() as usize;
        let mut start = vec![0u32; cells + 1];
        let of = |p: u32| self.index([0, 1, 2].map(|axis| self.cell(axis, places[p as usize][axis])));
        members.iter().for_each(|&p| start[of(p) + 1] += 1);
        (0..cells).for_each(|c| start[c + 1] += start[c]);
        let mut next = start.clone();
        let mut pebbles = vec![0u32; members.len()];
        for &p in members {
            let slot = &mut next[of(p)];
            pebbles[*slot as usize] = p;
            *slot += 1;
        }
        (self.start, self.pebbles) = (start, pebbles);
    }

    fn cell(&self, axis: usize, x: f64) -> i64 {
        (((x - self.origin[axis]) / self.size[axis]).floor() as i64).clamp(0, self.dims[axis] - 1)
    }

    fn index(&self, [x, y, z]: [i64; 3]) -> usize {
        ((z * self.dims[1] + y) * self.dims[0] + x) as usize
    }

    fn visit(&self, centre: Vec3, reach: f64, visit: impl FnMut(u32)) {
        self.visit_box(centre.map(|x| x - reach), centre.map(|x| x + reach), visit);
    }

    /// Pebbles of every cell within reach, each once.
    fn visit_box(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(u32)) {
        if self.pebbles.is_empty() {
            return;
        }
        let range = [0, 1, 2].map(|axis| {
            let at = |x: f64| ((x - self.origin[axis]) / self.size[axis]).floor();
            let (low, high) = (at(low[axis]), at(high[axis]));
            let n = self.dims[axis];
            if !self.periodic[axis] {
                ((low.max(0.0) as i64).min(n), (high as i64).min(n - 1))
            } else if high - low + 1.0 >= n as f64 {
                (0, n - 1)
            } else {
                (low as i64, high as i64)
            }
        });
        let wrap = |axis: usize, c: i64| if self.periodic[axis] { c.rem_euclid(self.dims[axis]) } else { c };
        for z in range[2].0..=range[2].1 {
            for y in range[1].0..=range[1].1 {
                for x in range[0].0..=range[0].1 {
                    let cell = self.index([wrap(0, x), wrap(1, y), wrap(2, z)]);
                    let members = self.start[cell] as usize..self.start[cell + 1] as usize;
                    self.pebbles[members].iter().for_each(|&p| visit(p));
                }
            }
        }
    }
}
