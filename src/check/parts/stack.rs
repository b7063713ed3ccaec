//! The ground under one seat: the layers at its place, and the sleeper on them.

use crate::diag::Span;
use crate::scenario::{self, ApproachSlab, Given, Material, SleeperBody, Stack};
use crate::solvers::foundation::Layer;

/// The ground of some seats; each seat takes the layers at its place.
pub struct Ground<'a> {
    pub body: SleeperBody,
    pub layers: &'a [scenario::Layer],
    pub plate: Option<ApproachSlab>,
    /// The layers that belong to a stated support, if a stretch has replaced them.
    pub before: Option<&'a [scenario::Layer]>,
    pub damping_time: Given,
    /// The place of the layers in the text.
    pub span: Span,
}

impl Ground<'_> {
    /// The ground under a sleeper at a chainage, m, with the distances to its left and right neighbours, m; `None` if a
    /// modulus is not known.
    pub fn at_seat(&self, x: f64, spacings: [f64; 2]) -> Option<Stack> {
        Some(Stack {
            bearing: self.body.bearing(spacings),
            layers: continua(self.layers, x)?,
            plate: self.plate.map(|plate| (plate, plate.lever(x))),
            before: self.before.and_then(|layers| continua(layers, x)),
            damping_time: self.damping_time,
            span: self.span,
        })
    }
}

/// Layers at a chainage as continua; `None` if a modulus is not known.
fn continua(layers: &[scenario::Layer], x: f64) -> Option<Vec<Layer>> {
    let continuum = |layer: &scenario::Layer| {
        let (poisson_ratio, density, spread) = match &layer.material {
            Material::Granular(granular) => (granular.poisson_ratio, granular.density, granular.spread),
            Material::Soil(soil) => (soil.poisson_ratio, soil.density, soil.spread),
        };
        Some(Layer {
            thickness: layer.thickness.value_at(x).max(0.0),
            youngs_modulus: layer.youngs_modulus()?.value_at(x),
            poisson_ratio: *poisson_ratio,
            density: *density,
            spread: *spread,
        })
    };
    layers.iter().map(continuum).collect()
}
