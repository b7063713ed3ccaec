//! Why there is no bed.

use super::super::failure::Failure;
use super::super::grains::GradingError;
use super::describe::StageKind;
use std::fmt;

/// Why a bed was not packed.
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
        stage: StageKind,
        reached: f64,
        target: f64,
        time: f64,
    },
    /// Forces are not in balance after the time that a stage may take.
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
    /// Who listens has ended it.
    Stopped,
}

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
                "grains of `{layer}` are up to {:.0} mm wide, more than a third of the cell's {:.0} mm: they would meet themselves",
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
