//! Why a bed could not be packed.

use super::super::failure::Failure;
use super::super::grains::GradingError;
use super::describe::StageKind;
use std::fmt;

/// Why a bed was not packed.
#[derive(Debug, Clone, PartialEq)]
pub enum PackingError {
    /// A number of the recipe, and its valid range.
    Number {
        layer: Option<String>,
        quantity: &'static str,
        value: f64,
        expected: &'static str,
    },
    NoLayers,
    /// A grading that gives no grains.
    Grading(GradingError),
    /// Grains that are too large for the plan.
    LargeGrain {
        layer: String,
        diameter: f64,
        side: f64,
    },
    /// Grains that are too large for the thickness of the layer.
    ThinLayer {
        layer: String,
        diameter: f64,
        thickness: f64,
    },
    /// There was no room for a loose grain.
    NoRoom {
        layer: String,
    },
    /// The plate has not reached its pressure in time.
    Pressure {
        stage: StageKind,
        reached: f64,
        target: f64,
        time: f64,
    },
    /// Forces are not in balance after the longest time of a stage.
    Restless {
        stage: StageKind,
        unbalance: f64,
        limit: f64,
        time: f64,
    },
    Failure {
        stage: StageKind,
        failure: Failure,
    },
    /// The caller has stopped the packing.
    Stopped,
}

impl fmt::Display for PackingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PackingError::Number { layer, quantity, value, expected } => {
                let of = layer.as_ref().map_or(String::new(), |layer| format!(" of layer `{layer}`"));
                write!(f, "the {quantity}{of} is {value}, expected {expected}")
            }
            PackingError::NoLayers => write!(f, "there is no layer of grains to pack; give at least one"),
            PackingError::Grading(error) => error.fmt(f),
            PackingError::LargeGrain { layer, diameter, side } => write!(
                f,
                "grains of `{layer}` are up to {:.0} mm wide, more than a third of the cell side of {:.0} mm: a grain could touch its own periodic image",
                1e3 * diameter,
                1e3 * side
            ),
            PackingError::ThinLayer { layer, diameter, thickness } => write!(
                f,
                "layer `{layer}` of {:.0} mm is thinner than its largest grain of {:.0} mm: make it thicker, or remove the largest sizes from the grading",
                1e3 * thickness,
                1e3 * diameter
            ),
            PackingError::NoRoom { layer } => {
                write!(
                    f,
                    "there is no room above the bed for a grain of `{layer}`: take a longer cell, or remove the largest sizes from the grading"
                )
            }
            PackingError::Pressure { stage, reached, target, time } => write!(
                f,
                "{stage}: the pressure of the plate is {:.1} kPa after {time:.2} s, its target {:.1} kPa: write a lower \
                 `pressure`, or more `local_damping`",
                reached / 1e3,
                target / 1e3
            ),
            PackingError::Restless { stage, unbalance, limit, time } => write!(
                f,
                "{stage}: forces are out of balance by {unbalance:.1e} of the acting forces after {time:.2} s, above the limit of \
                 {limit:.1e}: write more `local_damping`, or a lower `pressure`"
            ),
            PackingError::Failure { stage, failure } => write!(f, "{stage}: {failure}"),
            PackingError::Stopped => f.write_str("packing was stopped"),
        }
    }
}

impl std::error::Error for PackingError {}

impl From<GradingError> for PackingError {
    fn from(error: GradingError) -> Self {
        PackingError::Grading(error)
    }
}
