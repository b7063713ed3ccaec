//! Why there is no bed.

use super::super::failure::Failure;
use super::super::grains::GradingError;
use super::{Layer, Recipe};
use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum PackingError {
    /// A number of the recipe, and what it should be.
    Number {
        layer: Option<String>,
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    },
    NoLayers,
    /// A grading that gives no grains.
    Grading(GradingError),
    /// Grains that the plan is too small for.
    LargeGrain {
        layer: String,
        diameter: f64,
        side: f64,
    },
    /// Grains that a layer is too thin for.
    ThinLayer {
        layer: String,
        diameter: f64,
        thickness: f64,
    },
    /// Loose grains found no place.
    NoRoom {
        layer: String,
    },
    /// The plate has not reached its pressure in time.
    Pressure {
        stage: String,
        reached: f64,
        target: f64,
        time: f64,
    },
    /// Forces are not in balance after the time that a stage may take.
    Restless {
        stage: String,
        unbalance: f64,
        limit: f64,
        time: f64,
    },
    Failure {
        stage: String,
        failure: Failure,
    },
}

/// Greatest part of the shorter side of the plan that a grain may take: a third, or it would meet itself.
const GRAIN: f64 = 1.0 / 3.0;

impl fmt::Display for PackingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PackingError::Number { layer, quantity, value, expected } => {
                let of = layer.as_ref().map_or(String::new(), |layer| format!(" of layer `{layer}`"));
                write!(f, "the {quantity}{of} is {value}, expected {expected}")
            }
            PackingError::NoLayers => write!(f, "there is no layer of grains to pack"),
            PackingError::Grading(error) => error.fmt(f),
            PackingError::LargeGrain { layer, diameter, side } => write!(
                f,
                "grains of `{layer}` are up to {:.0} mm wide, more than a third of the cell's {:.0} mm: take a longer cell, or cut \
                 the grading above",
                1e3 * diameter,
                1e3 * side
            ),
            PackingError::ThinLayer { layer, diameter, thickness } => write!(
                f,
                "layer `{layer}` of {:.0} mm is thinner than its largest grain of {:.0} mm: make it thicker, or cut the grading above",
                1e3 * thickness,
                1e3 * diameter
            ),
            PackingError::NoRoom { layer } => {
                write!(
                    f,
                    "a grain of `{layer}` finds no place above the bed: take a longer cell, or cut the grading above"
                )
            }
            PackingError::Pressure { stage, reached, target, time } => write!(
                f,
                "{stage}: the plate stands at {:.1} kPa after {time:.2} s and should press with {:.1} kPa: ask for a pressure that the \
                 grains can bear, or damp the packing more",
                reached / 1e3,
                target / 1e3
            ),
            PackingError::Restless { stage, unbalance, limit, time } => write!(
                f,
                "{stage}: after {time:.2} s forces are out of balance by {unbalance:.1e} of those that act, more than {limit:.1e}: damp \
                 the packing more, or ask for less"
            ),
            PackingError::Failure { stage, failure } => write!(f, "{stage}: {failure}"),
        }
    }
}

impl std::error::Error for PackingError {}

impl From<GradingError> for PackingError {
    fn from(error: GradingError) -> Self {
        PackingError::Grading(error)
    }
}

/// The first thing that no bed can be made of.
pub(super) fn check(recipe: &Recipe) -> Result<(), PackingError> {
    let number = |quantity, value: f64, fine: bool, expected| match value.is_finite() && fine {
        true => Ok(()),
        false => Err(PackingError::Number { layer: None, quantity, value, expected }),
    };
    if recipe.layers.is_empty() {
        return Err(PackingError::NoLayers);
    }
    for side in recipe.plan {
        number("side of the cell", side, side > 0.0, "above 0 m")?;
    }
    number("gravity", recipe.gravity, recipe.gravity > 0.0, "above 0 m/s2")?;
    number("local damping", recipe.local_damping, (0.0..1.0).contains(&recipe.local_damping), "from 0 to below 1")?;
    for (quantity, value) in [
        ("force out of balance of a lift", recipe.rest.lift),
        ("force out of balance of the bed", recipe.rest.bed),
        ("share by which the pressure may be missed", recipe.rest.pressure),
        ("longest time of a stage", recipe.rest.longest),
    ] {
        number(quantity, value, value > 0.0, "above 0")?;
    }
    recipe.layers.iter().try_for_each(|layer| check_layer(recipe, layer))
}

fn check_layer(recipe: &Recipe, layer: &Layer) -> Result<(), PackingError> {
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
    // a clump is longer than its size
    let widest = layer.templates.iter().map(|t| 2.0 * t.bounding_radius()).fold(0.0, f64::max);
    let (diameter, shortest) = (layer.curve.ends()[1] * widest, recipe.plan[0].min(recipe.plan[1]));
    if diameter > GRAIN * shortest {
        return Err(PackingError::LargeGrain { layer: layer.name.clone(), diameter, side: shortest });
    }
    if layer.curve.ends()[1] > layer.thickness {
        let diameter = layer.curve.ends()[1];
        return Err(PackingError::ThinLayer { layer: layer.name.clone(), diameter, thickness: layer.thickness });
    }
    Ok(())
}
