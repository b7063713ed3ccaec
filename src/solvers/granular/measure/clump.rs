//! Volume of a union of balls inside a region, by the same integral as the mass properties of a clump.
//!
//! The surface of the part inside consists of the patches of the balls inside the region, and of the parts of the
//! border inside the union. On a sphere, every face of a box, the border of a ball and every other pebble cut off a
//! cap.

use super::region::{Ball, Region, RegionShape};
use crate::solvers::granular::union::{Arcs, Cap, Patch, Pebble, Trig};
use nalgebra::{Vector2, Vector3};

/// Tolerance of a piece of the integral, in units of the largest pebble.
const TOLERANCE: [f64; 1] = [1e-13];

impl Region {
    /// Volume of a clump inside the region, m³; a part inside several pebbles counts once. `volume` (m³) is the volume
    /// of the clump. The error is below 1e-10 of the cube of the largest radius.
    pub fn share_of_clump(&self, pebbles: &[Ball], volume: f64) -> f64 {
        match pebbles {
            [] => 0.0,
            [sphere] => self.share_of_sphere(*sphere),
            _ if pebbles.iter().all(|p| self.holds_ball(p)) => volume,
            _ if pebbles.iter().all(|p| self.misses_ball(p)) => 0.0,
            _ => union_in(&self.0, pebbles),
        }
    }
}

/// Volume of a union of balls inside a region, m³.
pub(super) fn union_in(shape: &RegionShape, balls: &[Ball]) -> f64 {
    // Positions relative to the first pebble, in units of the largest: fluxes are then not differences of large
    // numbers.
    let unit = balls.iter().map(|b| b.1).fold(0.0, f64::max);
    let origin = balls[0].0;
    let place = |c: &[f64; 3]| Vector3::from_fn(|k, _| (c[k] - origin[k]) / unit);
    let pebbles: Vec<_> = balls.iter().map(|(c, r)| Pebble { centre: place(c), radius: r / unit }).collect();
    let share = match shape {
        RegionShape::Block { lower, upper } => union_in_box(&pebbles, &place(lower), &place(upper)),
        RegionShape::Ball { centre, radius } => {
            union_in_ball(&pebbles, &Pebble { centre: place(centre), radius: radius / unit })
        }
    };
    let share = if share < 0.0 { 0.0 } else { share }; // negative by rounding; a value that is not a number stays
    share * unit * unit * unit
}

/// `∮ x dy dz/dζ` over arcs of a sphere.
fn flux(ball: &Pebble, radius: f64, arcs: &Trig) -> [f64; 1] {
    let s = ball.radius * radius;
    [ball.radius * s * (ball.centre.x * arcs.c + s * arcs.cc)]
}

fn union_in_ball(pebbles: &[Pebble], border: &Pebble) -> f64 {
    let mut total = 0.0;
    for (i, pebble) in pebbles.iter().enumerate() {
        let mut patch = Patch::of_pebble(pebbles, i);
        patch.keep_within(pebble, border);
        total += patch.integrate(&TOLERANCE, |_, radius, open| flux(pebble, radius, open))[0];
    }
    let outside = Patch::of_ball(border, pebbles);
    total + outside.integrate_covered(&TOLERANCE, |_, radius, covered| flux(border, radius, covered))[0]
}

fn union_in_box(pebbles: &[Pebble], lower: &Vector3<f64>, upper: &Vector3<f64>) -> f64 {
    let mut total = 0.0;
    for (i, pebble) in pebbles.iter().enumerate() {
        let mut patch = Patch::of_pebble(pebbles, i);
        for k in 0..3 {
            let normal = Vector3::from_fn(|row, _| f64::from(u8::from(row == k)));
            patch.cut(Cap { normal, offset: (upper[k] - pebble.centre[k]) / pebble.radius });
            patch.cut(Cap { normal: -normal, offset: (pebble.centre[k] - lower[k]) / pebble.radius });
        }
        total += patch.integrate(&TOLERANCE, |_, radius, open| flux(pebble, radius, open))[0];
    }
    let face = |x: f64| x * union_in_rectangle(&discs(pebbles, x), &lower.yz(), &upper.yz());
    total + face(upper.x) - face(lower.x)
}

/// Centre and radius of a circle.
type Disc = (Vector2<f64>, f64);

/// Circles in which the balls cross a plane across x.
fn discs(pebbles: &[Pebble], x: f64) -> Vec<Disc> {
    let disc = |p: &Pebble| {
        let square = (p.radius - (x - p.centre.x)) * (p.radius + (x - p.centre.x));
        (square > 0.0).then(|| (p.centre.yz(), square.sqrt()))
    };
    pebbles.iter().filter_map(disc).collect()
}

/// Area of a union of discs in a rectangle, by Green's theorem: `∮ x dy` along open arcs and along the sides x =
/// constant.
fn union_in_rectangle(discs: &[Disc], lower: &Vector2<f64>, upper: &Vector2<f64>) -> f64 {
    let mut arcs = Arcs::default();
    let mut total = 0.0;
    for (i, (centre, radius)) in discs.iter().enumerate() {
        arcs.clear();
        for (_, (other, reach)) in discs.iter().enumerate().filter(|(j, _)| *j != i) {
            let apart = other - centre;
            let distance = apart.norm();
            if distance + radius <= *reach {
                arcs.cover_all();
            } else if distance > 0.0 && distance < radius + reach {
                let gap = (radius - reach) * (radius + reach);
                arcs.cover_beyond(apart.y.atan2(apart.x), (gap / distance + distance) / (2.0 * radius));
            }
        }
        for (normal, offset) in [
            (Vector2::x(), upper.x - centre.x),
            (-Vector2::x(), centre.x - lower.x),
            (Vector2::y(), upper.y - centre.y),
            (-Vector2::y(), centre.y - lower.y),
        ] {
            arcs.cover_beyond(f64::atan2(normal.y, normal.x), offset / radius);
        }
        let open = arcs.open();
        total += radius * (centre.x * open.c + radius * open.cc);
    }
    let side = |x: f64| x * covered_length(discs, x, lower.y, upper.y);
    total + side(upper.x) - side(lower.x)
}

/// Length of a line across x, between two points, inside a union of discs.
fn covered_length(discs: &[Disc], x: f64, from: f64, to: f64) -> f64 {
    let chord = |(centre, radius): &Disc| {
        let square = (radius - (x - centre.x)) * (radius + (x - centre.x));
        (square > 0.0).then(|| (centre.y - square.sqrt(), centre.y + square.sqrt()))
    };
    let mut chords: Vec<_> = discs.iter().filter_map(chord).collect();
    chords.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut reached, mut length) = (from, 0.0);
    for (start, end) in chords {
        let (start, end) = (start.max(reached), end.min(to));
        if end > start {
            length += end - start;
            reached = end;
        }
    }
    length
}
