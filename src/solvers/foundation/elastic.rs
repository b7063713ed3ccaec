//! Half a sleeper as a uniform pressure on a rectangle, on bonded elastic layers, with its neighbours beside it.
//!
//! The mean settlement of a rectangle of sides a and b is an integral over all wave numbers k of its load,
//!
//! ```text
//! F / (2 pi) int f(k) R(k) dk,   R(k) = (2 / pi) int_0^(pi/2) (sinc(kx a/2) sinc(ky b/2))^2 P(kx, ky) da
//! ```
//!
//! Here f is the settlement by the [`Kernel`], `kx = k cos a`, `ky = k sin a`, and P adds a cosine for each neighbour.
//! The settlement of a half-space with the material of the first layer has a closed form, see [`super::rectangle`].
//! Only the difference to it is integrated; the difference decays as `exp(-2 k h)` with the thickness h of the first
//! layer. A stiff sleeper settles less than the mean of a uniform pressure: 7 % less on a half-space, equally on a thin
//! layer.

use super::kernel::Kernel;
use super::layers::{Bearing, Below, Layer, Support};
use super::rectangle::mean_settlement;
use super::sine::{LANES, sine};
use std::f64::consts::{FRAC_PI_2, PI};
use std::iter;

/// Wave number times thickness of the first layer above which waves have no effect below it: less than 1e-4 of the
/// pressure there, and 1e-10 of the settlement.
const SHORTEST: f64 = 12.0;
/// Upper limit of wave number times the shorter side; shorter waves have no effect for any thickness of the first
/// layer.
const FINEST: f64 = 200.0;
/// Largest panel of the integral, times the distance over which waves of the plan interfere: its nodes integrate to
/// 1e-9.
const PANEL: f64 = 24.0;
/// Gauss-Legendre nodes and weights on -1 .. 1, the positive half of sixteen.
const NODES: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_6],
    [0.458_016_777_657_227_4, 0.169_156_519_395_002_5],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_7],
    [0.755_404_408_355_003, 0.124_628_971_255_533_9],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_8],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_9],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_1],
];

/// The loaded area: rectangles in rows along the track, equal rows across the track.
struct Plan {
    /// Along and across the track, m.
    sides: [f64; 2],
    /// Distances to the neighbours along the track, m, and their load divided by the load of this sleeper.
    spacings: [f64; 2],
    share: f64,
    /// Distance to the row of the other half sleeper, m.
    across: Option<f64>,
}

impl Plan {
    fn new(bearing: &Bearing, neighbours: f64) -> Plan {
        Plan {
            sides: [bearing.width, bearing.length],
            spacings: bearing.spacings,
            share: neighbours,
            across: bearing.to_centre.map(|gap| bearing.length + 2.0 * gap),
        }
    }

    /// The longest distance over which their waves interfere, m: from corner to corner of the plan.
    fn reach(&self) -> f64 {
        let along = if self.share > 0.0 { self.spacings[0].max(self.spacings[1]) } else { 0.0 };
        f64::hypot(along + self.sides[0], self.across.unwrap_or(0.0) + self.sides[1])
    }

    /// Settlement of a half-space under all rectangles, m/N.
    fn endless(&self, youngs_modulus: f64, poisson_ratio: f64) -> f64 {
        let one = |x: f64, y: f64| mean_settlement(self.sides, [x, y], youngs_modulus, poisson_ratio);
        let [left, right] = self.spacings;
        let row = |y: f64| one(0.0, y) + self.share * (one(left, y) + one(right, y));
        row(0.0) + self.across.map_or(0.0, row)
    }

    /// Averages over all directions of a wave: the effect of the load on the mean of the rectangle, and on its middle.
    /// The midpoint rule over a period converges faster than any power once it resolves the plan.
    fn averages(&self, k: f64, reach: f64) -> [f64; 2] {
        // a quarter for each radian resolves it; a fifth more makes the error negligible
        let rounds = 1 + (0.3 * k * reach / LANES as f64).ceil() as usize;
        let points = (rounds * LANES) as f64;
        let [a, b] = self.sides.map(|side| 0.5 * k * side);
        let [left, right] = self.spacings.map(|spacing| k * spacing);
        let (other, row) = self.across.map_or((0.0, 0.0), |distance| (1.0, k * distance));
        let (mut means, mut axes) = ([0.0; LANES], [0.0; LANES]);
        for round in 0..rounds {
            for (lane, (mean, axis)) in means.iter_mut().zip(&mut axes).enumerate() {
                let angle = FRAC_PI_2 / points * ((round * LANES + lane) as f64 + 0.5);
                let (along, across) = (sine(angle + FRAC_PI_2), sine(angle));
                let cosine = |x: f64| sine(x + FRAC_PI_2);
                let plan = sine(a * along) * sine(b * across) / (a * along * b * across);
                let neighbours = 1.0 + self.share * (cosine(left * along) + cosine(right * along));
                let all = plan * neighbours * (1.0 + other * cosine(row * across));
                *mean += plan * all;
                *axis += all;
            }
        }
        [means, axes].map(|lanes| lanes.iter().sum::<f64>() / points)
    }
}

