//! Gradings: sieve curves, and the part of them that is modelled.

use super::Given;
use crate::solvers::granular::grains::{Curve, GradingError};
use serde::{Deserialize, Serialize};

/// A grading: its curve, and the sizes between which grains are modelled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grading {
    pub name: String,
    pub passing: Passing,
    /// Sizes below and above which grains are not modelled, m; the curve has grains in between.
    pub cut_below: Option<Given>,
    pub cut_above: Option<Given>,
}

/// Share of the mass in grains below a size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Passing {
    /// Size, m, and share of the mass that passes, 0 .. 1: sizes ascend, shares do not fall. Between two sieves the
    /// share is linear in the logarithm of the size.
    Sieves(Vec<[f64; 2]>),
    /// The logarithm of the size is normally distributed by mass.
    LogNormal {
        /// Size at which half of the mass is finer, m.
        median: f64,
        /// Standard deviation of the natural logarithm of the size.
        spread: f64,
    },
}

impl Passing {
    /// Share of the mass in grains below a size, m.
    pub fn share(&self, size: f64) -> f64 {
        match self {
            Passing::Sieves(sieves) => {
                let after = sieves.partition_point(|sieve| sieve[0] <= size);
                match (after.checked_sub(1).map(|i| sieves[i]), sieves.get(after)) {
                    (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (size / a[0]).ln() / (b[0] / a[0]).ln(),
                    (Some(last), None) => last[1],
                    (None, Some(first)) => first[1],
                    (None, None) => 0.0,
                }
            }
            Passing::LogNormal { median, spread } => normal((size / median).ln() / spread),
        }
    }

    /// Size below which a share of the mass lies, m; the smallest such size if the curve is constant there.
    pub fn size(&self, share: f64) -> f64 {
        match self {
            Passing::Sieves(sieves) => {
                let at = sieves.partition_point(|sieve| sieve[1] < share);
                match (at.checked_sub(1).map(|i| sieves[i]), sieves.get(at)) {
                    (Some(a), Some(b)) => a[0] * (b[0] / a[0]).powf((share - a[1]) / (b[1] - a[1])),
                    (Some(end), None) => end[0],
                    (None, Some(end)) => end[0],
                    (None, None) => 0.0,
                }
            }
            Passing::LogNormal { median, spread } => median * (spread * normal_quantile(share)).exp(),
        }
    }

    /// Size of the smallest and of the largest grain of the whole curve, m; `None` for a log-normal curve.
    pub fn ends(&self) -> [f64; 2] {
        match self {
            Passing::Sieves(sieves) => {
                let first = sieves.iter().rev().find(|sieve| sieve[1] <= 0.0).or(sieves.first());
                [first.map_or(0.0, |sieve| sieve[0]), self.size(sieves.last().map_or(1.0, |sieve| sieve[1]))]
            }
            Passing::LogNormal { .. } => [0.0, f64::INFINITY],
        }
    }
}

/// Share of the mass at each end of a log-normal curve that is left out.
const TAIL: f64 = 1e-3;

impl Grading {
    /// The grading of grains that are larger by a factor.
    pub fn scaled(self, factor: f64) -> Grading {
        let cut = |cut: Option<Given>| cut.map(|cut| Given { value: *cut * factor, ..cut });
        let passing = match self.passing {
            Passing::Sieves(sieves) => {
                Passing::Sieves(sieves.into_iter().map(|[size, share]| [size * factor, share]).collect())
            }
            Passing::LogNormal { median, spread } => Passing::LogNormal { median: median * factor, spread },
        };
        Grading { passing, cut_below: cut(self.cut_below), cut_above: cut(self.cut_above), ..self }
    }

    /// Size of the smallest modelled grain, m.
    pub fn smallest(&self) -> f64 {
        self.cut_below.map_or(0.0, |cut| *cut).max(self.passing.ends()[0])
    }

    /// Size of the largest modelled grain, m.
    pub fn largest(&self) -> f64 {
        self.cut_above.map_or(f64::INFINITY, |cut| *cut).min(self.passing.ends()[1])
    }

