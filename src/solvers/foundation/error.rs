//! Errors in a stack of layers.

use super::layers::{Bearing, Below, Layer, Method};
use std::fmt;

/// Upper limit of the spread angle of a load, rad; only stiff plates come near it.
const WIDEST: f64 = std::f64::consts::FRAC_PI_2;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FoundationError {
    /// There is no layer between the sleeper and the ground below.
    NoLayers,
    /// A value is not positive; `layer` counts from the sleeper down, from 0; `None` if the value does not belong to a
    /// layer.
    NotPositive { what: &'static str, layer: Option<usize>, value: f64 },
    /// The spread angle of the load in a layer, rad, is not from 0 to below 90 degrees.
    Spread { layer: usize, value: f64 },
    /// Poisson's ratio is not from 0 to below 0.5; `None` is the ground below.
    PoissonRatio { layer: Option<usize>, value: f64 },
    /// Sleepers overlap: a spacing, m, is below the width of the base.
    Spacing { value: f64, width: f64 },
    /// The load share of the neighbours is not from 0 to 1.
    Neighbours { value: f64 },
}

impl fmt::Display for FoundationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |layer: &Option<usize>| match layer {
            Some(layer) => format!(" of layer {}", layer + 1),
            None => String::new(),
        };
        match self {
            FoundationError::NoLayers => f.write_str("expected at least one layer with a thickness"),
            FoundationError::NotPositive { what, layer, value } => {
                write!(f, "expected a positive {what}{}, found {value}", of(layer))
            }
            FoundationError::Spread { layer, value } => write!(
                f,
                "expected a load spread angle from 0 to below 90 degrees in layer {}, found {}",
                layer + 1,
                value.to_degrees()
            ),
            FoundationError::PoissonRatio { layer, value } => {
                write!(f, "expected a Poisson's ratio{} from 0 to below 0.5, found {value}", of(layer))
            }
            FoundationError::Spacing { value, width } => {
                write!(f, "expected a sleeper spacing of at least the sleeper width, {width} m, found {value} m")
            }
            FoundationError::Neighbours { value } => {
                write!(f, "expected a load share of the neighbours from 0 to 1, found {value}")
            }
        }
    }
}

impl std::error::Error for FoundationError {}

pub(super) fn check(bearing: &Bearing, layers: &[Layer], below: Below, method: Method) -> Result<(), FoundationError> {
    for (what, value) in [("width of the bearing", bearing.width), ("length of the bearing", bearing.length)] {
        positive(what, None, value)?;
    }
    for spacing in bearing.spacings {
        if spacing.is_nan() || spacing < bearing.width {
            return Err(FoundationError::Spacing { value: spacing, width: bearing.width });
        }
    }
    if let Some(gap) = bearing.to_centre.filter(|gap| gap.is_nan() || *gap < 0.0) {
        return Err(FoundationError::NotPositive { what: "distance to the centre line", layer: None, value: gap });
    }
    for (i, layer) in layers.iter().enumerate() {
        check_layer(i, layer)?;
    }
    if layers.iter().all(|layer| layer.thickness == 0.0) {
        return Err(FoundationError::NoLayers);
    }
    match below {
        Below::Rigid => {}
        Below::Springs { modulus } => positive("modulus of subgrade reaction", None, modulus)?,
        Below::HalfSpace { youngs_modulus, poisson_ratio } => {
            positive("Young's modulus of the ground below", None, youngs_modulus)?;
            poisson(None, poisson_ratio)?;
        }
    }
    match method {
        Method::LayeredElastic { neighbours } if !(0.0..=1.0).contains(&neighbours) => {
            Err(FoundationError::Neighbours { value: neighbours })
        }
        _ => Ok(()),
    }
}

fn check_layer(i: usize, layer: &Layer) -> Result<(), FoundationError> {
    if layer.thickness != 0.0 {
        positive("thickness", Some(i), layer.thickness)?;
    }
    positive("Young's modulus", Some(i), layer.youngs_modulus)?;
    positive("density", Some(i), layer.density)?;
    poisson(Some(i), layer.poisson_ratio)?;
    if !(0.0..WIDEST).contains(&layer.spread) {
        return Err(FoundationError::Spread { layer: i, value: layer.spread });
    }
    Ok(())
}

fn positive(what: &'static str, layer: Option<usize>, value: f64) -> Result<(), FoundationError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(FoundationError::NotPositive { what, layer, value }) }
}

fn poisson(layer: Option<usize>, value: f64) -> Result<(), FoundationError> {
    if (0.0..0.5).contains(&value) { Ok(()) } else { Err(FoundationError::PoissonRatio { layer, value }) }
}
