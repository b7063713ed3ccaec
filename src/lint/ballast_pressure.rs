//! L1015: sleepers press harder on the ballast than design rules allow.
//!
//! The seat under a wheel takes `Q lambda s / 2` of it, speed amplifies that, the track's weight comes on top, and half the
//! sleeper's bearing area carries both. 0.5 MPa are usual under concrete sleepers (UIC, unchecked).

use super::dynamic::amplification;
use super::led;
use super::winkler::seat_loads;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::Scenario;
use crate::units::number;

/// Pa.
const LARGEST: f64 = 0.5e6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let (track, speed) = (&scenario.track, traffic.train.speed);
    let factor = amplification(*speed);
    let pressed = seat_loads(scenario, graph, traffic).into_iter().filter_map(|load| {
        let seat = track.seats[track.seats_of(load.section)].iter().find(|s| s.is_ballasted())?;
        let share = load.wheel * load.winkler.seat_share(load.spacing);
        let area = track.bearing_area(seat)?;
        Some((load.section, area, (load.peak.force + (factor - 1.0) * share) / area))
    });
    let Some((section, area, pressure)) = pressed.max_by(|a, b| a.2.total_cmp(&b.2)).filter(|p| p.2 > LARGEST) else {
        return Vec::new();
    };
    let section = &track.sections[section];
    let diagnostic = Diagnostic::new(
        Code::L1015,
        format!(
            "sleepers of `{}` press with about {} kPa on the ballast: {} kN on {} m^2 a seat, {} km/h included",
            section.name,
            number((pressure / 1e3).round()),
            number((pressure * area / 1e3).round()),
            number((area * 1e3).round() / 1e3),
            number((*speed * 36.0).round() / 10.0)
        ),
    )
    .help(format!(
        "{} kPa are usual at most: larger sleepers, closer sleepers, softer pads or lighter axles",
        LARGEST / 1e3
    ));
    vec![match section.spacing.origin.span() {
        Some(span) => diagnostic.label(span, "so far apart"),
        None => diagnostic,
    }]
}