    /// The modelled curve for sampling. A log-normal curve has so many points that the error of the mass is at most one
    /// in ten thousand; the [`TAIL`] at an end without a cut is left out.
    pub fn curve(&self) -> Result<Curve, GradingError> {
        let (smallest, largest) = match self.passing {
            Passing::Sieves(_) => (self.smallest(), self.largest()),
            Passing::LogNormal { .. } => {
                (self.smallest().max(self.passing.size(TAIL)), self.largest().min(self.passing.size(1.0 - TAIL)))
            }
        };
        let inner: Vec<f64> = match &self.passing {
            Passing::Sieves(sieves) => sieves.iter().map(|sieve| sieve[0]).collect(),
            Passing::LogNormal { .. } => {
                (1..200).map(|k| smallest * (largest / smallest).powf(f64::from(k) / 200.0)).collect()
            }
        };
        let inner = inner.into_iter().filter(|size| smallest < *size && *size < largest);
        let sizes = [smallest].into_iter().chain(inner).chain([largest]);
        let points: Vec<[f64; 2]> = sizes.map(|size| [size, self.passing.share(size)]).collect();
        Curve::new(&points)
    }

    /// Share of the mass that is modelled; the rest is cut off.
    pub fn modelled_share(&self) -> f64 {
        self.passing.share(self.largest()) - self.passing.share(self.smallest())
    }

    /// Share of the modelled mass in grains below a size, m.
    pub fn modelled_below(&self, size: f64) -> f64 {
        let below = self.passing.share(size) - self.passing.share(self.smallest());
        (below / self.modelled_share()).clamp(0.0, 1.0)
    }

    /// Size below which a percentage of the modelled mass lies, m: D10, D50, D60, D90.
    pub fn d(&self, percent: f64) -> f64 {
        let share = self.passing.share(self.smallest()) + 0.01 * percent * self.modelled_share();
        self.passing.size(share).clamp(self.smallest(), self.largest())
    }

