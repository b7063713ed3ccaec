//! L1027: a wagon runs faster than real wagons.
//!
//! Axle load: vehicles with more than 22.5 t per axle run at 120 km/h at most (traffic codes of the TSI Infrastructure,
//! unchecked). Suspension: a car body that bounces at 1.5 Hz or more stands on the springs of a wagon. Real wagons run
//! at 120 km/h; the fastest in a paper that this program models runs at 200 km/h (Ahmadi et al. 2026).

use super::car_body_frequency::bounce;
use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Vehicle};
use crate::units::number;

/// kg; two per cent for rounding.
const HEAVY: f64 = 1.02 * 22.5e3;
/// Hz.
const WAGONS: f64 = 1.5;
/// m/s.
const FASTEST_HEAVY: f64 = 120.0 / 3.6;
const FASTEST_WAGON: f64 = 200.0 / 3.6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let speed = traffic.train.speed;
    let mut found: Vec<Diagnostic> = Vec::new();
    for vehicle in &traffic.train.vehicles {
        let Some((fastest, why)) = limit(vehicle).filter(|(fastest, _)| *speed > *fastest * (1.0 + 1e-9)) else {
            continue;
        };
        let shown = |speed: f64| number((speed * 36.0).round() / 10.0);
        let message = format!("`{}` runs at {} km/h: {why}", vehicle.name, shown(*speed));
        let diagnostic = Diagnostic::new(Code::L1027, message).help(format!(
            "write a `speed` of {} km/h or less, or a vehicle that is built for this speed",
            shown(fastest)
        ));
        let diagnostic = match speed.origin.span() {
            Some(span) => diagnostic.label(span, "this speed"),
            None => diagnostic,
        };
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}

/// The largest speed of vehicles of its kind, m/s, and the property that shows its kind.
fn limit(vehicle: &Vehicle) -> Option<(f64, String)> {
    // a wheel of the model carries half an axle load
    let axle = 2.0 * vehicle.mass() / Vehicle::AXLES as f64;
    let frequency = bounce(vehicle);
    if axle > HEAVY {
        let tonnes = number((axle / 100.0).round() / 10.0);
        Some((FASTEST_HEAVY, format!("vehicles with {tonnes} t per axle run at 120 km/h at most")))
    } else if frequency >= WAGONS {
        let hertz = number((frequency * 10.0).round() / 10.0);
        Some((FASTEST_WAGON, format!("its car body bounces at {hertz} Hz, as on the springs of a freight wagon")))
    } else {
        None
    }
}
