//! The order of bodies in memory.
//!
//! Contacts read both their bodies, so bodies in contact should be close in memory. In strips they are: a neighbour is
//! at most one slice away, which the cache still holds, and only the few contacts between strips are far apart.
//! Space-filling curves (Morton) have eight times as many distant contacts; a step of 100,000 spheres is a tenth faster
//! with strips.

use super::vector::{Vec3, sub};

/// Strips along the longest side of the bed, each divided into thin slices.
pub(super) struct Strips {
    least: Vec3,
    /// Axes, the longest first.
    axes: [usize; 3],
    /// Mean distance of bodies \[m\].
    spacing: f64,
    /// Width and height of a strip \[m\].
    sides: [f64; 2],
}

/// Number of bodies across a strip: two slices of this number squared, with all their data, fit into a cache of 1 MB.
const ACROSS: f64 = 24.0;
/// Thickness of a slice divided by the mean distance of bodies.
const SLICE: f64 = 1.0;

impl Strips {
    pub fn through(places: impl Iterator<Item = Vec3>) -> Strips {
        let (mut least, mut most, mut count) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0);
        for place in places {
            for c in 0..3 {
                (least[c], most[c]) = (least[c].min(place[c]), most[c].max(place[c]));
            }
            count += 1.0;
        }
        let extent = sub(most, least);
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
        // a flat bed must have a spacing, too
        let spacing = extent.map(|e| e.max(1e-3 * extent[axes[0]])).iter().product::<f64>() / count;
        let spacing = spacing.cbrt().max(f64::MIN_POSITIVE);
        // the bed of a track is wide and flat, and still one strip: contacts between strips cost most
        let one = extent[axes[1]].max(spacing) * extent[axes[2]].max(spacing) <= (ACROSS * spacing).powi(2);
        let strips = |axis: usize| if one { 1.0 } else { (extent[axis] / (ACROSS * spacing)).ceil().max(1.0) };
        // slightly more than the whole, otherwise the last body would be a separate strip
        let side = |axis: usize| 1.001 * extent[axis].max(spacing) / strips(axis);
        Strips { least, axes, spacing, sides: [side(axes[1]), side(axes[2])] }
    }

    /// Strip, slice and row of a position, as a number for sorting.
    pub fn key(&self, place: Vec3) -> u64 {
        let [along, wide, high] = self.axes.map(|axis| place[axis] - self.least[axis]);
        let part = |length: f64, of: f64, bits: u32| ((length / of).max(0.0) as u64).min((1 << bits) - 1);
        let strip = part(wide, self.sides[0], 14) << 14 | part(high, self.sides[1], 14);
        let row = wide % self.sides[0];
        strip << 36 | part(along, SLICE * self.spacing, 26) << 10 | part(row, self.spacing, 10)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_bed_is_one_strip_sorted_along_its_length() {
        let places: Vec<Vec3> = (0..4000)
            .map(|k| [0.1 * f64::from(k % 10), 0.1 * f64::from(k / 100), 0.1 * f64::from(k / 10 % 10)])
            .collect();
        let strips = Strips::through(places.iter().copied());
        let mut sorted = places.clone();
        sorted.sort_by_key(|&place| strips.key(place));
        assert_eq!(strips.axes[0], 1);
        assert!(sorted.windows(2).all(|pair| pair[0][1] <= pair[1][1] + strips.spacing));
    }

    #[test]
    fn flat_and_single_beds_have_an_order() {
        for places in [vec![[1.0, 2.0, 3.0]], vec![[0.0; 3], [1.0, 0.0, 0.0]], vec![[0.0; 3], [1.0, 1.0, 0.0]]] {
            let strips = Strips::through(places.iter().copied());
            assert!(strips.spacing > 0.0 && strips.sides.iter().all(|s| *s > 0.0));
            let keys: Vec<u64> = places.iter().map(|&p| strips.key(p)).collect();
            assert!(keys.windows(2).all(|k| k[0] < k[1]), "{keys:?}");
        }
    }
}
