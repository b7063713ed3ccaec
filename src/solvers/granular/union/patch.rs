//! The part of a unit sphere that remains after caps are cut off, and integrals over it by circles at each height.

use super::Pebble;
use super::arcs::{Arcs, Trig};
use super::quadrature;
use nalgebra::Vector3;

/// Heights closer than this (in radii) count as one.
const SAME_HEIGHT: f64 = 1e-14;

/// A corner counts as covered if it lies at least this deep (in radii) below a cap: an unnecessary corner only costs
/// time.
const COVERED: f64 = 1e-9;

/// The points n of the unit sphere with `normal·n > offset`.
#[derive(Debug, Clone, Copy)]
pub struct Cap {
    pub normal: Vector3<f64>,
    pub offset: f64,
}

/// The unit sphere without its caps.
#[derive(Debug, Default)]
pub struct Patch {
    caps: Vec<Cap>,
    empty: bool,
}

impl Patch {
    /// The exposed part of pebble `i` of a union.
    pub fn of_pebble(pebbles: &[Pebble], i: usize) -> Self {
        let mut patch = Self::default();
        for (_, other) in pebbles.iter().enumerate().filter(|(j, _)| *j != i) {
            patch.cut_by(&pebbles[i], other);
        }
        patch
    }

    /// The part of a ball outside some pebbles.
    pub fn of_ball(ball: &Pebble, pebbles: &[Pebble]) -> Self {
        let mut patch = Self::default();
        pebbles.iter().for_each(|other| patch.cut_by(ball, other));
        patch
    }

    /// Cuts off the part inside another ball.
    fn cut_by(&mut self, own: &Pebble, other: &Pebble) {
        let apart = other.centre - own.centre;
        let distance = apart.norm();
        if distance + own.radius <= other.radius {
            self.empty = true;
        } else if distance > 0.0 && distance < own.radius + other.radius {
            self.cut(common_circle(own, other, &apart, distance));
        }
    }

    /// Cuts off the part outside another ball.
    pub fn keep_within(&mut self, own: &Pebble, other: &Pebble) {
        let apart = other.centre - own.centre;
        let distance = apart.norm();
        let within = distance + own.radius <= other.radius;
        // Of two coinciding spheres, the border counts.
        if distance + other.radius <= own.radius || distance >= own.radius + other.radius {
            self.empty = true;
        } else if !within {
            let Cap { normal, offset } = common_circle(own, other, &apart, distance);
            self.cut(Cap { normal: -normal, offset: -offset });
        }
    }

    /// Cuts off a cap, in radii about the centre.
    pub fn cut(&mut self, cap: Cap) {
        if cap.offset <= -1.0 {
            self.empty = true;
        } else if cap.offset < 1.0 {
            self.caps.push(cap);
        }
    }

    /// `∫ f dζ` over heights ζ from -1 to 1. The arguments of the integrand are ζ, the radius √(1 - ζ²) of the circle
    /// at that height, and the integrals over its open arcs, with angles from x to y.
    pub fn integrate<const N: usize>(&self, tolerance: &[f64; N], f: impl Fn(f64, f64, &Trig) -> [f64; N]) -> [f64; N] {
        let mut total = [0.0; N];
        if self.empty {
            return total;
        }
        let mut arcs = Arcs::default();
        let mut slice = |height: f64| {
            let radius = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt();
            self.open_arcs(height, radius, &mut arcs);
            f(height, radius, &arcs.open())
        };
        for pair in self.breaks().windows(2) {
            let part = quadrature::integrate(&mut slice, pair[0], pair[1], tolerance);
            (0..N).for_each(|k| total[k] += part[k]);
        }
        total
    }

    /// The same over the parts that are cut off.
    pub fn integrate_covered<const N: usize>(
        &self,
        tolerance: &[f64; N],
        f: impl Fn(f64, f64, &Trig) -> [f64; N],
    ) -> [f64; N] {
        let covered = |height: f64, radius: f64, open: &Trig| f(height, radius, &open.rest());
        if self.empty { Self::default().integrate(tolerance, f) } else { self.integrate(tolerance, covered) }
    }

    fn open_arcs(&self, height: f64, radius: f64, arcs: &mut Arcs) {
        arcs.clear();
        for Cap { normal, offset } in &self.caps {
            // Covered if across·cos(φ - φ_normal) > left.
            let across = normal.x.hypot(normal.y) * radius;
            let left = offset - normal.z * height;
            if left.abs() < across {
                arcs.cover_beyond(normal.y.atan2(normal.x), left / across);
            } else if left < 0.0 {
                arcs.cover_all();
                return;
            }
        }
    }

    /// The heights between which the integrand is smooth: poles, tops and bottoms of the rims of caps, corners of the
    /// patch.
    fn breaks(&self) -> Vec<f64> {
        let mut heights = vec![-1.0, 1.0];
        for (k, cap) in self.caps.iter().enumerate() {
            let middle = cap.offset * cap.normal.z;
            let reach = (1.0 - cap.offset * cap.offset).sqrt() * cap.normal.x.hypot(cap.normal.y);
            heights.extend([middle - reach, middle + reach]);
            for (l, other) in self.caps[..k].iter().enumerate() {
                heights.extend(corners(cap, other).filter(|n| self.shows(n, k, l)).map(|n| n.z));
            }
        }
        heights.retain(|h| (-1.0..=1.0).contains(h));
        heights.sort_unstable_by(f64::total_cmp);
        heights.dedup_by(|b, a| *b - *a < SAME_HEIGHT);
        heights
    }

    /// Whether a point on the rims of caps `k` and `l` is not covered by another cap.
    fn shows(&self, n: &Vector3<f64>, k: usize, l: usize) -> bool {
        let mut others = self.caps.iter().enumerate().filter(|(m, _)| *m != k && *m != l);
        others.all(|(_, cap)| cap.normal.dot(n) <= cap.offset + COVERED)
    }
}

/// The part of `own` inside `other`, if their surfaces intersect: the offset is (r² + d² - r_other²)/(2 d r).
fn common_circle(own: &Pebble, other: &Pebble, apart: &Vector3<f64>, distance: f64) -> Cap {
    let gap = (own.radius - other.radius) * (own.radius + other.radius);
    Cap { normal: apart / distance, offset: (gap / distance + distance) / (2.0 * own.radius) }
}

/// The points of the unit sphere on the rims of both caps: `α u + β v ± γ u×v`.
fn corners(a: &Cap, b: &Cap) -> impl Iterator<Item = Vector3<f64>> {
    let cosine = a.normal.dot(&b.normal);
    let across = a.normal.cross(&b.normal);
    let square = across.norm_squared();
    let inside = (a.normal * (a.offset - b.offset * cosine) + b.normal * (b.offset - a.offset * cosine)) / square;
    let off = ((1.0 - inside.norm_squared()) / square).sqrt();
    // Parallel rims, or rims that do not intersect, give no finite number.
    [1.0, -1.0].into_iter().map(move |sign| inside + across * (sign * off)).filter(|n| n.z.is_finite())
}
