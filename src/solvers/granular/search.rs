//! Search for neighbouring pebbles: grids of cells, one for each size class.
//!
//! A pebble searches its own grid and the grids of larger pebbles, so that a wide grading costs no more than a narrow
//! grading.

use super::domain::{Domain, Image};
use super::lanes::{BLOCK, Lanes, Num, Real, Work};
use super::vector::{Vec3, dot};
use rayon::prelude::*;
use std::ops::Range;

/// Pebbles that one task looks up. The number is fixed, so that the number of threads does not change the results.
pub(super) const CHUNK: usize = 1024;
/// Largest number of grids; each halves the cells of the grid before.
const LEVELS: usize = 5;

/// The data of a pebble for the search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub cell: [i32; 3],
    pub offset: Vec3,
    /// Radius, and the distance that the pebble may move \[m\].
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
    /// Places of the pebbles from the origin, and their radii \[m\], cell by cell like their numbers.
    coarse: [Vec<f32>; 4],
    /// Period of each axis; very long if it has none \[m\].
    periods: [f32; 3],
    /// Largest error of a distance between coarse places \[m\].
    error: f64,
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
            .par_iter()
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
            .par_iter()
            .map(|s| {
                let fits = |&l: &usize| coarsest / f64::from(1 << l) >= 2.0 * s.radius + skin;
                (1..count).take_while(fits).last().unwrap_or(0) as u8
            })
            .collect();
        let grids = (0..count)
            .into_par_iter()
            .map(|l| {
                let members: Vec<u32> = (0..seen.len() as u32).filter(|&p| level[p as usize] == l as u8).collect();
                Grid::new(domain, (seen, &places), &members, coarsest / f64::from(1 << l))
            })
            .collect();
        Grids { domain, seen, places, level, grids }
    }

    /// Pairs up to `skin` \[m\] apart, task by task.
    pub fn pairs(&self, skin: f64) -> Result<Vec<Vec<Pair>>, CellTooSmall> {
        let tasks = (0..self.seen.len().div_ceil(CHUNK)).into_par_iter();
        let pebbles = |task: usize| task * CHUNK..((task + 1) * CHUNK).min(self.seen.len());
        tasks.map(|task| f32::dispatch(LookUp { grids: self, pebbles: pebbles(task), skin })).collect()
    }

    /// Takes two pebbles if they are up to `skin` \[m\] apart.
    fn meet(&self, pebble: usize, other: u32, skin: f64) -> Result<Option<Pair>, CellTooSmall> {
        let (me, it) = (&self.seen[pebble], &self.seen[other as usize]);
        if it.body == me.body {
            return Ok(None);
        }
        let apart = self.domain.between((me.cell, me.offset), (it.cell, it.offset));
        let reach = me.radius + it.radius + skin;
        if dot(apart, apart) >= reach * reach {
            return Ok(None);
        }
        let both_ways = |axis: usize| {
            let Some(period) = self.domain.period(axis) else { return false };
            let round = period - apart[axis].abs();
            dot(apart, apart) + round * round - apart[axis] * apart[axis] < reach * reach
        };
        match self.domain.image((me.cell, me.offset), (it.cell, it.offset)) {
            Some(image) if !(0..3).any(both_ways) => Ok(Some(Pair { first: pebble as u32, second: other, image })),
            _ => Err(CellTooSmall),
        }
    }

    /// Pebbles whose centre may lie within `reach` of the box from `low` to `high` \[m\], in any image.
    pub fn in_box(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(u32)) {
        let mut runs = Vec::new();
        for grid in &self.grids {
            grid.runs(low, high, &mut runs);
            runs.drain(..).for_each(|run| grid.pebbles[run].iter().for_each(|&p| visit(p)));
        }
    }
}

/// The search for the pairs of some pebbles.
struct LookUp<'a> {
    grids: &'a Grids<'a>,
    pebbles: Range<usize>,
    skin: f64,
}

