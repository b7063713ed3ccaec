//! L1017: a car body bounces at a frequency that no vehicle has.
//!
//! On primary and secondary springs in series, `f = sqrt(2 k / m) / 2 pi` with `1/k = 1/k2 + 1/(2 k1)` of a bogie.
//! Freight wagons bounce at 1.5 .. 4 Hz, coaches at 0.7 .. 1.5 Hz. The rule finds a value per wheel that was meant per
//! wheelset, and a mass of a vehicle that was meant per bogie.

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Vehicle};
use crate::units::number;

/// Hz.
const SLOWEST: f64 = 0.5;
const FASTEST: f64 = 5.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let mut found = Vec::new();
    for vehicle in &traffic.train.vehicles {
        let (bogie, frequency) = (springs(vehicle), bounce(vehicle));
        if (SLOWEST..=FASTEST).contains(&frequency) {
            continue;
        }
        let diagnostic = Diagnostic::new(
            Code::L1017,
            format!(
                "the car body of `{}` bounces at {} Hz: {} t over one rail on {} MN/m under each end",
                vehicle.name,
                number((frequency * 100.0).round() / 100.0),
                number((*vehicle.car_body_mass / 1e2).round() / 10.0),
                number((bogie / 1e4).round() / 100.0)
            ),
        )
        .help(
            "wagons bounce at 1.5 .. 4 Hz, coaches at 0.7 .. 1.5 Hz: is each value per wheel, per wheelset or per \
             bogie?",
        );
        let diagnostic = match vehicle.secondary_stiffness.origin.span() {
            Some(span) => diagnostic.label(span, "these springs"),
            None => diagnostic,
        };
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}

/// Primary and secondary springs of a bogie in series, N/m.
fn springs(vehicle: &Vehicle) -> f64 {
    1.0 / (1.0 / *vehicle.secondary_stiffness + 0.5 / *vehicle.primary_stiffness)
}

/// Natural frequency of a car body on its springs, Hz.
pub(super) fn bounce(vehicle: &Vehicle) -> f64 {
    (2.0 * springs(vehicle) / *vehicle.car_body_mass).sqrt() / (2.0 * std::f64::consts::PI)
}
