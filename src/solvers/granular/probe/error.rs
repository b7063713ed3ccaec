//! Why a plate load test has no result.

use super::super::failure::Failure;
use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum ProbeError {
    /// A plate without a size, without a pressure, or without a surface of the bed.
    Plate,
    /// A plate and its periodic image that would touch the same grain.
    WidePlate {
        side: f64,
        period: f64,
    },
    /// No grain lies under the plate.
    Nothing,
    /// The plate has sunk deeper than the limit.
    Sunk {
        pressure: f64,
        settlement: f64,
        target: f64,
    },
    /// Forces are not in balance after the longest time of a step.
    Restless {
        pressure: f64,
        target: f64,
        unbalance: f64,
        limit: f64,
        time: f64,
    },
    /// More pressure gave no more settlement of the plate.
    NoSettlement,
    Failure(Failure),
}

impl fmt::Display for ProbeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProbeError::Plate => {
                write!(f, "a plate needs sides above 0 m, a pressure above 0 Pa and a surface of the bed")
            }
            ProbeError::WidePlate { side, period } => write!(
                f,
                "a plate of {:.0} mm and one grain beside it are wider than the cell of {:.0} mm: take a longer cell, or a plate over the whole cell",
                1e3 * side,
                1e3 * period
            ),
            ProbeError::Nothing => write!(f, "no grain lies under the plate"),
            ProbeError::Sunk { pressure, settlement, target } => write!(
                f,
                "the plate has sunk {:.0} mm into the bed at {:.0} kPa; the test goes up to {:.0} kPa",
                1e3 * settlement,
                pressure / 1e3,
                target / 1e3
            ),
            ProbeError::Restless { pressure, target, unbalance, limit, time } => write!(
                f,
                "the plate is not at rest after {time:.1} s of a load step: its pressure is {:.1} kPa, the target {:.1} kPa; forces are out of \
                 balance by {unbalance:.1e} of the acting forces, above the limit of {limit:.1e}",
                pressure / 1e3,
                target / 1e3
            ),
            ProbeError::NoSettlement => {
                write!(f, "more pressure gives no more settlement of the plate: take a greater pressure")
            }
            ProbeError::Failure(failure) => write!(f, "under the plate: {failure}"),
        }
    }
}

impl std::error::Error for ProbeError {}
