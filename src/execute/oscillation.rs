//! Signs that an exchange overshoots, from its settlement along the track.
//!
//! An exchange is explicit: a disturbance e of the settlement comes back as (1 - A) e. A is the change of a block's
//! settlement divided by the movement e of the track. An equal movement everywhere changes no force and gives no
//! information; short waves change most. So A is taken of second differences along x, in which the far field vanishes
//! and a sawtooth counts sixteenfold: A = -<D g, D s> / <D s, D s>, s the move of the seats and g the change of the
//! block's settlement that follows from it. A < 1 is monotone, A > 1 overshoots, A > 2 grows.

use std::ops::Range;

/// Second differences below this share of the movement belong to an even track and give no information.
const EVEN: f64 = 1e-3;

/// The amplification A, see above; `None` if the track moved too evenly to tell. Both cover every seat, also seats that
/// cannot settle: beside these the track bends most.
pub(super) fn amplification(moved: &[f64], change: &[f64]) -> Option<f64> {
    let (of_move, of_change) = (bends(moved), bends(change));
    let sharpest = of_move.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
    if sharpest <= EVEN * largest(moved) {
        return None;
    }
    let product: f64 = of_move.iter().zip(&of_change).map(|(a, b)| a * b).sum();
    let square: f64 = of_move.iter().map(|d| d * d).sum();
    Some(-product / square)
}

/// Sawtooth amplitude of settlement along each of `runs`, runs of neighbouring seats that can settle, relative to the
/// largest settlement. Only second differences that change sign from seat to seat four times in a row count: a dip has
/// fewer changes of sign, and rounding noise has no amplitude.
pub(super) fn sawtooth(runs: &[Range<usize>], settled: &[f64]) -> f64 {
    let most = largest(settled);
    if most <= 0.0 {
        return 0.0;
    }
    let amplitude = |window: &[f64]| {
        let alternates = window.windows(2).all(|pair| pair[0] * pair[1] < 0.0);
        if alternates { window.iter().fold(f64::INFINITY, |least, d| least.min(d.abs())) / 4.0 } else { 0.0 }
    };
    let of_run =
        |run: &Range<usize>| bends(&settled[run.clone()]).windows(ALTERNATIONS).map(amplitude).fold(0.0, f64::max);
    runs.iter().map(of_run).fold(0.0, f64::max) / most
}

/// Largest settlement of a seat beside the mean of its two neighbours, along each of `runs`, runs of neighbouring seats
/// that can settle; in the unit of the settlement.
pub(super) fn beside_neighbours(runs: &[Range<usize>], settled: &[f64]) -> f64 {
    runs.iter().map(|run| largest(&bends(&settled[run.clone()])) / 2.0).fold(0.0, f64::max)
}

/// Second differences in a row that make a sawtooth.
const ALTERNATIONS: usize = 5;

/// Second differences.
pub(super) fn bends(values: &[f64]) -> Vec<f64> {
    values.windows(3).map(|w| w[0] - 2.0 * w[1] + w[2]).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_that_comes_back_has_its_amplification() {
        let moved: Vec<f64> = (0..40).map(|i| 1e-3 + 1e-4 * (0.7 * f64::from(i)).sin()).collect();
        for factor in [0.0, 0.4, 1.0, 2.5] {
            let change: Vec<f64> = moved.iter().map(|s| -factor * (s - 1e-3)).collect();
            assert!((amplification(&moved, &change).unwrap() - factor).abs() < 1e-9);
        }
        assert_eq!(amplification(&[1e-3; 40], &moved), None, "an even move");
        assert_eq!(amplification(&[0.0; 40], &moved), None, "no move");
    }

    /// One stretch of all seats.
    fn along(settled: &[f64]) -> f64 {
        sawtooth(std::slice::from_ref(&(0..settled.len())), settled)
    }

    #[test]
    fn only_a_sawtooth_is_one() {
        let tooth = |size: f64| (0..30).map(|i| 1e-3 + size * f64::from(1 - 2 * (i % 2))).collect::<Vec<f64>>();
        let found = along(&tooth(2e-4));
        assert!((found - 2e-4 / 1.2e-3).abs() < 1e-9, "{found}");
        assert!(along(&tooth(1e-18)) < 1e-12, "rounding noise");
        let dip: Vec<f64> = (0..30).map(|i| 1e-3 * (-(f64::from(i) - 22.0).powi(2)).exp()).collect();
        assert_eq!(along(&dip), 0.0, "a dip over a sleeper or two");
        let edge: Vec<f64> = [1.0, 1.0, 1.0, 1.05, 1.2, 0.6, 0.1].map(|s| s * 1e-3).to_vec();
        assert_eq!(along(&edge), 0.0, "the edge of a transition");
        assert_eq!(along(&[0.0; 30]), 0.0);
        assert_eq!(sawtooth(&[0..2, 2..4], &tooth(2e-4)), 0.0, "too few neighbours");
    }

    #[test]
    fn a_seat_settles_beside_its_neighbours() {
        let mut settled = [2e-3; 6];
        settled[5] = 0.0;
        let ballasted = std::slice::from_ref(&(0..5));
        assert_eq!(beside_neighbours(ballasted, &settled), 0.0, "even up to the slab");
        settled[2] = 7e-3;
        assert!((beside_neighbours(ballasted, &settled) - 5e-3).abs() < 1e-12);
        assert_eq!(beside_neighbours(&[0..2, 2..4], &settled), 0.0, "too few neighbours");
    }
}
