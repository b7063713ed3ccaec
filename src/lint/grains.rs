//! Common parts of the rules for grains: the layers that are modelled as grains, and the contact forces in them.

use super::{Led, led};
use crate::graph::{Graph, Model};
use crate::lint::dynamic::amplification;
use crate::lint::winkler::seat_load;
use crate::scenario::{Contact, Granular, Layer, Loading, Origin, Scenario, Section, Target};
use std::f64::consts::PI;

/// Share of the volume that grains fill in a packed bed.
const SOLID: f64 = 0.6;
/// Contacts of a grain in a packed bed.
const CONTACTS: f64 = 6.0;

/// A layer whose grains are modelled.
#[derive(Clone, Copy)]
pub(super) struct GrainLayer<'a> {
    /// Index into the sections of the track.
    pub index: usize,
    pub section: &'a Section,
    pub layer: &'a Layer,
    pub granular: &'a Granular,
    /// Whether the sleepers lie on it.
    pub top: bool,
}

/// The granular layers of a scene whose plan has grains; none if a settlement law is used.
pub(super) fn beds<'a>(scenario: &'a Scenario, graph: &Graph) -> Vec<GrainLayer<'a>> {
    if !graph.nodes.iter().any(|node| matches!(node.model, Model::Bed(_) | Model::Grains(_) | Model::Cells(_))) {
        return Vec::new();
    }
    let sections = scenario.track.sections.iter().enumerate();
    let layers = sections.flat_map(|(index, section)| {
        let numbered = section.layers.iter().enumerate();
        numbered.filter_map(move |(depth, layer)| {
            let granular = layer.granular()?;
            Some(GrainLayer { index, section, layer, granular, top: depth == 0 })
        })
    });
    layers.collect()
}

/// A length in mm, to a tenth.
pub(super) fn mm(length: f64) -> String {
    crate::units::number((length * 1e4).round() / 10.0)
}

/// The place that gives the largest grain of a granular material: its cut, else its density, which stands beside its
/// grading.
pub(super) fn of_sizes(granular: &Granular) -> Origin {
    granular.grading.cut_above.map_or(granular.density.origin, |cut| cut.origin)
}

impl GrainLayer<'_> {
    /// Pressure on the layer, Pa: the packing pressure. Under sleepers it is at least the pressure of a passing wheel,
    /// in a rig at
    /// least the pressure of its loads.
    pub fn pressure(&self, scenario: &Scenario, graph: &Graph) -> f64 {
        let packed = *self.granular.packing.pressure;
        let loaded = match led(scenario, graph) {
            Some(traffic) if self.top => under_sleepers(scenario, graph, traffic, self.index),
            None if self.top => under_loads(scenario, self.index),
            _ => 0.0,
        };
        packed.max(loaded)
    }
}

/// Pressure under the sleepers of a section as a wheel passes, Pa; 0 if the size of the sleepers is unknown.
fn under_sleepers(scenario: &Scenario, graph: &Graph, traffic: Led<'_>, section: usize) -> f64 {
    let track = &scenario.track;
    let Some(load) = seat_load(scenario, graph, traffic, section) else { return 0.0 };
    let area = track.seats[track.seats_of(section)].iter().find_map(|s| track.bearing_area(s));
    area.map_or(0.0, |area| load.peak.force * amplification(*traffic.train.speed) / area)
}

/// Pressure under the sleepers of a rig at the largest force of its loads, Pa; 0 without loads.
fn under_loads(scenario: &Scenario, section: usize) -> f64 {
    let track = &scenario.track;
    let Some(Loading::Rig(loads)) = &scenario.loading else { return 0.0 };
    let area = track.seats[track.seats_of(section)].iter().find_map(|seat| track.bearing_area(seat));
    let forces = loads.iter().filter(|load| load.on == Target::Sleepers).map(|load| load.force.largest());
    area.map_or(0.0, |area| forces.fold(0.0, f64::max) / area)
}

/// Mean normal force, N, between grains of a size, m, under a pressure, Pa: `F = pi d^2 p / (Z phi)` for spheres of one
/// size with Z contacts each that fill the share phi of the volume (Agnolin and Roux 2007, Phys. Rev. E 76, 061302; not
/// at hand).
pub(super) fn contact_force(size: f64, pressure: f64) -> f64 {
    PI * size * size * pressure / (CONTACTS * SOLID)
}

/// Approach of two grains of a size, m, under a normal force, N.
///
/// Linear: `F = k d`. Hertz: `F = 4/3 E* sqrt(R*) d^1.5` with `E* = E / 2 (1 - nu^2)` and `R* = R / 2`.
pub(super) fn approach(contact: &Contact, size: f64, force: f64) -> f64 {
    match contact {
        Contact::Linear { stiffness } => force / **stiffness,
        Contact::Hertz { youngs_modulus, poisson_ratio } => {
            let modulus = **youngs_modulus / (2.0 * (1.0 - **poisson_ratio * **poisson_ratio));
            let factor = 4.0 / 3.0 * modulus * (size / 4.0).sqrt();
            (force / factor).powf(2.0 / 3.0)
        }
    }
}
