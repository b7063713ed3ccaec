//! The load spreads downwards in a truncated pyramid; each slice of the pyramid is a spring.
//!
//! At depth z the load acts on a rectangle `w(z) l(z)`, w along and l across the track. Each side moves outwards by
//! `tan(a)` per metre of depth, until it meets the pyramid of its neighbour: halfway to the next sleeper, or at the
//! centre line of the track. Below that depth the side is vertical. A slice dz is a spring `E w l / dz`, all in series:
//!
//! ```text
//! 1 / k = int dz / (E w l)
//! ```
//!
//! W. M. Zhai, K. Y. Wang and J. H. Lin, Modelling and experiment of railway ballast vibrations, Journal of Sound and
//! Vibration 270 (2004) 673-683, use one layer of ballast on springs. In the part shared by neighbours their formula
//! uses the mean width; the integral here is exact (the difference is 0.3 % of the stiffness in their example).

use super::layers::{Bearing, Below, Layer, Support};
use std::f64::consts::PI;

/// The rectangle on which the load acts at one depth.
#[derive(Debug, Clone, Copy)]
struct Slice {
    /// From the axis of the load to the left and to the right side, m.
    along: [f64; 2],
    /// To the inner and to the outer side, m.
    across: [f64; 2],
}

impl Slice {
    fn width(&self) -> f64 {
        self.along[0] + self.along[1]
    }

    fn length(&self) -> f64 {
        self.across[0] + self.across[1]
    }

    fn area(&self) -> f64 {
        self.width() * self.length()
    }
}

/// Largest displacement of each side: to the left, right, inner and outer neighbour; no limit beyond the outer end.
struct Limits([f64; 4]);

impl Limits {
    fn new(bearing: &Bearing) -> Limits {
        let [left, right] = bearing.spacings;
        let inner = bearing.to_centre.map_or(f64::INFINITY, |gap| 0.5 * bearing.length + gap);
        Limits([0.5 * left, 0.5 * right, inner, f64::INFINITY])
    }

    /// The slice h below another slice, for a load that spreads by `rate` per metre.
    fn below(&self, slice: &Slice, rate: f64, h: f64) -> Slice {
        let [left, right, inner, outer] = self.0;
        let moved = |side: f64, limit: f64| (side + rate * h).min(limit.max(side));
        Slice {
            along: [moved(slice.along[0], left), moved(slice.along[1], right)],
            across: [moved(slice.across[0], inner), moved(slice.across[1], outer)],
        }
    }

    /// Depths below a slice at which a side meets the side of its neighbour, ascending, with the end of the layer.
    fn stops(&self, slice: &Slice, rate: f64, thickness: f64) -> Vec<f64> {
        let sides = [slice.along[0], slice.along[1], slice.across[0], slice.across[1]];
        let meets = sides.iter().zip(self.0).map(|(side, limit)| (limit - side) / rate);
        let mut stops: Vec<f64> = meets.filter(|h| *h > 0.0 && *h < thickness).chain([thickness]).collect();
        stops.sort_by(f64::total_cmp);
        stops
    }
}

pub(super) fn support(bearing: &Bearing, layers: &[Layer], below: Below) -> Support {
    let limits = Limits::new(bearing);
    let mut slice = Slice { along: [0.5 * bearing.width; 2], across: [0.5 * bearing.length; 2] };
    let mut pressures = vec![1.0 / slice.area()];
    let (mut compliance, mut masses) = (0.0, Vec::with_capacity(layers.len()));
    for layer in layers {
        let rate = layer.spread.tan();
        let (top, mut before, mut mass) = (slice, 0.0, 0.0);
        for stop in limits.stops(&top, rate, layer.thickness) {
            let next = limits.below(&top, rate, stop);
            compliance += flattening(&slice, &next, stop - before) / layer.youngs_modulus;
            mass += layer.density * volume(&slice, &next, stop - before);
            (slice, before) = (next, stop);
        }
        masses.push(mass);
        pressures.push(1.0 / slice.area());
    }
    compliance += match below {
        Below::Rigid => 0.0,
        Below::Springs { modulus } => 1.0 / (modulus * slice.area()),
        // a rigid disc of the same area: 2 E r / (1 - nu^2)
        Below::HalfSpace { youngs_modulus, poisson_ratio } => {
            (1.0 - poisson_ratio * poisson_ratio) / (2.0 * youngs_modulus * (slice.area() / PI).sqrt())
        }
    };
    Support { stiffness: 1.0 / compliance, masses, pressures }
}

/// `int dz / (w l)` between two slices h apart whose sides are straight, 1/m.
///
/// With w from w0 to w1 and l from l0 to l1 it is `h / (w0 l1) ln(1 + q) / q`, `q = (w1 l0 - w0 l1) / (w0 l1)`.
fn flattening(top: &Slice, bottom: &Slice, h: f64) -> f64 {
    let (crossed, straight) = (top.width() * bottom.length(), bottom.width() * top.length());
    let q = (straight - crossed) / crossed;
    // the first terms of the series if w and l grow alike
    let ratio = if q.abs() < 1e-6 { 1.0 - 0.5 * q } else { q.ln_1p() / q };
    h / crossed * ratio
}

/// `int w l dz`, m^3: exact, since the area is a polynomial of second degree.
fn volume(top: &Slice, bottom: &Slice, h: f64) -> f64 {
    let middle = 0.25 * (top.width() + bottom.width()) * (top.length() + bottom.length());
    h / 6.0 * (top.area() + 4.0 * middle + bottom.area())
}
