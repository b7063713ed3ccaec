//! Integrals of smooth functions with roots at their ends: Gauss-Legendre points under the sine map; intervals are
//! halved if the results disagree.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

const POINTS: usize = 12;

/// Largest number of halvings; the contribution of a jump is then below rounding.
const DEPTH: usize = 40;

/// Places in (0, 1) and weights. Under x = (1 + sin(π t/2))/2 a root at either end becomes smooth.
static RULE: LazyLock<[(f64, f64); POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let (t, weight) = gauss_legendre(k);
        let (s, c) = (FRAC_PI_2 * t).sin_cos();
        (0.5 * (1.0 + s), 0.5 * FRAC_PI_2 * c * weight)
    })
});

/// The k-th root of the Legendre polynomial of degree [`POINTS`] by Newton's method, and its weight on [-1, 1].
fn gauss_legendre(k: usize) -> (f64, f64) {
    let n = POINTS as f64;
    let mut t = -(PI * (k as f64 + 0.75) / (n + 0.5)).cos();
    let mut slope = 0.0;
    for _ in 0..8 {
        let (mut before, mut value) = (1.0, t);
        for degree in 2..=POINTS {
            let d = degree as f64;
            (before, value) = (value, ((2.0 * d - 1.0) * t * value - (d - 1.0) * before) / d);
        }
        slope = n * (t * value - before) / (t * t - 1.0);
        t -= value / slope;
    }
    (t, 2.0 / ((1.0 - t * t) * slope * slope))
}

/// `∫ f dx` over [from, to], halved until no component changes by more than its tolerance.
pub fn integrate<const N: usize>(
    f: &mut impl FnMut(f64) -> [f64; N],
    from: f64,
    to: f64,
    tolerance: &[f64; N],
) -> [f64; N] {
    let whole = panel(f, from, to);
    refine(f, from, to, whole, tolerance, DEPTH)
}

fn refine<const N: usize>(
    f: &mut impl FnMut(f64) -> [f64; N],
    from: f64,
    to: f64,
    whole: [f64; N],
    tolerance: &[f64; N],
    depth: usize,
) -> [f64; N] {
    let middle = from + 0.5 * (to - from);
    let (left, right) = (panel(f, from, middle), panel(f, middle, to));
    let halves = sum(left, right);
    // Values that are not numbers do not continue the halving.
    let apart = (0..N).any(|k| (halves[k] - whole[k]).abs() > tolerance[k]);
    if !apart || depth == 0 {
        return halves;
    }
    let left = refine(f, from, middle, left, tolerance, depth - 1);
    let right = refine(f, middle, to, right, tolerance, depth - 1);
    sum(left, right)
}

fn panel<const N: usize>(f: &mut impl FnMut(f64) -> [f64; N], from: f64, to: f64) -> [f64; N] {
    let length = to - from;
    let mut total = [0.0; N];
    for &(place, weight) in RULE.iter() {
        let value = f(from + place * length);
        for k in 0..N {
            total[k] += weight * length * value[k];
        }
    }
    total
}

fn sum<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|k| a[k] + b[k])
}