/// The support; `waves` are the waves of earlier stacks, which are reused if possible.
pub(super) fn support(
    bearing: &Bearing,
    layers: &[Layer],
    below: Below,
    neighbours: f64,
    known: &mut Vec<Waves>,
) -> Support {
    // a layer of thickness zero is left out; its bottom is the bottom of the layer above
    let solid: Vec<Layer> = layers.iter().filter(|layer| layer.thickness > 0.0).copied().collect();
    let plan = Plan::new(bearing, neighbours);
    let (top, depth) = (solid[0], solid.iter().map(|layer| layer.thickness).sum());
    let panels = panels(&plan, top.thickness, depth);
    let waves = match known.iter().position(|waves| waves.panels == panels) {
        Some(waves) => waves,
        None => {
            known.push(Waves::new(&plan, panels));
            known.len() - 1
        }
    };
    let (difference, below_axis) = integrals(&known[waves].each, &solid, below);
    let compliance = plan.endless(top.youngs_modulus, top.poisson_ratio) + difference;
    let at_sleeper = 1.0 / (bearing.width * bearing.length);
    let mut deeper = below_axis.into_iter();
    let mut pressures = vec![at_sleeper];
    for layer in layers {
        let above = pressures[pressures.len() - 1];
        pressures.push(if layer.thickness > 0.0 { deeper.next().unwrap_or(above) } else { above });
    }
    Support { stiffness: 1.0 / compliance, masses: Vec::new(), pressures }
}

/// Ends of the panels of the integral over k, 1/m: short while the total depth has an effect, later as long as the plan
/// of the load allows.
///
/// The depth is rounded to a power of two and the last panel is complete, so that similar stacks have the same panels.
fn panels(plan: &Plan, first: f64, depth: f64) -> Vec<f64> {
    let reach = plan.reach();
    let last = (SHORTEST / first).min(FINEST / plan.sides[0].min(plan.sides[1]));
    // a stiff plate on soft ground acts over several times its thickness
    let shortest = 0.25 / depth.log2().ceil().exp2().max(reach);
    let end = |from: f64| from + (3.0 * from).clamp(shortest, PANEL / reach);
    iter::successors(Some(end(0.0)), |from| (*from < last).then(|| end(*from))).collect()
}

/// The effect of the plan of the load for the waves of the integral: the same for every stack with the same panels, and
/// most of the work.
pub(super) struct Waves {
    panels: Vec<f64>,
    each: Vec<Wave>,
}

struct Wave {
    /// 1/m.
    k: f64,
    /// Weight of its node, 1/m.
    weight: f64,
    /// See [`Plan::averages`].
    mean: f64,
    axis: f64,
}

impl Waves {
    fn new(plan: &Plan, panels: Vec<f64>) -> Waves {
        let reach = plan.reach();
        let starts = iter::once(0.0).chain(panels.iter().copied());
        let both = NODES.iter().flat_map(|[x, w]| [[*x, *w], [-x, *w]]);
        let nodes = starts.zip(&panels).flat_map(|(from, to)| {
            let half = 0.5 * (to - from);
            both.clone().map(move |[x, w]| (from + half * (1.0 + x), half * w))
        });
        let wave = |(k, weight)| {
            let [mean, axis] = plan.averages(k, reach);
            Wave { k, weight: weight / (2.0 * PI), mean, axis }
        };
        let each = nodes.map(wave).collect();
        Waves { panels, each }
    }
}

/// Settlement in addition to the half-space of the first layer, m/N, and pressure below the axis at the bottom of each
/// layer, 1/m^2, per newton of load.
fn integrals(waves: &[Wave], layers: &[Layer], below: Below) -> (f64, Vec<f64>) {
    let top = layers[0];
    let endless = 2.0 * (1.0 - top.poisson_ratio * top.poisson_ratio) / top.youngs_modulus;
    let mut kernel = Kernel::new(layers, below);
    let (mut settlement, mut pressures) = (0.0, vec![0.0; layers.len()]);
    for Wave { k, weight, mean, axis } in waves {
        settlement += weight * (kernel.settlement(*k) - endless) * mean;
        for (pressure, found) in pressures.iter_mut().zip(kernel.pressures()) {
            *pressure += weight * k * found * axis;
        }
    }
    (settlement, pressures)
}
