//! Summary of a packed bed.

use super::{BedReadings, bed_hash};
use crate::graph::BedRecipe;
use crate::solvers::granular::packing::{Packed, Recipe, Stage};
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedSummary {
    pub title: String,
    /// Name of the trackform.
    pub section: String,
    pub hash: String,
    /// Size of the cell along the track and across, m.
    pub plan_m: [f64; 2],
    pub bodies: usize,
    pub pebbles: usize,
    /// From the floor upwards.
    pub layers: Vec<BedLayer>,
    pub stages: Vec<Stage>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub readings: Option<BedReadings>,
    pub notes: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedLayer {
    pub name: String,
    pub bodies: usize,
    /// m.
    pub thickness_asked_m: f64,
    pub thickness_m: f64,
    /// Porosity of the whole layer, walls included, and of its inner part, a quarter of the thickness away from its
    /// borders.
    pub porosity: f64,
    pub inner_porosity: f64,
    /// Largest difference between the target grading and the grading of the grains, as a share of the mass.
    pub grading_error: f64,
    /// Neighbours per body: under the plate, before friction is switched on again; in the finished bed, for all bodies;
    /// the same without rattlers.
    pub coordination_pressed: f64,
    pub coordination: f64,
    pub coordination_without_rattlers: f64,
    /// Share of bodies with fewer than two neighbours.
    pub rattlers: f64,
}

/// Difference between actual and requested thickness that is reported, as a share of the requested one.
const MISSED: f64 = 0.05;

/// Summary of a bed of a plan, with its readings.
pub fn bed_summary(title: &str, plan: &BedRecipe, packed: &Packed<f32>, readings: Option<BedReadings>) -> BedSummary {
    let recipe = &plan.recipe;
    let layers: Vec<BedLayer> = (0..recipe.layers.len()).map(|number| bed_layer(recipe, packed, number)).collect();
    let read = readings.iter().flat_map(|readings| &readings.notes).cloned();
    let notes = plan.notes.iter().cloned().chain(layers.iter().filter_map(BedLayer::missed)).chain(read).collect();
    BedSummary {
        title: title.to_owned(),
        section: plan.section.clone(),
        hash: bed_hash(recipe),
        plan_m: recipe.plan,
        bodies: packed.bed.len(),
        pebbles: packed.bed.pebbles().count(),
        layers,
        stages: packed.stages.clone(),
        notes,
        readings,
    }
}

impl BedLayer {
    /// Note on a layer whose thickness differs from the requested one.
    fn missed(&self) -> Option<String> {
        let (asked, reached) = (self.thickness_asked_m, self.thickness_m);
        ((reached / asked - 1.0).abs() > MISSED).then(|| {
            let mm = |length: f64| (1e3 * length).round();
            let (name, reached, asked) = (&self.name, mm(reached), mm(asked));
            format!(
                "`{name}` is {reached} mm thick, not {asked} mm as asked. The number of grains is estimated before \
                packing."
            )
        })
    }
}

fn bed_layer(recipe: &Recipe, packed: &Packed<f32>, number: usize) -> BedLayer {
    let asked = &recipe.layers[number];
    let [low, high] = packed.between(number);
    let inset = 0.25 * (high - low);
    let [pressed, finished] = packed.pressed_and_at_rest().map(|state| state.layers[number]);
    BedLayer {
        name: asked.name.clone(),
        bodies: finished.bodies,
        thickness_asked_m: asked.thickness,
        thickness_m: high - low,
        porosity: packed.porosity([low, high]),
        inner_porosity: packed.porosity([low + inset, high - inset]),
        grading_error: packed.samples[number].error(),
        coordination_pressed: pressed.coordination,
        coordination: finished.coordination,
        coordination_without_rattlers: finished.without_rattlers,
        rattlers: finished.rattlers as f64 / finished.bodies.max(1) as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_that_misses_its_thickness_says_so() {
        let of = |thickness_m: f64| BedLayer {
            name: "gravel".to_owned(),
            bodies: 100,
            thickness_asked_m: 0.3,
            thickness_m,
            porosity: 0.4,
            inner_porosity: 0.4,
            grading_error: 0.0,
            coordination_pressed: 6.0,
            coordination: 5.0,
            coordination_without_rattlers: 5.0,
            rattlers: 0.0,
        };
        assert_eq!((of(0.29).missed(), of(0.312).missed()), (None, None));
        let told = "`gravel` is 259 mm thick, not 300 mm as asked. The number of grains is estimated before packing.";
        assert_eq!(of(0.2592).missed().as_deref(), Some(told));
        assert!(of(0.341).missed().is_some());
    }
}
