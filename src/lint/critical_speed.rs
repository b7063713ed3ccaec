//! L1002: the train is nearly as fast as bending waves in the track, (4 k EI / m^2)^(1/4).

use super::led;
use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::Scenario;
use crate::units::number;

/// Above this share of the critical speed a static model of the track fails.
const LARGEST_SHARE: f64 = 0.6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let track = &scenario.track;
    let sections = (0..track.sections.len())
        .filter_map(|i| Some((i, Winkler::of_section(track, &graph.supports, i)?.critical_speed())));
    let Some((section, critical)) = sections.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let speed = traffic.train.speed;
    if *speed < LARGEST_SHARE * critical {
        return Vec::new();
    }
    let diagnostic = Diagnostic::new(
        Code::L1002,
        format!(
            "the speed of {} km/h is {} % of the critical speed of section `{}`, {} km/h",
            number((*speed * 3.6).round()),
            number((100.0 * *speed / critical).round()),
            track.sections[section].name,
            number((critical * 3.6).round())
        ),
    )
    .help("the model has no waves in the ground: near this speed its results are not on the safe side");
    vec![match speed.origin.span() {
        Some(span) => diagnostic.label(span, "near the critical speed"),
        None => diagnostic,
    }]
}
