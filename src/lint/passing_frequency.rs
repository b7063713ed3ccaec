//! L1007: sleepers pass at a rate near a bounce or pitch resonance of the bogies.
//!
//! f = v / s against sqrt(2 k1 / m_b) / 2 pi (bounce) and sqrt(2 k1 (w/2)^2 / J_b) / 2 pi (pitch).

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Track};
use crate::units::number;

/// Frequencies closer than this share are near.
const NEAR: f64 = 0.1;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let speed = traffic.train.speed;
    let mut found = Vec::new();
    for (i, section) in scenario.track.sections.iter().enumerate() {
        let spacing = usual_bay(&scenario.track, i);
        // sleepers as far apart have been heard before
        if (0..i).any(|s| usual_bay(&scenario.track, s) == spacing) {
            continue;
        }
        let passing = *speed / spacing;
        for vehicle in &traffic.train.vehicles {
            let stiffness = 2.0 * *vehicle.primary_stiffness;
            let half = *vehicle.wheelset_spacing / 2.0;
            let bounce = (stiffness / *vehicle.bogie_mass).sqrt() / (2.0 * std::f64::consts::PI);
            let pitch = (stiffness * half * half / *vehicle.bogie_pitch_inertia).sqrt() / (2.0 * std::f64::consts::PI);
            for (name, frequency) in [("bounce", bounce), ("pitch", pitch)] {
                if (passing / frequency - 1.0).abs() > NEAR {
                    continue;
                }
                let diagnostic = Diagnostic::new(
                    Code::L1007,
                    format!(
                        "sleepers of `{}` pass at {} Hz, near the bogie {name} of `{}` at {} Hz",
                        section.name,
                        number(passing.round()),
                        vehicle.name,
                        number(frequency.round())
                    ),
                )
                .help(format!(
                    "below {} km/h and above {} km/h they are apart",
                    number((frequency * (1.0 - NEAR) * spacing * 3.6).floor()),
                    number((frequency * (1.0 + NEAR) * spacing * 3.6).ceil())
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
    }
    found
}

/// The median distance of the seats of a section, m.
fn usual_bay(track: &Track, section: usize) -> f64 {
    let seats = track.seats_of(section);
    let mut bays: Vec<f64> = seats.map(|seat| track.bay(seat)).collect();
    bays.sort_by(f64::total_cmp);
    bays.get(bays.len() / 2).copied().unwrap_or(*track.sections[section].spacing)
}
