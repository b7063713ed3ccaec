//! The clumps of a bed, made before it is packed, so that a check refuses a scene whose grains do not fit.

use super::memo::Memo;
use crate::solvers::granular::clump::Template;
use crate::solvers::granular::grains::{ClumpShape, Surfaces, TemplatesError};
use crate::solvers::granular::packing::widest;
use rayon::prelude::*;

/// Templates of a packing.
type Made = Result<Vec<Template>, TemplatesError>;

/// The widest clumps of shapes and seeds: all tiers of a plan and all points of a study ask for the same.
static WIDEST: Memo<(ClumpShape, Vec<u64>), Made> = Memo::new(8);

/// Clumps of the shapes of a scene.
pub(super) struct Clumps {
    /// The seeds of all packings; an empty list uses spheres instead of clumps.
    seeds: Vec<u64>,
}

impl Clumps {
    /// Clumps for a number of packings with consecutive seeds.
    pub fn made(seed: u64, packings: u32) -> Clumps {
        let seeds = (0..u64::from(packings.max(1))).map(|number| seed.wrapping_add(number)).collect();
        Clumps { seeds }
    }

    pub fn spheres() -> Clumps {
        Clumps { seeds: Vec::new() }
    }

    /// The templates of the packing with the widest clumps. Fails if a packing has no templates.
    pub fn widest(&self, shape: Option<&ClumpShape>) -> Made {
        let Some(shape) = shape.filter(|_| !self.seeds.is_empty()) else {
            return Ok(Template::sphere(0.5).map(|sphere| vec![sphere]).unwrap_or_default());
        };
        WIDEST.get((shape.clone(), self.seeds.clone()), |(shape, seeds)| of_seeds(shape, seeds))
    }
}

fn of_seeds(shape: &ClumpShape, seeds: &[u64]) -> Made {
    // scanned surfaces are the same in every packing
    let seeds = if matches!(shape.surfaces, Surfaces::Meshes(_)) { &seeds[..1] } else { seeds };
    let made: Result<Vec<_>, _> = seeds.par_iter().map(|seed| shape.templates(*seed)).collect();
    Ok(made?.into_iter().max_by(|a, b| widest(a).total_cmp(&widest(b))).unwrap_or_default())
}
