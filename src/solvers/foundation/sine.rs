//! A sine that compilers vectorise: arithmetic alone, without a branch.

use std::f64::consts::{FRAC_1_PI, PI};

/// Directions that are computed together.
pub(super) const LANES: usize = 8;

/// Added to a small number, it rounds the number to an integer; the last bit of the sum shows whether the integer is
/// odd.
const ROUNDING: f64 = 1.5 * (1u64 << 52) as f64;

/// 1 / (2 n + 1)! with its sign, from the last term: the remainder is 3e-16 at pi / 2.
const SERIES: [f64; 10] = series();

const fn series() -> [f64; 10] {
    let (mut terms, mut term, mut n) = ([1.0; 10], 1.0, 1);
    while n < 10 {
        term /= -((2 * n * (2 * n + 1)) as f64);
        terms[9 - n] = term;
        n += 1;
    }
    terms
}

/// sin(x) to 1e-15 and 2e-16 x, below 1e9.
#[inline(always)]
pub(super) fn sine(x: f64) -> f64 {
    let halves = x * FRAC_1_PI + ROUNDING;
    let rest = x - (halves - ROUNDING) * PI;
    let square = rest * rest;
    let series = SERIES.iter().fold(0.0, |sum, term| sum * square + term);
    // every odd half turn changes the sign
    f64::from_bits((rest * series).to_bits() ^ (halves.to_bits() << 63))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sine() {
        for i in -200_000..200_000 {
            let x = 0.005 * f64::from(i);
            assert!((sine(x) - x.sin()).abs() < 1e-15 + 2.3e-16 * x.abs(), "sin {x}: {}", sine(x));
        }
        assert_eq!((sine(0.0), sine(1e-9)), (0.0, 1e-9));
    }
}
