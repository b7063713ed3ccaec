//! A value that varies along the track: a sequence of curves, each over a piece of chainage.

use super::{Given, Origin};
use serde::{Deserialize, Serialize};

/// Chainages that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// A value along the track, in SI and for one rail. It covers its range without gap or overlap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Pieces from left to right; at least one.
    pub pieces: Vec<Piece>,
    pub origin: Origin,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// Chainage of both ends, m.
    pub start: f64,
    pub end: f64,
    pub curve: Curve,
}

/// The shape of a curve; its end values hold before its first and after its last point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Curve {
    /// Linear between points `[x, value]`; one point is a constant.
    Linear(Vec<[f64; 2]>),
    /// A cubic from point to point with zero slope at both ends: a + (b - a) (3 t^2 - 2 t^3).
    Level([[f64; 2]; 2]),
    /// The natural cubic spline through points `[x, value, second derivative]`.
    Natural(Vec<[f64; 3]>),
}

/// A value that may vary along the track, in SI.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Varying {
    Constant(Given),
    Profile(Profile),
}

/// A cubic between two chainages by its values and second derivatives at both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// m.
    pub ends: [f64; 2],
    pub values: [f64; 2],
    pub curvatures: [f64; 2],
}

impl Profile {
    /// The value at a chainage; at the boundary of two pieces, the value of the right piece.
    pub fn value(&self, x: f64) -> f64 {
        let after = self.pieces.partition_point(|piece| piece.start <= x + TINY);
        self.pieces.get(after.saturating_sub(1)).map_or(0.0, |piece| piece.curve.value(x))
    }
}

impl Varying {
    /// The value at a chainage.
    pub fn value_at(&self, x: f64) -> f64 {
        match self {
            Varying::Constant(given) => **given,
            Varying::Profile(profile) => profile.value(x),
        }
    }

    pub fn origin(&self) -> Origin {
        match self {
            Varying::Constant(given) => given.origin,
            Varying::Profile(profile) => profile.origin,
        }
    }

    /// Chainages between which the value is smooth; empty if it does not vary.
    pub fn knots(&self) -> Vec<f64> {
        match self {
            Varying::Constant(_) => Vec::new(),
            Varying::Profile(profile) => profile.pieces.iter().flat_map(Piece::knots).collect(),
        }
    }

    /// The largest value between the points of its curves, exact for linear curves and for curves with zero slope at
    /// their points.
    pub fn largest(&self) -> f64 {
        self.extreme(f64::max)
    }

    /// The smallest value, with the same accuracy as the largest.
    pub fn smallest(&self) -> f64 {
        self.extreme(f64::min)
    }

    fn extreme(&self, of: fn(f64, f64) -> f64) -> f64 {
        match self {
            Varying::Constant(given) => **given,
            Varying::Profile(profile) => {
                let values = profile.pieces.iter().flat_map(|p| p.knots().into_iter().map(|x| p.curve.value(x)));
                values.reduce(of).unwrap_or_default()
            }
        }
    }
}

impl Piece {
    /// Chainages between which the value is smooth, ascending: both ends and the points between them.
    pub fn knots(&self) -> Vec<f64> {
        let inside = self.curve.knots().into_iter().filter(|x| *x > self.start + TINY && *x < self.end - TINY);
        [self.start].into_iter().chain(inside).chain([self.end]).collect()
    }

    /// The piece as cubics between its knots.
    pub fn cubics(&self) -> Vec<Cubic> {
        let cubic = |pair: &[f64]| {
            let ends = [pair[0], pair[1]];
            // a curve is constant beyond its points
            let inside = self.curve.covers(0.5 * (ends[0] + ends[1]));
            let curvatures = if inside { ends.map(|x| self.curve.curvature(x)) } else { [0.0; 2] };
            Cubic { ends, values: ends.map(|x| self.curve.value(x)), curvatures }
        };
        self.knots().windows(2).map(cubic).collect()
    }
}

impl Curve {
    pub fn constant(value: f64) -> Curve {
        Curve::Linear(vec![[0.0, value]])
    }

