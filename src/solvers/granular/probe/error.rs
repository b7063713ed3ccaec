//! Why a plate load test gave nothing.

use super::super::failure::Failure;
use std::fmt;

#[derive(Debug, Clone, PartialEq)]
pub enum ProbeError {
    /// A plate without a size, a pressure or a surface of the bed.
    Plate,
    /// A plate whose image would touch the grains that it touches itself.
    WidePlate {
        side: f64,
        period: f64,
    },
    /// No grain lies under the plate.
    Nothing,
    /// The plate has gone deeper than it may.
    Sunk {
        pressure: f64,
        settlement: f64,
        target: f64,
    },
    /// Forces are not in balance after the time that a step may take.
    Restless {
        pressure: f64,
        target: f64,
        unbalance: f64,
        limit: f64,
        time: f64,
    },
    /// More pressure has not brought it down.
    NoSettlement,
    Failure(Failure),
}

impl fmt::Display for ProbeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProbeError::Plate => write!(f, "a plate needs sides and a pressure above 0, and a surface of the bed"),
            ProbeError::WidePlate { side, period } => write!(
                f,
                "a plate of {:.0} mm and a grain beside it do not fit the cell of {:.0} mm: take a longer cell, or a plate over all of it",
                1e3 * side,
                1e3 * period
            ),
            ProbeError::Nothing => write!(f, "no grain lies under the plate"),
            ProbeError::Sunk { pressure, settlement, target } => write!(
                f,
                "the plate sinks in: {:.0} mm at {:.0} kPa of {:.0} kPa",
                1e3 * settlement,
                pressure / 1e3,
                target / 1e3
            ),
            ProbeError::Restless { pressure, target, unbalance, limit, time } => write!(
                f,
                "the plate is not at rest after {time:.1} s of a step: it presses with {:.1} kPa on the way to {:.1} kPa, and forces are out of \
                 balance by {unbalance:.1e} of those that act, where {limit:.1e} is allowed",
                pressure / 1e3,
                target / 1e3
            ),
            ProbeError::NoSettlement => {
                write!(f, "more pressure does not bring the plate down: ask with a greater pressure")
            }
            ProbeError::Failure(failure) => write!(f, "under the plate: {failure}"),
        }
    }
}

impl std::error::Error for ProbeError {}
