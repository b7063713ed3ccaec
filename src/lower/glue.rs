//! Glued grains: their data in the plan.

use crate::scenario::{Granular, Layer, Scenario};
use crate::solvers::granular::Glue;
use crate::solvers::granular::rig::Glued;

/// Lengths that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// Glued parts of a bed that lies between two chainages (m) of a section.
pub(super) fn along(scenario: &Scenario, section: usize, [left, right]: [f64; 2]) -> Vec<Glued> {
    let parts = scenario.track.ground(section);
    let inside = parts.iter().filter(|part| part.start < right - TINY && part.end > left + TINY);
    let of_part = |part: &crate::scenario::Groundwork| {
        let along = [part.start.max(left) - left, part.end.min(right) - left];
        of_layers(&part.layers).map(|glued| Glued { along: Some(along), ..glued }).collect::<Vec<_>>()
    };
    inside.flat_map(of_part).collect()
}

/// Glued layers at a chainage (m) of a section, used for the whole length of a bed; at the end of a glued part the
/// layers of that part.
pub(super) fn at_place(scenario: &Scenario, section: usize, x: f64) -> Vec<Glued> {
    let parts = scenario.track.ground(section);
    let here = parts.iter().filter(|part| (part.start - TINY..=part.end + TINY).contains(&x));
    here.map(|part| of_layers(&part.layers).collect()).find(|glued: &Vec<Glued>| !glued.is_empty()).unwrap_or_default()
}

/// Layers with bonds; the layers of grains are numbered from the floor upwards.
fn of_layers(layers: &[Layer]) -> impl Iterator<Item = Glued> {
    let grains = layers.iter().rev().filter_map(Layer::granular).enumerate();
    grains.filter_map(|(number, grains)| Some(Glued { surface: number as u16, along: None, glue: glue(grains)? }))
}

fn glue(grains: &Granular) -> Option<Glue> {
    let bond = grains.bond?;
    Some(Glue {
        normal_stiffness: *bond.stiffness,
        shear_stiffness: *bond.stiffness * *grains.shear_ratio,
        tensile_strength: *bond.tensile_strength,
        shear_strength: *bond.shear_strength,
    })
}
