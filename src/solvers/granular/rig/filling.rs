//! What cribs and shoulders are filled with, and how high.

use super::super::packing::{GrainLayer, Recipe};
use serde::{Deserialize, Serialize};

/// Share of the space that poured grains are thought to fill. What they lack the next pour makes up for.
pub const SOLID: f64 = 0.55;

/// How high grains lie between sleepers and beside their ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crib {
    /// Above the underside of the sleepers, m.
    pub height: f64,
    /// Width of the grains beyond the ends of the sleepers, m; 0 fills no more than the space between them.
    pub shoulder: f64,
}

/// What the cribs of a bed are filled with.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling {
    pub crib: Crib,
    /// The material of the grains, and its surface.
    pub layer: GrainLayer,
    pub surface: u16,
    /// Length and width of the bed, m.
    pub plan: [f64; 2],
    pub seed: u64,
}

impl Crib {
    /// The grains of the top layer of a recipe, over so many of its cells side by side; `None` of a recipe without layers.
    pub fn filling(&self, recipe: &Recipe, cells: u32) -> Option<Filling> {
        let layer = recipe.layers.last()?.clone();
        let [length, width] = recipe.plan;
        Some(Filling {
            crib: *self,
            layer,
            surface: recipe.wall_surface() - 1,
            plan: [length * f64::from(cells), width],
            seed: recipe.seed,
        })
    }
}
