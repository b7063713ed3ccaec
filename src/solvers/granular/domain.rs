//! Space of the bodies: open or periodic in each direction, divided along x into bays.
//!
//! A position is a cell and an offset in the cell. Copies of a bay have equal offsets, so the arithmetic between
//! neighbours is the same in every copy, bit by bit.

use serde::{Deserialize, Serialize};

/// Cells of the domain along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Domain {
    /// Length of a cell \[m\]; none if the axis is one open cell.
    lengths: [Option<f64>; 3],
    /// Number of cells in a period of the axis; none if the axis is not periodic.
    counts: [Option<u32>; 3],
}

/// Relative cells of two bodies, -1, 0 or 1 along each axis; 0 is the same cell.
pub type Image = u8;

impl Default for Domain {
    fn default() -> Self {
        Domain::open()
    }
}

impl Domain {
    /// Open in all directions.
    pub fn open() -> Domain {
        Domain { lengths: [None; 3], counts: [None; 3] }
    }

    /// Periodic along `axis` (0, 1, 2 for x, y, z) with the period `length` \[m\], which a bed checks.
    pub fn periodic(mut self, axis: usize, length: f64) -> Domain {
        (self.lengths[axis], self.counts[axis]) = (Some(length), Some(1));
        self
    }

    /// `count` bays of `length` \[m\] along x; the last bay is next to the first.
    pub fn periodic_bays(mut self, length: f64, count: u32) -> Domain {
        self = self.periodic(0, length);
        self.counts[0] = Some(count);
        self
    }

    /// Bays of `length` \[m\] along an open x.
    pub fn bays(mut self, length: f64) -> Domain {
        (self.lengths[0], self.counts[0]) = (Some(length), None);
        self
    }

    /// Period of an axis \[m\].
    pub fn period(&self, axis: usize) -> Option<f64> {
        self.counts[axis].and_then(|n| self.lengths[axis].map(|l| l * f64::from(n)))
    }

    /// Length of a cell \[m\].
    pub fn cell_length(&self, axis: usize) -> Option<f64> {
        self.lengths[axis]
    }

    /// Cells in a period.
    pub fn cells(&self, axis: usize) -> Option<u32> {
        self.counts[axis]
    }

    /// Cell and offset of a position \[m\].
    pub fn split(&self, place: [f64; 3]) -> ([i32; 3], [f64; 3]) {
        self.settle([0; 3], place)
    }

    /// Cell and offset after the offset is moved back into its cell.
    pub(super) fn settle(&self, mut cell: [i32; 3], mut offset: [f64; 3]) -> ([i32; 3], [f64; 3]) {
        for axis in 0..3 {
            if let Some(length) = self.lengths[axis] {
                let steps = (offset[axis] / length).floor();
                if steps != 0.0 {
                    cell[axis] += steps as i32;
                    offset[axis] -= steps * length;
                }
            }
        }
        (cell, offset)
    }

    /// Whether an offset is in its cell, or outside by less than a quarter of the cell length.
    pub(super) fn near_cell(&self, offset: [f64; 3]) -> bool {
        (0..3).all(|axis| self.lengths[axis].is_none_or(|l| (-0.25 * l..1.25 * l).contains(&offset[axis])))
    }