    /// The natural cubic spline through points of ascending x: second derivatives m from
    /// h0 m0 / 6 + (h0 + h1) m1 / 3 + h1 m2 / 6 = (y2 - y1) / h1 - (y1 - y0) / h0, zero at both ends.
    pub fn natural(points: &[[f64; 2]]) -> Curve {
        let n = points.len();
        let mut spline: Vec<[f64; 3]> = points.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        // elimination of a tridiagonal system: m[i] = rest[i] - ratio[i] m[i + 1]
        let (mut ratio, mut rest) = (vec![0.0; n], vec![0.0; n]);
        for i in 1..n.saturating_sub(1) {
            let [[x0, y0], [x1, y1], [x2, y2]] = [points[i - 1], points[i], points[i + 1]];
            let (h0, h1) = (x1 - x0, x2 - x1);
            let pivot = (h0 + h1) / 3.0 - h0 / 6.0 * ratio[i - 1];
            ratio[i] = h1 / 6.0 / pivot;
            rest[i] = ((y2 - y1) / h1 - (y1 - y0) / h0 - h0 / 6.0 * rest[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            spline[i][2] = rest[i] - ratio[i] * spline[i + 1][2];
        }
        Curve::Natural(spline)
    }

    pub fn value(&self, x: f64) -> f64 {
        match self {
            Curve::Linear(points) => match between(points, x, |p| p[0]) {
                Ok([a, b]) => a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]),
                Err(end) => end.map_or(0.0, |p| p[1]),
            },
            Curve::Level([a, b]) => {
                let t = ((x - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
                a[1] + (b[1] - a[1]) * t * t * (3.0 - 2.0 * t)
            }
            Curve::Natural(points) => match between(points, x, |p| p[0]) {
                Ok([a, b]) => {
                    let h = b[0] - a[0];
                    let (s, t) = ((b[0] - x) / h, (x - a[0]) / h);
                    s * a[1] + t * b[1] + h * h / 6.0 * ((s * s * s - s) * a[2] + (t * t * t - t) * b[2])
                }
                Err(end) => end.map_or(0.0, |p| p[1]),
            },
        }
    }

    /// The second derivative between its points.
    fn curvature(&self, x: f64) -> f64 {
        match self {
            Curve::Linear(_) => 0.0,
            Curve::Level([a, b]) => {
                let h = b[0] - a[0];
                6.0 * (b[1] - a[1]) / (h * h) * (1.0 - 2.0 * (x - a[0]) / h)
            }
            Curve::Natural(points) => match between(points, x, |p| p[0]) {
                Ok([a, b]) => a[2] + (b[2] - a[2]) * (x - a[0]) / (b[0] - a[0]),
                Err(_) => 0.0,
            },
        }
    }

    fn covers(&self, x: f64) -> bool {
        // asked for each interval of a curve, so it must not list all points
        let ends = match self {
            Curve::Linear(points) => points.first().zip(points.last()).map(|(a, b)| [a[0], b[0]]),
            Curve::Level([a, b]) => Some([a[0], b[0]]),
            Curve::Natural(points) => points.first().zip(points.last()).map(|(a, b)| [a[0], b[0]]),
        };
        ends.is_some_and(|[first, last]| first < x && x < last)
    }

    fn knots(&self) -> Vec<f64> {
        match self {
            Curve::Linear(points) => points.iter().map(|p| p[0]).collect(),
            Curve::Level(points) => points.iter().map(|p| p[0]).collect(),
            Curve::Natural(points) => points.iter().map(|p| p[0]).collect(),
        }
    }
}

/// The two points around x; the end point if x is beyond the ends.
fn between<const N: usize>(
    points: &[[f64; N]],
    x: f64,
    of: impl Fn(&[f64; N]) -> f64,
) -> Result<[[f64; N]; 2], Option<[f64; N]>> {
    let after = points.partition_point(|p| of(p) <= x);
    match (after.checked_sub(1).and_then(|i| points.get(i)), points.get(after)) {
        (Some(a), Some(b)) => Ok([*a, *b]),
        (a, b) => Err(a.or(b).copied()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(pieces: Vec<(f64, f64, Curve)>) -> Profile {
        let pieces = pieces.into_iter().map(|(start, end, curve)| Piece { start, end, curve }).collect();
        Profile { pieces, origin: Origin::Derived }
    }

    #[test]
    fn straight_and_level_curves_meet_their_points_and_hold_beyond() {
        let line = Curve::Linear(vec![[0.0, 1.0], [2.0, 5.0], [3.0, 0.0]]);
        for (x, value) in [(-1.0, 1.0), (0.0, 1.0), (0.5, 2.0), (2.0, 5.0), (2.5, 2.5), (3.0, 0.0), (9.0, 0.0)] {
            assert_eq!(line.value(x), value, "{x}");
        }
        let level = Curve::Level([[0.0, 2.0], [4.0, 6.0]]);
        for (x, value) in [(-1.0, 2.0), (0.0, 2.0), (1.0, 2.625), (2.0, 4.0), (3.0, 5.375), (4.0, 6.0), (5.0, 6.0)] {
            assert_eq!(level.value(x), value, "{x}");
        }
        assert_eq!(Curve::constant(3.0).value(-7.0), 3.0);
    }

    #[test]
    fn the_spline_is_that_of_the_textbook() {
        // 0, 1, 0 at 0, 1, 2: by symmetry m1 = -3, and y = 1.5 x - 0.5 x^3 on the left half
        let Curve::Natural(points) = Curve::natural(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]) else { unreachable!() };
        assert_eq!(points, [[0.0, 0.0, 0.0], [1.0, 1.0, -3.0], [2.0, 0.0, 0.0]]);
        let spline = Curve::Natural(points);
        for x in [0.25, 0.5, 0.75] {
            let exact = 1.5 * x - 0.5 * x * x * x;
            assert!((spline.value(x) - exact).abs() < 1e-15 && (spline.value(2.0 - x) - exact).abs() < 1e-15);
        }
        // straight data stays straight, however uneven
        let straight = Curve::natural(&[[0.0, 1.0], [0.3, 1.6], [2.0, 5.0], [2.1, 5.2]]);
        for x in [0.1, 1.0, 2.05] {
            assert!((straight.value(x) - 1.0 - 2.0 * x).abs() < 1e-12);
        }
    }

    #[test]
    fn the_spline_of_a_wave_converges_with_the_fourth_power_of_the_interval() {
        let error = |n: usize| {
            let step = 4.0 * std::f64::consts::PI / n as f64;
            let points: Vec<[f64; 2]> = (0..=n).map(|i| i as f64 * step).map(|x| [x, x.sin()]).collect();
            let spline = Curve::natural(&points);
            (0..4000)
                .map(|i| i as f64 * 1e-3 * std::f64::consts::PI)
                .map(|x| (spline.value(x) - x.sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(40) / error(80)).log2();
        assert!((3.8..4.2).contains(&order), "order {order}");
    }

    #[test]
    fn cubics_are_the_curve() {
        let curves = [
            Curve::Linear(vec![[0.0, 1.0], [2.0, 5.0], [3.0, 0.0]]),
            Curve::Level([[0.5, 2.0], [4.0, 6.0]]),
            Curve::natural(&[[0.0, 0.0], [1.0, 1.0], [2.5, -2.0], [4.0, 0.0]]),
        ];
        for curve in curves {
            let piece = Piece { start: -0.7, end: 3.3, curve };
            for Cubic { ends: [a, b], values, curvatures } in piece.cubics() {
                for (s, t) in [(1.0, 0.0), (0.7, 0.3), (0.25, 0.75)] {
                    let h = b - a;
                    let bend = (s * s * s - s) * curvatures[0] + (t * t * t - t) * curvatures[1];
                    let found = s * values[0] + t * values[1] + h * h / 6.0 * bend;
                    assert!((found - piece.curve.value(s * a + t * b)).abs() < 1e-14, "{piece:?} {found}");
                }
            }
        }
    }

    #[test]
    fn pieces_stand_side_by_side() {
        let steps =
            profile(vec![(-4.0, 0.0, Curve::constant(1.0)), (0.0, 2.0, Curve::Linear(vec![[0.0, 5.0], [2.0, 7.0]]))]);
        for (x, value) in [(-9.0, 1.0), (-0.5, 1.0), (0.0, 5.0), (-1e-9, 5.0), (1.0, 6.0), (3.0, 7.0)] {
            assert!((steps.value(x) - value).abs() < 1e-6, "{x}");
        }
        assert_eq!(steps.pieces[0].knots(), [-4.0, 0.0]);
    }
}
