//! Refuses invalid recipes.

use super::super::clump::Template;
use super::error::PackingError;
use super::recipe::{GrainLayer, Recipe};

/// Largest grain as a share of the shorter side of the plan: above a third, a grain could touch its own image.
pub const GRAIN: f64 = 1.0 / 3.0;

/// Width of the widest of some templates of unit size: a clump is longer than its sieve size.
pub fn widest(templates: &[Template]) -> f64 {
    templates.iter().map(|template| 2.0 * template.bounding_radius()).fold(0.0, f64::max)
}

impl GrainLayer {
    /// Largest width of its grains, m.
    pub fn widest(&self) -> f64 {
        self.curve.ends()[1] * widest(&self.templates)
    }
}

impl Recipe {
    /// Fails with the first invalid value, before anything is packed.
    pub fn check(&self) -> Result<(), PackingError> {
        let number = |quantity, value: f64, fine: bool, expected| match value.is_finite() && fine {
            true => Ok(()),
            false => Err(PackingError::Number { layer: None, quantity, value, expected }),
        };
        if self.layers.is_empty() {
            return Err(PackingError::NoLayers);
        }
        for side in self.plan {
            number("side of the cell", side, side > 0.0, "above 0 m")?;
        }
        number("gravity", self.gravity, self.gravity > 0.0, "above 0 m/s2")?;
        number("local damping", self.local_damping, (0.0..1.0).contains(&self.local_damping), "from 0 to below 1")?;
        for (quantity, value) in [
            ("limit of the force out of balance of a lift", self.rest.lift),
            ("limit of the force out of balance of the bed", self.rest.bed),
            ("tolerance of the pressure", self.rest.pressure),
            ("longest time of a stage", self.rest.longest),
        ] {
            number(quantity, value, value > 0.0, "above 0")?;
        }
        self.layers.iter().try_for_each(|layer| check_layer(self, layer))
    }
}

fn check_layer(recipe: &Recipe, layer: &GrainLayer) -> Result<(), PackingError> {
    let number = |quantity, value: f64, fine: bool, expected| match value.is_finite() && fine {
        true => Ok(()),
        false => Err(PackingError::Number { layer: Some(layer.name.clone()), quantity, value, expected }),
    };
    number("density", layer.density, layer.density > 0.0, "above 0 kg/m3")?;
    number("thickness", layer.thickness, layer.thickness > 0.0, "above 0 m")?;
    number("number of lifts", f64::from(layer.lifts), layer.lifts > 0, "1 or more")?;
    number("number of templates", layer.templates.len() as f64, !layer.templates.is_empty(), "1 or more")?;
    number("pressure", layer.pressure, layer.pressure > 0.0, "above 0 Pa")?;
    let damping = layer.packing.local_damping;
    number("local damping while packed", damping, (0.0..1.0).contains(&damping), "from 0 to below 1")?;
    for law in [layer.surface.meet(&layer.surface)] {
        if let Some(fault) = law.faults().first() {
            number(fault.quantity, fault.value, false, fault.expected)?;
        }
    }
    let (diameter, shortest) = (layer.widest(), recipe.plan[0].min(recipe.plan[1]));
    if diameter > GRAIN * shortest {
        return Err(PackingError::LargeGrain { layer: layer.name.clone(), diameter, side: shortest });
    }
    if layer.curve.ends()[1] > layer.thickness {
        let diameter = layer.curve.ends()[1];
        return Err(PackingError::ThinLayer { layer: layer.name.clone(), diameter, thickness: layer.thickness });
    }
    Ok(())
}
