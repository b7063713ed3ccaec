//! Exact volumes of a ball inside another ball and inside a box.
//!
//! A box is the alternating sum of the corners {x > a, y > b, z > c} at its vertices. The part of a ball in a corner
//! follows from Gauss's theorem: the area of its round face, from the angles and the curvature of its rims (Gauss and
//! Bonnet), and the areas of its flat faces. A circle x = a has a geodesic curvature times length of `a` times its
//! angle. Errors are about 1e-15 of the ball, also for small parts.

use std::f64::consts::PI;

pub fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (x * x + y * y + z * z).sqrt()
}

/// Common volume of two balls: two caps, or the smaller ball.
pub fn ball_in_ball(a: f64, b: f64, distance: f64) -> f64 {
    let (small, sum) = (a.min(b), a + b);
    if distance >= sum {
        return 0.0;
    }
    if distance <= (a - b).abs() {
        return 4.0 / 3.0 * PI * small * small * small;
    }
    let overlap = sum - distance;
    let shape = distance * distance + 2.0 * distance * sum - 3.0 * (a - b) * (a - b);
    PI * overlap * overlap * shape / (12.0 * distance)
}

/// Volume of the unit ball about the origin in a box.
pub fn unit_ball_in_box(lower: &[f64; 3], upper: &[f64; 3]) -> f64 {
    let farthest = (0..3).map(|k| lower[k].abs().max(upper[k].abs()).powi(2)).sum::<f64>();
    if farthest <= 1.0 {
        return (0..3).map(|k| upper[k] - lower[k]).product();
    }
    let mut total = 0.0;
    for vertex in 0..8u32 {
        let at = |k: usize| if vertex >> k & 1 == 0 { lower[k] } else { upper[k] };
        let lower_sides = 3 - vertex.count_ones();
        let sign = if lower_sides & 1 == 1 { 1.0 } else { -1.0 };
        total += sign * corner(at(0), at(1), at(2));
    }
    if total < 0.0 { 0.0 } else { total } // negative by rounding; a value that is not a number stays
}

/// Volume of the unit ball in {x > a, y > b, z > c}.
fn corner(a: f64, b: f64, c: f64) -> f64 {
    if a < 0.0 {
        edge(b, c) - corner(-a, b, c)
    } else if b < 0.0 {
        edge(a, c) - corner(a, -b, c)
    } else if c < 0.0 {
        edge(a, b) - corner(a, b, -c)
    } else if a * a + b * b + c * c >= 1.0 {
        0.0
    } else {
        let (ab, bc, ca) = (reach(a, b), reach(b, c), reach(c, a));
        // The angle of the circle x = a in {y > b, z > c}, and so on.
        let arcs = [ab.atan2(b) - c.atan2(ca), bc.atan2(c) - a.atan2(ab), ca.atan2(a) - b.atan2(bc)];
        let turns = ab.atan2(-a * b) + bc.atan2(-b * c) + ca.atan2(-c * a);
        let round = 2.0 * PI - turns - (a * arcs[0] + b * arcs[1] + c * arcs[2]);
        let flat = |x: f64, arc: f64, y: f64, z: f64, to_z: f64, to_y: f64| {
            0.5 * ((1.0 - x * x) * arc - y * (to_z - z) - z * (to_y - y))
        };
        let flats = a * flat(a, arcs[0], b, c, ab, ca)
            + b * flat(b, arcs[1], c, a, bc, ab)
            + c * flat(c, arcs[2], a, b, ca, bc);
        (round - flats) / 3.0
    }
}

/// Volume of the unit ball in {x > a, y > b}.
fn edge(a: f64, b: f64) -> f64 {
    if a < 0.0 {
        face(b) - edge(-a, b)
    } else if b < 0.0 {
        face(a) - edge(a, -b)
    } else if a * a + b * b >= 1.0 {
        0.0
    } else {
        let ab = reach(a, b);
        // Half the angle of the circle x = a in {y > b}, and half the angle of the circle y = b in {x > a}.
        let arcs = [ab.atan2(b), ab.atan2(a)];
        let round = 2.0 * (PI - ab.atan2(-a * b) - a * arcs[0] - b * arcs[1]);
        let flats = a * ((1.0 - a * a) * arcs[0] - b * ab) + b * ((1.0 - b * b) * arcs[1] - a * ab);
        (round - flats) / 3.0
    }
}

/// Volume of the unit ball in {x > a}.
fn face(a: f64) -> f64 {
    let a = a.clamp(-1.0, 1.0);
    PI * (1.0 - a) * (1.0 - a) * (2.0 + a) / 3.0
}

/// Third coordinate of the point of the unit sphere at x = a, y = b. All angles use this one number: near 0 its
/// rounding error is large, but the effect on the angles cancels.
fn reach(a: f64, b: f64) -> f64 {
    (1.0 - (a * a + b * b)).max(0.0).sqrt()
}
