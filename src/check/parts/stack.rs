//! What lies under one seat: its layers at its place, and how its sleeper lies on them.

use crate::diag::Span;
use crate::scenario::{self, ApproachSlab, Given, Material, SleeperBody, Stack};
use crate::solvers::foundation::Layer;

/// The ground of some seats, of which each takes what lies at its place.
pub struct Ground<'a> {
    pub body: SleeperBody,
    pub layers: &'a [scenario::Layer],
    pub plate: Option<ApproachSlab>,
    /// The layers with which a stated support goes, where a stretch has replaced them.
    pub before: Option<&'a [scenario::Layer]>,
    pub damping_time: Given,
    /// Where the layers are given.
    pub span: Span,
}

impl Ground<'_> {
    /// What lies under a sleeper at a chainage, m, its neighbours so far away on the left and on the right, m; `None` where a
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

/// Layers at a chainage as continua; `None` where a modulus is not known.
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
