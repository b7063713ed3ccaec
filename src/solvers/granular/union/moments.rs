//! Volume, first and second moments of a union of balls.

use super::Pebble;
use super::patch::Patch;
use nalgebra::{Matrix3, Vector3};

/// Tolerance of a piece of the integral along z, in units of the largest pebble and of the distance of the pebbles from
/// the origin. Rounding in the flux grows with the same power of this distance, and stays ten times smaller.
const TOLERANCE: f64 = 1e-14;

/// `∫ dV`, `∫ x dV`, `∫ x xᵀ dV` about the origin, in m³, m⁴, m⁵.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    pub volume: f64,
    pub first: Vector3<f64>,
    pub second: Matrix3<f64>,
}

/// Moments of the union of balls about the origin. The origin should lie among the balls, otherwise moments are
/// differences of large numbers.
pub fn moments(pebbles: &[Pebble]) -> Moments {
    let unit = pebbles.iter().map(|p| p.radius).fold(0.0, f64::max);
    let scaled: Vec<_> = pebbles.iter().map(|p| Pebble { centre: p.centre / unit, radius: p.radius / unit }).collect();
    let reach = scaled.iter().map(|p| p.centre.norm() + p.radius).fold(1.0, f64::max);
    let tolerance = std::array::from_fn(|k| TOLERANCE * reach.powi(1 + order(k)));
    let mut sum = [0.0; 10];
    for (i, pebble) in scaled.iter().enumerate() {
        let part = Patch::of_pebble(&scaled, i)
            .integrate(&tolerance, |height, radius, trig| flux(pebble, height, radius, trig));
        (0..10).for_each(|k| sum[k] += part[k]);
    }
    let [v, x, y, z, xx, yy, zz, xy, yz, zx] = sum;
    let volume = unit * unit * unit;
    Moments {
        volume: v * volume,
        first: Vector3::new(x, y, z) * (volume * unit),
        second: Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) * (volume * unit * unit),
    }
}

/// Power of the length, in addition to volume, of the k-th integral of [`flux`].
fn order(k: usize) -> i32 {
    match k {
        0 => 0,
        1..=3 => 1,
        _ => 2,
    }
}

/// `∮ P dy dz/dζ` on one circle of a sphere, with `∂P/∂x` = 1, x, y, z, x², y², z², xy, yz, zx in this order.
fn flux(pebble: &Pebble, height: f64, radius: f64, t: &super::arcs::Trig) -> [f64; 10] {
    let (a, b) = (pebble.centre.x, pebble.centre.y);
    let z = pebble.centre.z + pebble.radius * height;
    let s = pebble.radius * radius;
    // x = a + s cos φ, y = b + s sin φ, dy = s cos φ dφ, dz = r dζ.
    let w = s * pebble.radius;
    let x_dy = w * (a * t.c + s * t.cc);
    let xx_dy = w * (a * a * t.c + s * (2.0 * a * t.cc + s * t.ccc));
    let xy_dy = w * (a * b * t.c + s * (a * t.cs + b * t.cc + s * t.ccs));
    let xxx_dy = w * (a * a * a * t.c + s * (3.0 * a * a * t.cc + s * (3.0 * a * t.ccc + s * t.cccc)));
    let xyy_dy = w
        * (a * b * b * t.c + s * (2.0 * a * b * t.cs + b * b * t.cc + s * (a * t.css + 2.0 * b * t.ccs + s * t.ccss)));
    let xxy_dy = w
        * (a * a * b * t.c + s * (a * a * t.cs + 2.0 * a * b * t.cc + s * (2.0 * a * t.ccs + b * t.ccc + s * t.cccs)));
    let (x, y) = (0.5 * xx_dy, xy_dy);
    [x_dy, x, y, z * x_dy, xxx_dy / 3.0, xyy_dy, z * z * x_dy, 0.5 * xxy_dy, z * y, z * x]
}