impl Work<f32> for LookUp<'_> {
    type Output = Result<Vec<Pair>, CellTooSmall>;

    #[inline(always)]
    fn run<L: Lanes<Real = f32>>(self, lanes: L) -> Self::Output {
        let LookUp { grids, pebbles, skin } = self;
        let (mut found, mut runs) = (Vec::new(), Vec::new());
        for pebble in pebbles {
            let (me, own) = (grids.seen[pebble].radius, grids.level[pebble] as usize);
            let place = grids.places[pebble];
            for level in 0..=own {
                let grid = &grids.grids[level];
                let reach = me + grid.largest + skin;
                grid.runs(place.map(|x| x - reach), place.map(|x| x + reach), &mut runs);
                let (centre, reach) = grid.coarse(lanes, place, me + skin);
                for run in runs.drain(..) {
                    for at in run.clone().step_by(L::WIDTH) {
                        let mut near = grid.near(lanes, at, centre, reach);
                        while near != 0 {
                            let place = at + near.trailing_zeros() as usize;
                            near &= near - 1;
                            let other = if place < run.end { grid.pebbles[place] } else { break };
                            // two pebbles of a grid find each other
                            if level == own && other as usize <= pebble {
                                continue;
                            }
                            if let Some(pair) = grids.meet(pebble, other, skin)? {
                                found.push(pair);
                            }
                        }
                    }
                }
            }
        }
        Ok(found)
    }
}

