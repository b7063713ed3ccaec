//! Latin hypercubes.

use super::random::SplitMix;

/// `n` points in `d` directions: each direction is cut into `n` strata, and each stratum holds one point. McKay,
/// Beckman and Conover (1979), Technometrics 21, 239-245.
pub fn latin_hypercube(n: usize, d: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = SplitMix::new(seed);
    let mut points = vec![vec![0.0; d]; n];
    for axis in 0..d {
        let mut strata: Vec<usize> = (0..n).collect();
        for last in (1..n).rev() {
            strata.swap(last, random.below(last + 1));
        }
        for (point, stratum) in points.iter_mut().zip(strata) {
            point[axis] = (stratum as f64 + random.unit()) / n as f64;
        }
    }
    points
}
