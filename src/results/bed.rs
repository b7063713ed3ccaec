//! Packed beds that were built before, by what made them: a folder with one folder for each recipe.

use super::{BedReadings, ResultsError, checkpoint};
use crate::lower::BedPlan;
use crate::solvers::granular::packing::{METHOD, Packed, Recipe, Stage, Stored};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Names what a recipe makes: the same recipe gives the same bed, bit by bit, for one version of the program.
pub fn bed_hash(recipe: &Recipe) -> String {
    hash_of(recipe)
}

pub(super) fn hash_of(what: &impl Serialize) -> String {
    let text = format!("{METHOD} {}", serde_json::to_string(what).unwrap_or_default());
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A bed of this recipe that was kept; `None` where there is none that can be used.
pub fn kept_bed(cache: &Path, recipe: &Recipe) -> Option<Packed<f32>> {
    let hash = bed_hash(recipe);
    let stored: Stored<f32> = checkpoint::read(&cache.join(&hash), &hash).ok()??;
    Packed::restore(stored).ok()
}

/// Keeps a bed that is finished, whole or not at all.
pub fn keep_bed(cache: &Path, recipe: &Recipe, bed: &Packed<f32>) -> Result<(), ResultsError> {
    let hash = bed_hash(recipe);
    checkpoint::write(&cache.join(&hash), &hash, &bed.store())
}

/// What people read off a bed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BedSummary {
    pub title: String,
    /// Of the trackform.
    pub section: String,
    pub hash: String,
    /// Of the cell along the track and across, m.
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
    /// Of the whole layer, walls included, and of what lies a quarter of its thickness inside.
    pub porosity: f64,
    pub inner_porosity: f64,
    /// Largest distance between the curve that was asked for and that of the grains, as a share of the mass.
    pub grading_error: f64,
    /// Neighbours a body under the plate, before friction came back; then in the finished bed, of all bodies and of those
    /// that are no rattlers.
    pub coordination_pressed: f64,
    pub coordination: f64,
    pub coordination_without_rattlers: f64,
    /// Share of bodies with fewer than two neighbours.
    pub rattlers: f64,
}

/// Sums up a bed of a plan, with what was read off it.
pub fn bed_summary(title: &str, plan: &BedPlan, packed: &Packed<f32>, readings: Option<BedReadings>) -> BedSummary {
    let recipe = &plan.recipe;
    let layers = (0..recipe.layers.len()).map(|number| bed_layer(recipe, packed, number)).collect();
    BedSummary {
        title: title.to_owned(),
        section: plan.section.clone(),
        hash: bed_hash(recipe),
        plan_m: recipe.plan,
        bodies: packed.bed.len(),
        pebbles: packed.bed.pebbles().count(),
        layers,
        stages: packed.stages.clone(),
        notes: plan.notes.iter().chain(readings.iter().flat_map(|readings| &readings.notes)).cloned().collect(),
        readings,
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
