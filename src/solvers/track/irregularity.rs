//! The unevenness of the running surface of the rail: a wheel runs on w(x) + r(x).

use super::error::{TrackError, TrackParameter};
use serde::{Deserialize, Serialize};

/// r over x, m below the even surface: cubics side by side, none if the surface is even. Beyond the outer ends r keeps
/// its end value, so a surface that is not level at its end has a kink there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Irregularity {
    cubics: Vec<Cubic>,
}

/// r between two chainages, by its values and second derivatives at both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cubic {
    /// m, increasing.
    pub ends: [f64; 2],
    /// m.
    pub values: [f64; 2],
    /// r'', 1/m.
    pub curvatures: [f64; 2],
}

impl Irregularity {
    /// Cubics side by side, left to right; checked with the track that they belong to.
    pub fn cubics(cubics: Vec<Cubic>) -> Self {
        Self { cubics }
    }

    /// Straight lines between points (chainage and r, m); fails if the chainages do not increase.
    pub fn linear(points: Vec<(f64, f64)>) -> Result<Self, TrackError> {
        check(&points)?;
        let level = vec![0.0; points.len()];
        Ok(Self::through(&points, &level))
    }

    /// The cubic spline through points (chainage and r, m) with zero curvature at both ends; fails if the chainages do
    /// not increase.
    pub fn spline(points: Vec<(f64, f64)>) -> Result<Self, TrackError> {
        check(&points)?;
        let curvatures = natural_curvatures(&points);
        Ok(Self::through(&points, &curvatures))
    }

    fn through(points: &[(f64, f64)], curvatures: &[f64]) -> Self {
        let cubic = |(p, m): (&[(f64, f64)], &[f64])| Cubic {
            ends: [p[0].0, p[1].0],
            values: [p[0].1, p[1].1],
            curvatures: [m[0], m[1]],
        };
        match points {
            // one point is a surface that is level everywhere
            [(x, r)] => Self { cubics: vec![Cubic { ends: [*x, *x + 1.0], values: [*r; 2], curvatures: [0.0; 2] }] },
            _ => Self { cubics: points.windows(2).zip(curvatures.windows(2)).map(cubic).collect() },
        }
    }

    /// r at a chainage, m.
    pub fn depth_at(&self, x: f64) -> f64 {
        let right = self.cubics.partition_point(|cubic| cubic.ends[0] <= x);
        let Some(cubic) = self.cubics.get(right.saturating_sub(1)) else { return 0.0 };
        let length = cubic.ends[1] - cubic.ends[0];
        let t = ((x - cubic.ends[0]) / length).clamp(0.0, 1.0);
        let s = 1.0 - t;
        let bend = s * (s * s - 1.0) * cubic.curvatures[0] + t * (t * t - 1.0) * cubic.curvatures[1];
        s * cubic.values[0] + t * cubic.values[1] + length * length / 6.0 * bend
    }

    /// The first chainage at which the cubics are not finite or leave a gap wider than `gap`, m.
    pub(super) fn flaw(&self, gap: f64) -> Option<f64> {
        let broken = |cubic: &&Cubic| {
            let numbers = cubic.ends.iter().chain(&cubic.values).chain(&cubic.curvatures).all(|v| v.is_finite());
            !numbers || cubic.ends[1] <= cubic.ends[0]
        };
        let apart = |pair: &&[Cubic]| (pair[1].ends[0] - pair[0].ends[1]).abs() > gap;
        let in_one = self.cubics.iter().find(broken).map(|cubic| cubic.ends[0]);
        in_one.or_else(|| self.cubics.windows(2).find(apart).map(|pair| pair[0].ends[1]))
    }
}

fn check(points: &[(f64, f64)]) -> Result<(), TrackError> {
    let fail = |name, value, expected| Err(TrackError::Parameter { name, value, expected });
    if points.is_empty() {
        return fail(TrackParameter::Irregularity("points of an irregularity"), 0.0, "of 1 or more");
    }
    if let Some(point) = points.iter().find(|(x, r)| !(x.is_finite() && r.is_finite())) {
        return fail(TrackParameter::Irregularity("point of an irregularity"), point.0 + point.1, "a finite number");
    }
    match points.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
        Some(pair) => {
            fail(TrackParameter::Irregularity("chainage in an irregularity"), pair[1].0, "above the chainage before it")
        }
        None => Ok(()),
    }
}

/// Second derivatives at the points, by elimination along
/// `h_a m_(i-1) + 2 (h_a + h_b) m_i + h_b m_(i+1) = 6 (slope_b - slope_a)`.
fn natural_curvatures(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    let mut curvatures = vec![0.0; n];
    let mut shares = vec![0.0; n];
    for i in 1..n.saturating_sub(1) {
        let [(a, r_a), (x, r), (b, r_b)] = [points[i - 1], points[i], points[i + 1]];
        let (before, after) = (x - a, b - x);
        let bend = 6.0 * ((r_b - r) / after - (r - r_a) / before);
        let pivot = 2.0 * (before + after) - before * shares[i - 1];
        shares[i] = after / pivot;
        curvatures[i] = (bend - before * curvatures[i - 1]) / pivot;
    }
    for i in (1..n.saturating_sub(1)).rev() {
        curvatures[i] -= shares[i] * curvatures[i + 1];
    }
    curvatures
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_go_through_their_points() {
        assert_eq!(Irregularity::default().depth_at(3.0), 0.0);
        let points = vec![(0.0, 1.0), (1.0, 3.0), (1.5, -1.0), (4.0, 0.5)];
        for profile in [Irregularity::linear(points.clone()).unwrap(), Irregularity::spline(points.clone()).unwrap()] {
            for (x, r) in &points {
                assert!((profile.depth_at(*x) - r).abs() < 1e-14);
            }
            assert_eq!((profile.depth_at(-9.0), profile.depth_at(9.0)), (1.0, 0.5));
        }
        assert_eq!(Irregularity::linear(points).unwrap().depth_at(0.5), 2.0);
        assert_eq!(Irregularity::spline(vec![(2.0, 7.0)]).unwrap().depth_at(0.0), 7.0);
    }

    #[test]
    fn a_spline_is_of_fourth_order() {
        let wave = |x: f64| x.sin();
        let worst = |count: usize| {
            let x = |i: usize| std::f64::consts::PI * i as f64 / count as f64;
            let spline = Irregularity::spline((0..=count).map(|i| (x(i), wave(x(i)))).collect()).unwrap();
            (0..1000).map(|i| 3.1e-3 * f64::from(i)).fold(0.0f64, |m, x| m.max((spline.depth_at(x) - wave(x)).abs()))
        };
        assert!((worst(20) / worst(40)).log2() > 3.9);
    }

    #[test]
    fn broken_profiles_are_refused() {
        for points in [vec![], vec![(0.0, 0.0), (0.0, 1.0)], vec![(1.0, f64::NAN)]] {
            assert!(Irregularity::linear(points.clone()).is_err());
            assert!(Irregularity::spline(points).is_err());
        }
    }
}
