//! Half a sleeper as a uniform pressure on a rectangle, on bonded elastic layers, with its neighbours beside it.
//!
//! The mean settlement of a rectangle of sides a and b is an integral over all waves k of its load,
//!
//! ```text
//! F / (2 pi) int f(k) R(k) dk,   R(k) = (2 / pi) int_0^(pi/2) (sinc(kx a/2) sinc(ky b/2))^2 P(kx, ky) da
//! ```
//!
//! where f is the [`Kernel`]'s settlement, `kx = k cos a`, `ky = k sin a`, and P adds a cosine for each neighbour. What a
//! half-space of the first layer's material would do has a closed form, see [`super::rectangle`]; only the difference to
//! it is integrated, and that dies out as `exp(-2 k h)` with the first layer's thickness h. A stiff sleeper settles less
//! than the mean of a uniform pressure: by 7 % on a half-space, nothing on a thin layer.

use super::kernel::Kernel;
use super::rectangle::mean_settlement;
use super::{Bearing, Below, Layer, Support};
use std::f64::consts::{FRAC_PI_2, PI};

/// Waves shorter than this over the first layer's thickness are not felt below it: the pressure there by less than 1e-4 of
/// itself, settlement by 1e-10.
const SHORTEST: f64 = 12.0;
/// Nor do those matter that go so often into the shorter side, however thin the first layer is.
const FINEST: f64 = 200.0;
/// Nodes and weights of Gauss and Legendre on -1 .. 1, the positive half of six.
const NODES: [[f64; 2]; 3] = [
    [0.238_619_186_083_196_9, 0.467_913_934_572_691],
    [0.661_209_386_466_264_5, 0.360_761_573_048_138_6],
    [0.932_469_514_203_152, 0.171_324_492_379_170_4],
];

/// What is loaded: rectangles in rows along the track, equal rows across it.
struct Around {
    /// Distance along, m, and load over that of the one that is asked for; that one first.
    along: [(f64, f64); 3],
    /// Distance to the row of the other half sleeper, m.
    across: Option<f64>,
}

impl Around {
    fn of(bearing: &Bearing, neighbours: f64) -> Around {
        let [left, right] = bearing.spacings;
        let across = bearing.to_centre.map(|gap| bearing.length + 2.0 * gap);
        Around { along: [(0.0, 1.0), (-left, neighbours), (right, neighbours)], across }
    }

    /// The longest way over which their waves meet, m: from corner to corner of the plan.
    fn reach(&self, [a, b]: [f64; 2]) -> f64 {
        let along = self.along.iter().filter(|n| n.1 > 0.0).map(|n| n.0.abs()).fold(0.0, f64::max);
        f64::hypot(along + a, self.across.unwrap_or(0.0) + b)
    }

    /// Settlement of a half-space under all of them, m/N.
    fn endless(&self, sides: [f64; 2], youngs_modulus: f64, poisson_ratio: f64) -> f64 {
        let rows = [Some(0.0), self.across];
        let one = |y: f64, x: f64| mean_settlement(sides, [x, y], youngs_modulus, poisson_ratio);
        let row = |y: f64| self.along.iter().filter(|n| n.1 > 0.0).map(|n| n.1 * one(y, n.0)).sum::<f64>();
        rows.into_iter().flatten().map(row).sum()
    }

    /// Share of a wave that they make, seen from the first.
    fn wave(&self, kx: f64, ky: f64) -> f64 {
        let [_, (left, share), (right, _)] = self.along;
        let along = match (share > 0.0, -left == right) {
            (false, _) => 1.0,
            (true, true) => 1.0 + 2.0 * share * (kx * right).cos(),
            (true, false) => 1.0 + share * ((kx * left).cos() + (kx * right).cos()),
        };
        along * self.across.map_or(1.0, |y| 1.0 + (ky * y).cos())
    }
}

