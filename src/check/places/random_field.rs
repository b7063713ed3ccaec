//! A random field along the track that does not depend on the order of its evaluations.
//!
//! Values are normal, with mean 0 and variance 1, and correlated as `exp(-(d / L)^2)` over a distance d. A field with
//! this correlation is smooth. A level with the correlation `exp(-d / L)` would have a corner everywhere, and every
//! corner would hit a wheel.
//!
//! The field is a sum of bells, `exp(-2 (d / L)^2)`, one on each point of a grid that is fixed to chainage 0. The
//! height of a bell is drawn from the seed and the number of its point alone. With four points per correlation length,
//! variance and correlation are exact to 1e-16: the sum omits `exp(-(2 pi)^2)`.

use std::f64::consts::PI;

/// Grid points per correlation length.
const POINTS: f64 = 4.0;
/// Correlation lengths beyond which a bell is below 1e-14.
const REACH: f64 = 4.0;

pub(super) struct RandomField {
    seed: u64,
    /// m.
    correlation: f64,
}

impl RandomField {
    /// The field for a name and a seed; different names have different fields.
    pub fn new(seed: u64, name: &str, correlation: f64) -> RandomField {
        // Fowler, Noll and Vo's hash
        let name = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
        RandomField { seed: mixed(mixed(seed) ^ name), correlation }
    }

    /// The value at a chainage, m.
    pub fn value(&self, x: f64) -> f64 {
        let at = x / self.correlation * POINTS;
        let reach = (REACH * POINTS) as i64;
        let middle = at.round() as i64;
        let bells = (middle - reach..=middle + reach).map(|point| {
            let d = (at - point as f64) / POINTS;
            (-2.0 * d * d).exp() * self.height(point)
        });
        bells.sum::<f64>() / (0.5 * POINTS * PI.sqrt()).sqrt()
    }

    /// A normal number of a grid point, from two even ones (Box and Muller 1958).
    fn height(&self, point: i64) -> f64 {
        let first = mixed(self.seed ^ mixed(point as u64));
        let [u, v] = [first, mixed(first)].map(|bits| ((bits >> 11) as f64 + 0.5) / (1u64 << 53) as f64);
        (-2.0 * u.ln()).sqrt() * (2.0 * PI * v).cos()
    }
}

/// Scatters the bits of a number (Steele, Lea and Flood 2014, `splitmix64`).
fn mixed(number: u64) -> u64 {
    let z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEEDS: u64 = 4000;

    /// Mean of a product over many seeds.
    fn over_seeds(of: impl Fn(&RandomField) -> f64) -> f64 {
        (0..SEEDS).map(|seed| of(&RandomField::new(seed, "open.support.stiffness", 3.0))).sum::<f64>() / SEEDS as f64
    }

    #[test]
    fn many_seeds_have_the_mean_the_variance_and_the_correlation() {
        // the mean of n draws lies within 4 / sqrt(n) of the expected value
        let error = 4.0 / (SEEDS as f64).sqrt();
        for x in [-41.7, 0.0, 0.4, 250.0] {
            assert!(over_seeds(|f| f.value(x)).abs() < error);
            assert!((over_seeds(|f| f.value(x).powi(2)) - 1.0).abs() < error * 2f64.sqrt());
            // a normal number has a fourth moment of 3, and is above 1 in 15.87 % of cases
            assert!((over_seeds(|f| f.value(x).powi(4)) - 3.0).abs() < error * 96f64.sqrt());
            assert!((over_seeds(|f| f64::from(u8::from(f.value(x) > 1.0))) - 0.1587).abs() < error * 0.37);
            for d in [0.6f64, 1.5, 3.0, 6.0] {
                let expected = (-(d / 3.0).powi(2)).exp();
                let found = over_seeds(|f| f.value(x) * f.value(x + d));
                assert!((found - expected).abs() < error * 1.5, "{d} m apart: {found} against {expected}");
            }
        }
    }

    #[test]
    fn one_long_track_has_them_too() {
        let field = RandomField::new(7, "line.irregularity", 2.0);
        let n = 60_000;
        let mean = |of: &dyn Fn(f64) -> f64| (0..n).map(|i| of(f64::from(i) * 0.5)).sum::<f64>() / f64::from(n);
        // 15 000 correlation lengths
        assert!(mean(&|x| field.value(x)).abs() < 0.04);
        assert!((mean(&|x| field.value(x).powi(2)) - 1.0).abs() < 0.05);
        assert!((mean(&|x| field.value(x) * field.value(x + 2.0)) - (-1f64).exp()).abs() < 0.05);
    }

    #[test]
    fn names_and_seeds_are_fields_of_their_own() {
        let pair = |a: (u64, &str), b: (u64, &str)| {
            let (a, b) = (RandomField::new(a.0, a.1, 1.0), RandomField::new(b.0, b.1, 1.0));
            (0..4000).map(|i| f64::from(i) * 2.5).map(|x| a.value(x) * b.value(x)).sum::<f64>() / 4000.0
        };
        assert!((pair((1, "open.pad"), (1, "open.pad")) - 1.0).abs() < 0.1);
        for other in [(2, "open.pad"), (1, "open.pae"), (1, "stiff.pad"), (0, "")] {
            assert!(pair((1, "open.pad"), other).abs() < 0.08, "{other:?}");
        }
    }
}
