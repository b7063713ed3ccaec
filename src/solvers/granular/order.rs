//! The order of bodies in memory.

use super::vector::{Vec3, sub};

/// A place's cell of that `size` \[m\] as one number: the bits of its three coordinates in turn, so that neighbours are near in
/// memory (Morton). The cells are coarse, for bodies then seldom change places.
pub(super) fn key(place: Vec3, least: Vec3, size: f64) -> u64 {
    let spread = |x: f64| {
        let x = x.clamp(0.0, f64::from((1 << 21) - 1)) as u64;
        (0..21).fold(0u64, |bits, b| bits | (x >> b & 1) << (3 * b))
    };
    let [x, y, z] = sub(place, least).map(|x| spread(x / size));
    x | y << 1 | z << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_cells_of_a_cube_follow_each_other() {
        let corner = |k: u32| [0, 1, 2].map(|c| 0.5 + f64::from(k >> c & 1));
        let keys: Vec<u64> = (0..8).map(|k| key(corner(k), [0.0; 3], 1.0)).collect();
        assert_eq!(keys, [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(key([2.5, 0.5, 0.5], [0.0; 3], 1.0), 8);
    }
}
