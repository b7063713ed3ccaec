//! The clumps that a bed will be packed of, made before it is packed: so that a scene whose grains find no room is refused by a check.

use crate::solvers::granular::clump::Template;
use crate::solvers::granular::grains::{ClumpShape, Surfaces, TemplatesError};
use crate::solvers::granular::packing::widest;
use rayon::prelude::*;

/// Clumps of the shapes of a scene, each made once.
pub(super) struct Clumps {
    /// The seeds of all packings; none puts spheres in the place of clumps.
    seeds: Vec<u64>,
    made: Vec<(ClumpShape, Result<Vec<Template>, TemplatesError>)>,
}

impl Clumps {
    /// Those of so many packings: the seeds of packings follow each other.
    pub fn made(seed: u64, packings: u32) -> Clumps {
        let seeds = (0..u64::from(packings.max(1))).map(|number| seed.wrapping_add(number)).collect();
        Clumps { seeds, made: Vec::new() }
    }

    pub fn spheres() -> Clumps {
        Clumps { seeds: Vec::new(), made: Vec::new() }
    }

    /// The templates of the packing in which they are widest. Fails where a packing has none.
    pub fn widest(&mut self, shape: Option<&ClumpShape>) -> Result<Vec<Template>, TemplatesError> {
        let Some(shape) = shape.filter(|_| !self.seeds.is_empty()) else {
            return Ok(Template::sphere(0.5).map(|sphere| vec![sphere]).unwrap_or_default());
        };
        if let Some((_, known)) = self.made.iter().find(|(known, _)| known == shape) {
            return known.clone();
        }
        let made = of_seeds(shape, &self.seeds);
        self.made.push((shape.clone(), made.clone()));
        made
    }
}

fn of_seeds(shape: &ClumpShape, seeds: &[u64]) -> Result<Vec<Template>, TemplatesError> {
    // scans are the same in every packing
    let seeds = if matches!(shape.surfaces, Surfaces::Meshes(_)) { &seeds[..1] } else { seeds };
    let made: Result<Vec<_>, _> = seeds.par_iter().map(|seed| shape.templates(*seed)).collect();
    Ok(made?.into_iter().max_by(|a, b| widest(a).total_cmp(&widest(b))).unwrap_or_default())
}
