//! Designs: the points of a study. Points are chosen in the unit cube, with one direction per varied value. Each
//! direction is then converted to the values of its axis. A seed gives the same design on every machine.

mod latin;
mod random;
mod sobol;

pub use latin::latin_hypercube;
pub use sobol::{SOBOL_DIMENSIONS, sobol};

use crate::scenario::{Axis, Sampling, Spread, Study, Values};
use crate::units::number;
use statrs::distribution::{ContinuousCDF, Normal};

/// A value at a point of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The value as text for the file.
    pub text: String,
    /// In the unit of the axis; `None` if it is not a number.
    pub number: Option<f64>,
    /// Index into the list of the axis.
    pub choice: Option<usize>,
}

/// The quantile of the standard normal distribution for probability `p`, 0 < p < 1.
pub fn inverse_normal(p: f64) -> f64 {
    Normal::standard().inverse_cdf(p)
}

/// Every point of a study: a value for each axis.
pub fn design(study: &Study, seed: u64) -> Vec<Vec<Level>> {
    let axes = &study.axes;
    let cube = match study.sampling {
        Sampling::Grid => return grid(axes),
        Sampling::LatinHypercube { points } => latin_hypercube(points as usize, axes.len(), seed),
        Sampling::Sobol { points } => sobol(points as usize, axes.len(), seed),
    };
    cube.iter().map(|point| axes.iter().zip(point).map(|(axis, u)| level(axis, *u)).collect()).collect()
}

/// Every combination of the lists; the last axis changes first.
fn grid(axes: &[Axis]) -> Vec<Vec<Level>> {
    axes.iter().fold(vec![Vec::new()], |points, axis| {
        let levels = levels(axis);
        let longer = |point: &Vec<Level>| {
            let point = point.clone();
            levels.clone().into_iter().map(move |level| [point.clone(), vec![level]].concat()).collect::<Vec<_>>()
        };
        points.iter().flat_map(longer).collect()
    })
}

fn levels(axis: &Axis) -> Vec<Level> {
    match &axis.values {
        Values::Listed(choices) => (0..choices.len()).map(|i| listed(axis, i)).collect(),
        Values::Spread(_) => vec![level(axis, 0.5)],
    }
}

fn listed(axis: &Axis, index: usize) -> Level {
    let Values::Listed(choices) = &axis.values else { return level(axis, 0.5) };
    let choice = &choices[index];
    Level { text: choice.text.clone(), number: choice.number, choice: Some(index) }
}

/// The value of an axis at `u` of its distribution, 0 < u < 1.
fn level(axis: &Axis, u: f64) -> Level {
    let x = match &axis.values {
        Values::Listed(choices) => return listed(axis, ((u * choices.len() as f64) as usize).min(choices.len() - 1)),
        Values::Spread(Spread::Uniform { from, to }) => from + u * (to - from),
        Values::Spread(Spread::Normal { mean, deviation }) => mean + deviation * inverse_normal(u),
        Values::Spread(Spread::LogNormal { median, sigma }) => median * (sigma * inverse_normal(u)).exp(),
    };
    // the point is run with six digits, as a person would write them
    let text = format!("{} {}", number(x), axis.unit).trim_end().to_string();
    Level { text, number: number(x).parse().ok(), choice: None }
}

#[cfg(test)]
mod tests {
    use super::random::SplitMix;
    use super::*;
    use crate::diag::{FileId, Span};
    use crate::scenario::Choice;
    use proptest::prelude::*;

    fn axis(values: Values) -> Axis {
        Axis { path: "a".into(), span: Span::new(FileId(0), 0, 0), unit: "MN/m".into(), values, written: None }
    }

    fn choices(texts: &[&str]) -> Values {
        let span = Span::new(FileId(0), 0, 0);
        Values::Listed(texts.iter().map(|t| Choice { text: t.to_string(), number: None, span }).collect())
    }

