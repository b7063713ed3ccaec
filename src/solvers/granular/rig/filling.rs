//! The grains of cribs and shoulders, and their height.

use super::super::packing::{GrainLayer, Recipe};
use serde::{Deserialize, Serialize};

/// Estimated solid share of poured grains. The next pour adds the missing grains.
pub const SOLID: f64 = 0.55;

/// Height of the grains between sleepers and beside their ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crib {
    /// Above the underside of the sleepers, m.
    pub height: f64,
    /// Width of the grains beyond the ends of the sleepers, m; with 0 only the space between the sleepers is filled.
    pub shoulder: f64,
}

/// The filling of the cribs of a bed.
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
    /// The grains of the top layer of a recipe, for `cells` cells side by side; `None` if the recipe has no layers.
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
