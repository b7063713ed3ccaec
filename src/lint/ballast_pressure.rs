//! L1015: sleepers press harder on the ballast than design rules allow.
//!
//! The seat under a wheel load Q carries `Q lambda s / 2`. Speed amplifies this load, and the weight of the track is
//! added. Half of the sleeper's bearing area carries the sum. The usual limit under concrete sleepers is 0.5 MPa (UIC,
//! unchecked).

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
            "sleepers of `{}` press on the ballast with about {} kPa: {} kN on {} m^2 per seat at {} km/h",
            section.name,
            number((pressure / 1e3).round()),
            number((pressure * area / 1e3).round()),
            number((area * 1e3).round() / 1e3),
            number((*speed * 36.0).round() / 10.0)
        ),
    )
    .help(format!(
        "the usual limit is {} kPa: use larger sleepers, a closer spacing, softer pads or lighter axles",
        LARGEST / 1e3
    ));
    vec![match section.spacing.origin.span() {
        Some(span) => diagnostic.label(span, "spacing of the sleepers"),
        None => diagnostic,
    }]
}
