//! What a rig costs, without packing it: grains from gradings, steps from the lightest grain.

use super::{cycles, is_rig, loads, period, rest_time};
use crate::lower::bed::{confinement, plan};
use crate::scenario::{Contact, Granular, Scenario, Shape};
use crate::solvers::granular::grains::Curve;
use crate::solvers::granular::packing::lifts_that_fit;
use serde::Serialize;
use std::f64::consts::PI;

/// Share of the volume that grains fill in a packed bed.
const SOLID: f64 = 0.6;
/// Over sqrt(m / k) of the lightest grain, the step of a test and that of packing, which holds light grains back.
const STEP: f64 = 0.1;
const PACKING_STEP: f64 = 0.25;
/// Time, s, that a stage of packing takes, and stages beside those of lifts; and the setting down of sleepers, at twice the step.
const STAGE: f64 = 0.45;
const LAST_STAGES: u32 = 3;
const SET_DOWN: f64 = 0.15;
/// Steps of a pebble a second on two cores, of clumps of three, while it is packed and tested (`docs/validation.md`).
const PEBBLE_STEPS: [f64; 2] = [10e6, 20e6];
/// Time on one core over that on two.
const SECOND_CORE: f64 = 1.7;

/// An estimate, good to a factor of two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RigCost {
    pub grains: f64,
    pub pebbles: f64,
    /// s.
    pub time_step: f64,
    pub packing_steps: f64,
    /// Setting down included.
    pub test_steps: f64,
    pub repeats: u32,
    /// Of all repeats, on two cores, s.
    pub seconds: f64,
}

impl RigCost {
    /// Of all repeats, s.
    pub fn seconds_on_one_core(&self) -> f64 {
        SECOND_CORE * self.seconds
    }
}

/// The estimate for a rig; `None` where a scene is none, or a grading no curve.
pub fn rig_cost(scenario: &Scenario) -> Option<RigCost> {
    if !is_rig(scenario) {
        return None;
    }
    let section = &scenario.track.sections[0];
    let materials: Vec<(f64, &Granular, Curve)> = section
        .layers
        .iter()
        .filter_map(|layer| {
            let granular = layer.granular()?;
            Some((layer.thickness.at(section.start), granular, granular.grading.curve().ok()?))
        })
        .collect();
    let largest = materials.iter().map(|(_, _, curve)| curve.ends()[1]).fold(0.0, f64::max);
    let [length, width] = plan(scenario, 0, largest);
    let copies = ((section.end - section.start) / length - 1e-9).ceil().max(1.0);
    let plan = length * width;
    let pressure = |granular: &Granular| confinement(scenario).unwrap_or(*granular.packing.pressure);
    let of =
        |(_, granular, curve): &(f64, &Granular, Curve)| [curve.mean_volume(), *granular.density, pressure(granular)];
    let rest = rest_time(materials.iter().map(of));
    let (mut grains, mut pebbles, mut lifts, mut light) = (0.0, 0.0, 0, f64::INFINITY);
    for (thickness, granular, curve) in &materials {
        let count = SOLID * plan * thickness / curve.mean_volume();
        grains += count;
        pebbles += count * pebbles_of(&granular.shape);
        lifts += lifts_that_fit(granular.packing.lifts, *thickness, curve);
        light = light.min(lightest(granular, curve));
    }
    let step = STEP * light;
    let packing_steps = STAGE * f64::from(lifts + LAST_STAGES) / (PACKING_STEP * light);
    let loads = loads(scenario);
    let test_steps = (SET_DOWN + (0.5 + cycles(&loads) as f64) * period(&loads, rest)) / step;
    let repeats = scenario.solve.grains.repeats;
    // while a bed is packed half of it is there on average
    let [packing, testing] = [0.5 * packing_steps, copies * test_steps];
    let seconds = f64::from(repeats) * pebbles * (packing / PEBBLE_STEPS[0] + testing / PEBBLE_STEPS[1]);
    let (grains, pebbles) = (copies * grains, copies * pebbles);
    Some(RigCost { grains, pebbles, time_step: step, packing_steps, test_steps, repeats, seconds })
}

fn pebbles_of(shape: &Shape) -> f64 {
    match shape {
        Shape::Clumps { pebbles: [fewest, most], .. } => f64::from(fewest + most) / 2.0,
        _ => 1.0,
    }
}

/// sqrt(m / k) of the lightest grain on one contact, s.
fn lightest(granular: &Granular, curve: &Curve) -> f64 {
    let mass = *granular.density * PI / 6.0 * curve.ends()[0].powi(3);
    let stiffness = match granular.contact {
        Contact::Linear { stiffness } => *stiffness * granular.shear_ratio.max(1.0),
        // beds of such grains are refused before anything runs
        Contact::Hertz { .. } => return f64::INFINITY,
    };
    (mass / stiffness).sqrt()
}
