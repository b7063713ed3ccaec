//! Sobol sequences with a random digital shift.

use super::random::SplitMix;

/// Directions that the table below has.
pub const SOBOL_DIMENSIONS: usize = 21;

const BITS: usize = 32;

/// Primitive polynomials (the bits between the first and the last coefficient) and first direction numbers of
/// directions 2 to 21: Joe and Kuo (2008), SIAM Journal on Scientific Computing 30, 2635-2654, table `new-joe-kuo-6`.
const TABLE: [(u32, &[u32]); SOBOL_DIMENSIONS - 1] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// The first `n` points in `d` directions, at most [`SOBOL_DIMENSIONS`]. The shift by `seed` keeps every point inside
/// its own box, and moves the first point away from the corner.
pub fn sobol(n: usize, d: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = SplitMix::new(seed);
    let directions: Vec<([u32; BITS], u32)> =
        (0..d.min(SOBOL_DIMENSIONS)).map(|axis| (directions(axis), random.next() as u32)).collect();
    let coordinate = |index: usize, (directions, shift): &([u32; BITS], u32)| {
        let gray = index ^ (index >> 1);
        let set = directions.iter().enumerate().filter(|(bit, _)| gray >> bit & 1 == 1);
        let x = set.fold(*shift, |x, (_, direction)| x ^ direction);
        (f64::from(x) + 0.5) / (1_u64 << BITS) as f64
    };
    (0..n).map(|index| directions.iter().map(|axis| coordinate(index, axis)).collect()).collect()
}

/// Direction numbers of one axis, as fractions of 2^32; Joe and Kuo (2008), equations 2 and 3.
fn directions(axis: usize) -> [u32; BITS] {
    let place = |bit: usize| BITS - 1 - bit;
    let mut v = [0; BITS];
    let Some(&(polynomial, first)) = axis.checked_sub(1).map(|i| &TABLE[i]) else {
        v.iter_mut().enumerate().for_each(|(bit, v)| *v = 1 << place(bit));
        return v;
    };
    let degree = first.len();
    for bit in 0..BITS {
        v[bit] = if bit < degree {
            first[bit] << place(bit)
        } else {
            let before = v[bit - degree] ^ (v[bit - degree] >> degree);
            let chosen = (1..degree).filter(|k| polynomial >> (degree - 1 - k) & 1 == 1);
            chosen.fold(before, |x, k| x ^ v[bit - k])
        };
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the published sequence, unshifted, in eighths.
    #[test]
    fn the_sequence_is_the_published_one() {
        let unshifted = |index: usize, axis: usize| {
            let (v, gray) = (directions(axis), index ^ (index >> 1));
            let x = (0..BITS).filter(|bit| gray >> bit & 1 == 1).fold(0, |x, bit| x ^ v[bit]);
            f64::from(x) / (1_u64 << BITS) as f64
        };
        let eighths = |index: usize, d: usize| (0..d).map(|axis| unshifted(index, axis) * 8.0).collect::<Vec<_>>();
        assert_eq!(eighths(1, 4), [4.0; 4]);
        assert_eq!(eighths(2, 4), [6.0, 2.0, 2.0, 2.0]);
        assert_eq!(eighths(4, 4), [3.0, 3.0, 5.0, 7.0]);
        let fifth = [7, 7, 1, 3, 7, 5, 7, 3, 3, 1, 3, 7, 7, 1, 7, 3, 7, 3, 3, 5, 5].map(f64::from);
        assert_eq!(eighths(5, SOBOL_DIMENSIONS), fifth);
    }

    #[test]
    fn first_direction_numbers_are_odd_and_small() {
        for (_, first) in TABLE {
            assert!(first.iter().enumerate().all(|(i, m)| m % 2 == 1 && *m < 2 << i));
        }
    }
}