impl Grid {
    fn new(domain: &Domain, (seen, places): (&[Seen], &[Vec3]), members: &[u32], size: f64) -> Grid {
        let largest = members.iter().map(|&p| seen[p as usize].radius).fold(0.0, f64::max);
        let mut grid = Grid {
            origin: [0.0; 3],
            size: [size; 3],
            dims: [1; 3],
            periodic: [0, 1, 2].map(|axis| domain.period(axis).is_some()),
            largest,
            start: Vec::new(),
            pebbles: Vec::new(),
            coarse: Default::default(),
            periods: [0, 1, 2].map(|axis| domain.period(axis).map_or(f32::MAX, |period| period as f32)),
            error: 0.0,
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
        // three coordinates of two places, and the rounded radii
        let widest = extent.into_iter().fold(2.0 * size + largest, f64::max);
        grid.error = 8.0 * widest * f64::from(f32::EPSILON);
        let column = |of: &dyn Fn(u32) -> f64| {
            // the last lanes may reach beyond the last pebble
            let beyond = std::iter::repeat_n(f32::MAX, BLOCK);
            grid.pebbles.iter().map(|&p| of(p) as f32).chain(beyond).collect()
        };
        let along = |axis: usize| column(&|p| places[p as usize][axis] - grid.origin[axis]);
        let coarse = [along(0), along(1), along(2), column(&|p| seen[p as usize].radius)];
        grid.coarse = coarse;
        grid
    }

    /// A place in all lanes, and a radius that is larger by the errors of coarse distances.
    #[inline(always)]
    fn coarse<L: Lanes<Real = f32>>(&self, lanes: L, place: Vec3, radius: f64) -> ([Num<L>; 3], Num<L>) {
        let along = |axis: usize| Num::splat(lanes, place[axis] - self.origin[axis]);
        ([along(0), along(1), along(2)], Num::splat(lanes, radius + self.error))
    }

    /// Which of the pebbles from a place of the grid on may touch a sphere, one bit per lane.
    #[inline(always)]
    fn near<L: Lanes<Real = f32>>(&self, lanes: L, at: usize, centre: [Num<L>; 3], radius: Num<L>) -> u32 {
        let [x, y, z, radii] = &self.coarse;
        let mut square = Num::splat(lanes, 0.0);
        for (axis, column) in [x, y, z].into_iter().enumerate() {
            let apart = Num::load(lanes, &column[at..at + L::WIDTH]) - centre[axis];
            let apart = apart.max(-apart);
            let apart = apart.min(apart.alike(self.periods[axis]) - apart);
            square = apart.fma(apart, square);
        }
        let reach = Num::load(lanes, &radii[at..at + L::WIDTH]) + radius;
        lanes.bits(square.less(reach * reach))
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

    /// Pebbles of every cell that meets a box, each once, as ranges of their numbers: a range has the cells of a row.
    fn runs(&self, low: Vec3, high: Vec3, runs: &mut Vec<Range<usize>>) {
        runs.clear();
        if self.pebbles.is_empty() {
            return;
        }
        let [across, along, up] = [0, 1, 2].map(|axis| self.cells(axis, low[axis], high[axis]));
        let wrap = |axis: usize, c: i64| if self.periodic[axis] { c.rem_euclid(self.dims[axis]) } else { c };
        for z in up.0..=up.1 {
            for y in along.0..=along.1 {
                let (y, z, mut x) = (wrap(1, y), wrap(2, z), across.0);
                while x <= across.1 {
                    // up to the end of the row, from where it goes on at the beginning
                    let from = wrap(0, x);
                    let to = (from + across.1 - x).min(self.dims[0] - 1);
                    x += to - from + 1;
                    let run = self.start[self.index([from, y, z])]..self.start[self.index([to, y, z]) + 1];
                    if !run.is_empty() {
                        runs.push(run.start as usize..run.end as usize);
                    }
                }
            }
        }
    }

    /// First and last cell between two coordinates along an axis; not wrapped into the period.
    fn cells(&self, axis: usize, low: f64, high: f64) -> (i64, i64) {
        let at = |x: f64| ((x - self.origin[axis]) / self.size[axis]).floor();
        let (low, high, n) = (at(low), at(high), self.dims[axis]);
        if !self.periodic[axis] {
            ((low.max(0.0) as i64).min(n), (high as i64).min(n - 1))
        } else if high - low + 1.0 >= n as f64 {
            (0, n - 1)
        } else {
            (low as i64, high as i64)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places that look random, from 0 to 1.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 7u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn pebbles(count: u32, [length, width, height]: [f64; 3]) -> Vec<Seen> {
        let mut next = numbers();
        let mut of = |body: u32| {
            let offset = [length * next(), width * next(), height * next()];
            Seen { cell: [0; 3], offset, radius: 0.008 + 0.03 * next().powi(4), body: body / 2 }
        };
        (0..count).map(&mut of).collect()
    }

    /// Every pair of pebbles of two bodies, tried one by one.
    fn tried(domain: &Domain, seen: &[Seen], skin: f64) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        for (a, me) in seen.iter().enumerate() {
            for (b, it) in seen.iter().enumerate().skip(a + 1).filter(|(_, it)| it.body != me.body) {
                let apart = domain.between((me.cell, me.offset), (it.cell, it.offset));
                if dot(apart, apart) < (me.radius + it.radius + skin).powi(2) {
                    pairs.push((a as u32, b as u32));
                }
            }
        }
        pairs
    }

    #[test]
    fn pairs_are_those_of_all_pebbles_tried_one_by_one() {
        let sides = [2.0, 0.7, 0.4];
        let domains = [
            Domain::open(),
            Domain::open().periodic(0, sides[0]),
            Domain::open().periodic(0, sides[0]).periodic(1, sides[1]),
        ];
        let seen = pebbles(3000, sides);
        for domain in domains {
            let found = Grids::new(&domain, &seen, 0.002).pairs(0.002).unwrap();
            let mut found: Vec<(u32, u32)> =
                found.iter().flatten().map(|pair| (pair.first.min(pair.second), pair.first.max(pair.second))).collect();
            found.sort_unstable();
            let tried = tried(&domain, &seen, 0.002);
            assert!(tried.len() > 1000, "{}", tried.len());
            assert_eq!(found, tried, "{domain:?}");
        }
    }
}