    /// Squared centred L2 discrepancy; Hickernell (1998), Mathematics of Computation 67, 299-322, equation 5.1c.
    fn discrepancy(points: &[Vec<f64>]) -> f64 {
        let (n, d) = (points.len() as f64, points[0].len() as i32);
        let far = |x: f64| (x - 0.5).abs();
        let single: f64 = points
            .iter()
            .map(|p| p.iter().map(|x| 1.0 + 0.5 * far(*x) - 0.5 * far(*x) * far(*x)).product::<f64>())
            .sum();
        let pair = |p: &[f64], q: &[f64]| -> f64 {
            let factors = p.iter().zip(q).map(|(x, y)| 1.0 + 0.5 * (far(*x) + far(*y) - (x - y).abs()));
            factors.product()
        };
        let double: f64 = points.iter().map(|p| points.iter().map(|q| pair(p, q)).sum::<f64>()).sum();
        (13.0_f64 / 12.0).powi(d) - 2.0 / n * single + double / (n * n)
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (p, x) in [
            (0.5, 0.0),
            (0.6, 0.253_347_103_135_799_7),
            (0.975, 1.959_963_984_540_054),
            (1e-10, -6.361_340_902_404_056),
        ] {
            assert!((inverse_normal(p) - x).abs() <= 1e-12, "{p}: {} against {x}", inverse_normal(p));
        }
    }

    #[test]
    fn a_grid_is_every_combination() {
        let axes = [axis(choices(&["a", "b"])), axis(choices(&["1", "2", "3"]))];
        let texts: Vec<String> =
            grid(&axes).iter().map(|p| p.iter().map(|l| l.text.as_str()).collect::<Vec<_>>().join("")).collect();
        assert_eq!(texts, ["a1", "a2", "a3", "b1", "b2", "b3"]);
    }

    #[test]
    fn distributions_have_their_quantiles() {
        let at = |spread, u| level(&axis(Values::Spread(spread)), u).text;
        assert_eq!(at(Spread::Uniform { from: 20.0, to: 80.0 }, 0.25), "35 MN/m");
        assert_eq!(at(Spread::Normal { mean: 40.0, deviation: 5.0 }, 0.5), "40 MN/m");
        assert_eq!(at(Spread::Normal { mean: 40.0, deviation: 5.0 }, 0.975), "49.7998 MN/m");
        assert_eq!(at(Spread::LogNormal { median: 40.0, sigma: 0.2 }, 0.5), "40 MN/m");
    }

    proptest! {
        #[test]
        fn a_latin_hypercube_has_one_point_in_each_stratum(n in 1..60_usize, d in 1..8_usize, seed in any::<u64>()) {
            let points = latin_hypercube(n, d, seed);
            prop_assert_eq!(&points, &latin_hypercube(n, d, seed));
            for axis in 0..d {
                let mut strata: Vec<usize> = points.iter().map(|p| (p[axis] * n as f64) as usize).collect();
                strata.sort_unstable();
                prop_assert!(strata.into_iter().eq(0..n));
            }
        }

        #[test]
        fn the_first_powers_of_two_of_a_sobol_design_are_balanced(k in 1..8_u32, seed in any::<u64>()) {
            let n = 1_usize << k;
            let points = sobol(n, SOBOL_DIMENSIONS, seed);
            prop_assert_eq!(&points, &sobol(n, SOBOL_DIMENSIONS, seed));
            for axis in 0..SOBOL_DIMENSIONS {
                let mut strata: Vec<usize> = points.iter().map(|p| (p[axis] * n as f64) as usize).collect();
                strata.sort_unstable();
                prop_assert!(strata.into_iter().eq(0..n), "axis {}", axis);
            }
        }

        /// The first two directions are a (0, k, 2)-net: every box of 2^a by 2^(k - a) holds one point.
        #[test]
        fn two_directions_of_a_sobol_design_fill_every_box(k in 1..8_u32, seed in any::<u64>()) {
            let points = sobol(1 << k, 2, seed);
            for a in 0..=k {
                let (across, up) = (f64::from(1_u32 << a), f64::from(1_u32 << (k - a)));
                let mut boxes: Vec<(u32, u32)> =
                    points.iter().map(|p| ((p[0] * across) as u32, (p[1] * up) as u32)).collect();
                boxes.sort_unstable();
                boxes.dedup();
                prop_assert_eq!(boxes.len(), 1 << k);
            }
        }

        #[test]
        fn designs_cover_better_than_chance(d in 2..7_usize, seed in any::<u64>()) {
            let n = 64;
            let mut random = SplitMix::new(seed);
            let chance: f64 = (0..8)
                .map(|_| {
                    let points: Vec<Vec<f64>> = (0..n).map(|_| (0..d).map(|_| random.unit()).collect()).collect();
                    discrepancy(&points)
                })
                .sum::<f64>() / 8.0;
            prop_assert!(discrepancy(&sobol(n, d, seed)) < 0.5 * chance);
            prop_assert!(discrepancy(&latin_hypercube(n, d, seed)) < chance);
        }
    }
}
