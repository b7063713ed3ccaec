//! Packs a bed, lift by lift.

use super::super::grains::{Sample, grains};
use super::super::lanes::Real;
use super::super::listen::Answer;
use super::error::PackingError;
use super::packed::Packed;
use super::press::Press;
use super::progress::Progress;
use super::recipe::{GrainLayer, Recipe};
use std::ops::ControlFlow;

/// Builds the bed. `tell` receives the progress, and may stop the packing.
pub fn pack<R: Real, A: Answer>(
    recipe: &Recipe,
    mut tell: impl FnMut(&Progress) -> A,
) -> Result<Packed<R>, PackingError> {
    recipe.check()?;
    let mut press = Press::<R, _>::new(recipe, |progress: &Progress| tell(progress).flow());
    let mut packed = Contents::default();
    let mut top = 0.0;
    for (number, layer) in recipe.layers.iter().enumerate() {
        packed.bodies.push(press.bed.len() as u32);
        // the next layer fills what this layer lacks
        top += layer.thickness;
        let sample = fill(&mut press, recipe, number, layer, top)?;
        packed.samples.push(sample);
        packed.levels.push(press.level());
    }
    packed.bodies.push(press.bed.len() as u32);
    let densities: Vec<f64> = recipe.layers.iter().map(|layer| layer.density).collect();
    let mass: f64 = packed.samples.iter().zip(&densities).map(|(sample, density)| sample.volume * density).sum();
    press.finish(recipe, mass * recipe.gravity / (recipe.plan[0] * recipe.plan[1]))?;
    let Contents { bodies, samples, levels } = packed;
    Ok(Packed { bed: press.bed, plan: recipe.plan, densities, bodies, samples, levels, stages: press.stages })
}

#[derive(Default)]
struct Contents {
    bodies: Vec<u32>,
    samples: Vec<Sample>,
    levels: Vec<f64>,
}

/// Packs a layer lift by lift up to a level. Each lift gets the estimated volume of grains still missing up to its top;
/// the estimate is corrected by the lifts before.
fn fill<R: Real, T: FnMut(&Progress) -> ControlFlow<()>>(
    press: &mut Press<'_, R, T>,
    recipe: &Recipe,
    number: usize,
    layer: &GrainLayer,
    top: f64,
) -> Result<Sample, PackingError> {
    let area = recipe.plan[0] * recipe.plan[1];
    let base = press.level();
    let guess = |height: f64| area * height * layer.solid_share(recipe.flat(number, height));
    let mut lifts = Vec::<Sample>::new();
    let (mut taken, mut correction) = (0.0, 1.0);
    let count = layer.lifts_that_fit();
    for lift in 0..count {
        let reached = press.level() - base;
        if taken > 0.0 {
            correction = taken / guess(reached);
        }
        let height = reached + (top - base - reached) / f64::from(count - lift);
        let volume = (correction * guess(height) - taken).max(0.0);
        let sample = layer.curve.sample(volume, recipe.seed.wrapping_add((number as u64) << 32 | u64::from(lift)))?;
        taken += sample.volume;
        let copies = grains(&sample, layer.templates.len(), recipe.seed ^ (u64::from(lift) << 8));
        press.lay(recipe, number, lift, &copies)?;
        lifts.push(sample);
    }
    let sizes = lifts.iter().flat_map(|sample| sample.sizes.iter().copied()).collect();
    let volume = lifts.iter().map(|sample| sample.volume).sum();
    Ok(Sample { sizes, volume, curve: layer.curve.clone() })
}