    /// Position of an offset in a cell \[m\], not wrapped into the period.
    pub fn place(&self, cell: [i32; 3], offset: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| offset[axis] + self.lengths[axis].map_or(0.0, |l| l * f64::from(cell[axis])))
    }

    /// The cell within the period.
    pub(super) fn wrap(&self, cell: [i32; 3]) -> [i32; 3] {
        [0, 1, 2].map(|axis| self.counts[axis].map_or(cell[axis], |n| cell[axis].rem_euclid(n as i32)))
    }

    /// Number of cells from `b` to `a` the shorter way; `apart` is the difference of their offsets.
    fn steps(&self, axis: usize, a: i32, b: i32, apart: f64) -> Option<i32> {
        let Some(length) = self.lengths[axis] else { return Some(0) };
        let steps = match self.counts[axis] {
            None => a - b,
            Some(n) => {
                let period = length * f64::from(n);
                let raw = a - b;
                raw - rounds(f64::from(raw) * length + apart, period) * n as i32
            }
        };
        (-1..=1).contains(&steps).then_some(steps)
    }

    /// Shift of the first of two neighbours; none if they are more than a cell apart.
    pub(super) fn image(&self, a: ([i32; 3], [f64; 3]), b: ([i32; 3], [f64; 3])) -> Option<Image> {
        let mut image = 0;
        for axis in 0..3 {
            let steps = self.steps(axis, a.0[axis], b.0[axis], a.1[axis] - b.1[axis])?;
            image |= ((steps & 3) as u8) << (2 * axis);
        }
        Some(image)
    }

    /// Shift of an image \[m\].
    pub(super) fn shift(&self, image: Image) -> [f64; 3] {
        let steps = steps_of(image);
        [0, 1, 2].map(|axis| self.lengths[axis].map_or(0.0, |l| l * f64::from(steps[axis])))
    }

    /// Vector from `b` to `a` the shortest way \[m\].
    #[inline(always)]
    pub(super) fn between(&self, a: ([i32; 3], [f64; 3]), b: ([i32; 3], [f64; 3])) -> [f64; 3] {
        // no closure: it would be called as a function where lanes are in use
        let mut between = [0.0; 3];
        for (axis, between) in between.iter_mut().enumerate() {
            let apart = a.1[axis] - b.1[axis];
            *between = apart;
            if let Some(length) = self.lengths[axis] {
                let mut steps = a.0[axis] - b.0[axis];
                if let Some(n) = self.counts[axis] {
                    let period = length * f64::from(n);
                    steps -= rounds(f64::from(steps) * length + apart, period) * n as i32;
                }
                *between = apart + length * f64::from(steps);
            }
        }
        between
    }
}

/// Number of whole periods nearest to a distance. Most neighbours are less than half a period apart: for them the
/// division is spared, which took a fifth of the search.
#[inline(always)]
fn rounds(distance: f64, period: f64) -> i32 {
    if 2.0 * distance.abs() < period { 0 } else { (distance / period).round() as i32 }
}

/// Steps of an image along each axis.
pub(super) fn steps_of(image: Image) -> [i32; 3] {
    [0, 1, 2].map(|axis| match (image >> (2 * axis)) & 3 {
        3 => -1,
        steps => i32::from(steps),
    })
}

/// The image seen from the other body.
pub(super) fn mirrored(image: Image) -> Image {
    steps_of(image).iter().enumerate().fold(0, |code, (axis, &s)| code | (((-s & 3) as u8) << (2 * axis)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_go_the_shorter_way_round() {
        let domain = Domain::open().periodic_bays(0.6, 5).periodic(1, 1.2);
        let (a, b) = (domain.split([0.01, 1.19, 7.0]), domain.split([2.99, 0.02, 6.0]));
        let image = domain.image(a, b).unwrap();
        assert_eq!(steps_of(image), [1, -1, 0]);
        assert_eq!(steps_of(mirrored(image)), [-1, 1, 0]);
        let shift = domain.shift(image);
        let between = domain.between(a, b);
        for axis in 0..3 {
            assert!((a.1[axis] - b.1[axis] + shift[axis] - between[axis]).abs() < 1e-15);
        }
        assert!((between[0] - 0.02).abs() < 1e-12 && (between[1] + 0.03).abs() < 1e-12, "{between:?}");
    }

    #[test]
    fn offsets_are_equal_in_every_bay() {
        let domain = Domain::open().bays(0.6);
        let (cell, offset) = domain.split([-0.25, 3.0, 0.0]);
        assert_eq!((cell, offset[1]), ([-1, 0, 0], 3.0));
        assert!((offset[0] - 0.35).abs() < 1e-15);
        assert!((domain.place(cell, offset)[0] + 0.25).abs() < 1e-15);
    }
}