/// The support, with `waves` of a stack before, which may serve again.
pub(super) fn support(
    bearing: &Bearing,
    layers: &[Layer],
    below: Below,
    neighbours: f64,
    waves: &mut Option<Waves>,
) -> Support {
    // a layer that has run out is not there; its bottom lies where that of the one above does
    let solid: Vec<Layer> = layers.iter().filter(|layer| layer.thickness > 0.0).copied().collect();
    let sides = [bearing.width, bearing.length];
    let around = Around::of(bearing, neighbours);
    let top = solid[0];
    let depth = solid.iter().map(|layer| layer.thickness).sum();
    if waves.as_ref().is_none_or(|waves| waves.of != [top.thickness, depth]) {
        *waves = Some(Waves::new(sides, &around, top.thickness, depth));
    }
    let each = waves.as_ref().map_or(&[][..], |waves| &waves.each);
    let (difference, below_axis) = integrals(each, &solid, below);
    let compliance = around.endless(sides, top.youngs_modulus, top.poisson_ratio) + difference;
    let at_sleeper = 1.0 / (bearing.width * bearing.length);
    let mut deeper = below_axis.into_iter();
    let mut pressures = vec![at_sleeper];
    for layer in layers {
        let above = pressures[pressures.len() - 1];
        pressures.push(if layer.thickness > 0.0 { deeper.next().unwrap_or(above) } else { above });
    }
    Support { stiffness: 1.0 / compliance, masses: Vec::new(), pressures }
}

/// What the plan of the load makes of the waves that are integrated over: the same for every stack whose first layer and
/// whole are as thick, and most of the work.
pub(super) struct Waves {
    /// Thickness of the first layer and of all, m.
    of: [f64; 2],
    each: Vec<Wave>,
}

struct Wave {
    /// 1/m.
    k: f64,
    /// Of its node, 1/m.
    weight: f64,
    /// See [`averages`].
    mean: f64,
    axis: f64,
}

impl Waves {
    fn new(sides: [f64; 2], around: &Around, first: f64, depth: f64) -> Waves {
        let [a, b] = sides;
        let reach = around.reach(sides);
        let last = (SHORTEST / first).min(FINEST / a.min(b));
        let (mut each, mut from) = (Vec::new(), 0.0);
        while from < last {
            // short panels where the depth of the whole is felt, later as long as the plan of the load allows
            let to = f64::min(from + (0.5 * from).clamp(0.3 / depth.max(reach), 4.0 / reach), last);
            each.extend(NODES.iter().flat_map(|[x, w]| [[*x, *w], [-x, *w]]).map(|[node, weight]| {
                let k = 0.5 * (from + to) + 0.5 * (to - from) * node;
                let [mean, axis] = averages(k, sides, around, reach);
                Wave { k, weight: 0.5 * (to - from) * weight / (2.0 * PI), mean, axis }
            }));
            from = to;
        }
        Waves { of: [first, depth], each }
    }
}

/// Settlement beyond that of the first layer's half-space, m/N, and pressure below the axis at the bottom of each layer,
/// 1/m^2, for each newton of load.
fn integrals(waves: &[Wave], layers: &[Layer], below: Below) -> (f64, Vec<f64>) {
    let top = layers[0];
    let endless = 2.0 * (1.0 - top.poisson_ratio * top.poisson_ratio) / top.youngs_modulus;
    let kernel = Kernel::new(layers, below);
    let (mut settlement, mut pressures) = (0.0, vec![0.0; layers.len()]);
    for Wave { k, weight, mean, axis } in waves {
        let answer = kernel.answer(*k);
        settlement += weight * (answer.settlement - endless) * mean;
        for (pressure, found) in pressures.iter_mut().zip(&answer.pressures) {
            *pressure += weight * k * found * axis;
        }
    }
    (settlement, pressures)
}

/// Averages over all directions of a wave: of the load's plan seen by the mean of the rectangle, and by its middle. The
/// midpoint rule over a period converges faster than any power once it resolves the plan.
fn averages(k: f64, [a, b]: [f64; 2], around: &Around, reach: f64) -> [f64; 2] {
    // a quarter for each radian resolves it, a fifth more makes the rest of no account
    let points = 8 + (0.3 * k * reach).ceil() as usize;
    let mut sums = [0.0; 2];
    // from one angle to the next by the theorem of addition: a fifth of the time, and exact to rounding
    let angle = FRAC_PI_2 / points as f64;
    let ((step_sin, step_cos), (mut sin, mut cos)) = (angle.sin_cos(), (0.5 * angle).sin_cos());
    for _ in 0..points {
        let (kx, ky) = (k * cos, k * sin);
        (sin, cos) = (sin * step_cos + cos * step_sin, cos * step_cos - sin * step_sin);
        let plan = sinc(0.5 * kx * a) * sinc(0.5 * ky * b);
        let others = around.wave(kx, ky);
        sums[0] += plan * plan * others;
        sums[1] += plan * others;
    }
    sums.map(|sum| sum / points as f64)
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}
