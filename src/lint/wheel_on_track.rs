//! L1012: sleepers pass at a rate near the resonance of a wheel on the track.
//!
//! Wheel and track in phase on the track's stiffness, `f = sqrt(K / (m_w + 3 m / (2 lambda))) / 2 pi`: K is that of a beam on
//! springs at rail level, and `3 m / (2 lambda)` the mass of the bowl `exp(-lambda x) (cos lambda x + sin lambda x)` that moves
//! with the wheel, of rail and sleepers m a metre.

use super::led;
use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Vehicle};
use crate::units::number;

/// Frequencies closer than this share are near.
const NEAR: f64 = 0.1;

/// Natural frequency of a wheel and the track in phase, Hz.
pub(super) fn resonance(track: &Winkler, vehicle: &Vehicle) -> f64 {
    let mass = *vehicle.wheel_mass + 1.5 * track.mass / track.lambda();
    (track.rail_stiffness() / mass).sqrt() / (2.0 * std::f64::consts::PI)
}

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let (track, speed) = (&scenario.track, traffic.train.speed);
    let mut found = Vec::new();
    for (i, section) in track.sections.iter().enumerate() {
        let Some(winkler) = Winkler::of_section(track, &graph.supports, i) else { continue };
        let passing = *speed / *section.spacing;
        for vehicle in &traffic.train.vehicles {
            let frequency = resonance(&winkler, vehicle);
            if (passing / frequency - 1.0).abs() > NEAR {
                continue;
            }
            let bound = |share: f64| number((frequency * share * *section.spacing * 3.6).round());
            let diagnostic = Diagnostic::new(
                Code::L1012,
                format!(
                    "sleepers of `{}` pass at {} Hz, near the resonance of a wheel of `{}` on the track at {} Hz",
                    section.name,
                    number(passing.round()),
                    vehicle.name,
                    number(frequency.round())
                ),
            )
            .help(format!(
                "below {} km/h and above {} km/h they are apart",
                bound(1.0 - NEAR),
                bound(1.0 + NEAR)
            ));
            let diagnostic = match speed.origin.span() {
                Some(span) => diagnostic.label(span, "this speed"),
                None => diagnostic,
            };
            if !found.contains(&diagnostic) {
                found.push(diagnostic);
            }
        }
    }
    found
}