    /// Coefficient of uniformity of the modelled curve, D60 / D10.
    pub fn uniformity(&self) -> f64 {
        self.d(60.0) / self.d(10.0)
    }
}

/// The standard normal distribution: 1/2 + phi(z) (z + z^3/3 + z^5/(3 5) + ...), G. Marsaglia, "Evaluating the normal
/// distribution", J. Stat. Softw. 11(4), 2004.
fn normal(z: f64) -> f64 {
    if z.abs() > 8.0 {
        return if z > 0.0 { 1.0 } else { 0.0 };
    }
    let (mut sum, mut term, mut n) = (z, z, 1.0);
    while term.abs() > 1e-17 * sum.abs() {
        n += 2.0;
        term *= z * z / n;
        sum += term;
    }
    0.5 + sum * (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()
}

/// The value at which [`normal`] reaches a share, by bisection.
fn normal_quantile(share: f64) -> f64 {
    let (mut low, mut high) = (-8.0, 8.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if normal(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grading(passing: Passing, cuts: [Option<f64>; 2]) -> Grading {
        let [cut_below, cut_above] = cuts.map(|cut| cut.map(Given::derived));
        Grading { name: "stone".into(), passing, cut_below, cut_above }
    }

    #[test]
    fn a_curve_is_straight_over_the_logarithm_of_the_size() {
        let whole = grading(Passing::Sieves(vec![[0.01, 0.0], [0.1, 1.0]]), [None, None]);
        assert_eq!((whole.smallest(), whole.largest(), whole.modelled_share()), (0.01, 0.1, 1.0));
        for percent in [10.0, 50.0, 60.0, 90.0] {
            let expected = 0.01 * 10f64.powf(0.01 * percent);
            assert!((whole.d(percent) / expected - 1.0).abs() < 1e-12, "D{percent}");
        }
        assert!((whole.uniformity() - 10f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_cut_keeps_the_shape_of_what_is_left() {
        // the paper's sub-ballast, straight from 0.1 to 150 mm: little is left above 25 mm
        let cut = grading(Passing::Sieves(vec![[1e-4, 0.0], [0.15, 1.0]]), [Some(0.025), None]);
        assert!((cut.modelled_share() - 6f64.ln() / 1500f64.ln()).abs() < 1e-12);
        assert_eq!((cut.d(0.0), cut.d(100.0)), (0.025, 0.15));
        assert!((cut.d(50.0) - 0.025 * 6f64.sqrt()).abs() < 1e-12);
        assert!((cut.modelled_below(cut.d(30.0)) - 0.3).abs() < 1e-12);
        assert_eq!((cut.modelled_below(0.01), cut.modelled_below(0.2)), (0.0, 1.0));
    }

    #[test]
    fn level_parts_of_a_curve_hold_no_grains() {
        let gap = grading(
            Passing::Sieves(vec![[0.001, 0.0], [0.002, 0.0], [0.004, 0.4], [0.02, 0.4], [0.04, 1.0], [0.06, 1.0]]),
            [None, None],
        );
        assert_eq!((gap.smallest(), gap.largest()), (0.002, 0.04));
        assert!((gap.d(40.0) - 0.004).abs() < 1e-12);
    }

    #[test]
    fn a_normal_share_is_that_of_the_tables() {
        for (z, share) in [(0.0, 0.5), (1.0, 0.841344746068543), (-1.96, 0.024997895148220), (3.0, 0.998650101968370)] {
            assert!((normal(z) - share).abs() < 1e-12, "{z}");
            assert!((normal_quantile(share) - z).abs() < 1e-9, "{z}");
        }
        let ballast = grading(Passing::LogNormal { median: 0.04, spread: 0.3 }, [Some(0.02), Some(0.08)]);
        assert!((ballast.modelled_share() - (2.0 * normal(2f64.ln() / 0.3) - 1.0)).abs() < 1e-12);
        assert!((ballast.d(50.0) / 0.04 - 1.0).abs() < 1e-9);
    }

    fn curves() -> impl Strategy<Value = Grading> {
        let sieves = prop::collection::vec((0.05..1.5f64, 0.0..1.0f64), 1..8).prop_map(|steps| {
            let total: f64 = steps.iter().map(|s| s.1).sum::<f64>() + 1e-3;
            let mut sieve = [1e-3, 0.0];
            let mut sieves = vec![sieve];
            for (ratio, share) in &steps {
                sieve = [sieve[0] * (1.0 + ratio), sieve[1] + share / total];
                sieves.push(sieve);
            }
            sieves.push([2.0 * sieve[0], 1.0]);
            Passing::Sieves(sieves)
        });
        let log_normal = (1e-3..0.1f64, 0.1..1.0f64).prop_map(|(median, spread)| Passing::LogNormal { median, spread });
        (prop_oneof![sieves, log_normal], 0.02..0.4f64, 0.6..0.98f64).prop_map(|(passing, low, high)| {
            let cuts = [Some(passing.size(low)), Some(passing.size(high))];
            grading(passing, cuts)
        })
    }

    proptest! {
        #[test]
        fn share_and_size_are_each_others_inverse(stone in curves(), percent in 0.0..100.0f64) {
            prop_assert!(stone.modelled_share() > 0.0 && stone.modelled_share() <= 1.0);
            let size = stone.d(percent);
            prop_assert!(stone.smallest() <= size && size <= stone.largest());
            prop_assert!((stone.modelled_below(size) - 0.01 * percent).abs() < 1e-7);
        }

        #[test]
        fn the_curve_of_samples_is_that_of_the_grading(stone in curves(), percent in 0.0..100.0f64) {
            let curve = stone.curve().unwrap();
            prop_assert!((curve.modelled() - stone.modelled_share()).abs() < 1e-9);
            let size = stone.d(percent);
            prop_assert!((curve.below(size) - stone.modelled_below(size)).abs() < 1e-3);
        }

        #[test]
        fn more_mass_is_finer_than_a_larger_size(stone in curves(), a in 0.0..100.0f64, b in 0.0..100.0f64) {
            let (small, large) = (stone.d(a.min(b)), stone.d(a.max(b)));
            prop_assert!(small <= large);
            prop_assert!(stone.modelled_below(small) <= stone.modelled_below(large) + 1e-12);
        }
    }
}
