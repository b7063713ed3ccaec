//! L1014: the rail's foot is stressed more than design rules allow.
//!
//! The bending moment of a beam on springs under one wheel is `M = Q / (4 lambda)`. Speed amplifies it; with the
//! section modulus W of the foot the stress is `M / W`. AREMA allows 25 ksi, 172 MPa, in continuously welded rail
//! (unchecked).

use super::dynamic::amplification;
use super::led;
use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Vehicle};
use crate::units::number;

/// Pa.
const LARGEST: f64 = 172e6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let (track, speed) = (&scenario.track, traffic.train.speed);
    let heaviest = traffic.train.vehicles.iter().map(Vehicle::mass).fold(0.0, f64::max);
    let wheel = heaviest / Vehicle::AXLES as f64 * *scenario.solve.gravity;
    let factor = amplification(*speed);
    let stress = |section: usize| {
        let winkler = Winkler::of_section(track, &graph.supports, section)?;
        let moment = wheel / (4.0 * winkler.lambda());
        Some((section, moment, factor * moment / track.sections[section].rail.as_ref()?.foot_modulus()))
    };
    let worst = (0..track.sections.len()).filter_map(stress).max_by(|a, b| a.2.total_cmp(&b.2));
    let Some((section, moment, stress)) = worst.filter(|(_, _, stress)| *stress > LARGEST) else { return Vec::new() };
    let section = &track.sections[section];
    let diagnostic = Diagnostic::new(
        Code::L1014,
        format!(
            "the stress in the rail foot of `{}` is about {} MPa: {} kN m under a wheel of {} kN at rest, times {} at \
             {} km/h",
            section.name,
            number((stress / 1e6).round()),
            number((moment / 1e2).round() / 10.0),
            number((wheel / 1e3).round()),
            number((factor * 100.0).round() / 100.0),
            number((*speed * 36.0).round() / 10.0)
        ),
    )
    .help(format!(
        "the usual limit is {} MPa: use a stiffer rail or support, lighter axles or a lower speed",
        LARGEST / 1e6
    ));
    vec![match section.rail.as_ref().and_then(|rail| rail.bending_stiffness.origin.span()) {
        Some(span) => diagnostic.label(span, "this rail"),
        None => diagnostic,
    }]
}
