//! L1013: at its speed a wheel loses much of its load over the level of the rail as built.
//!
//! A wheel that follows the level z, positive down, loses `m_w v^2 z''` of its static load Q over a crest (`z'' > 0`).
//! The rule assumes a stiff track. A soft track deflects above the resonance of a wheel on it, and the wheel loses
//! less. Above 0.6 Q a train is near derailing (EN 14363 for quasi-static unloading, unchecked).

use super::led;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Vehicle};
use crate::units::number;

/// Share of the static load that may be lost.
const LARGEST_SHARE: f64 = 0.6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let Some(profile) = &scenario.track.irregularity else { return Vec::new() };
    let curved = profile
        .pieces
        .iter()
        .flat_map(|piece| piece.cubics())
        .flat_map(|c| [0, 1].map(|i| (c.ends[i], c.curvatures[i])));
    let Some((x, sharpest)) = curved.max_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let train = &traffic.train;
    let lost = |v: &Vehicle| {
        let load = v.mass() / Vehicle::AXLES as f64 * *scenario.solve.gravity;
        *v.wheel_mass * *train.speed * *train.speed * sharpest / load
    };
    let Some((vehicle, share)) =
        train.vehicles.iter().map(|v| (v, lost(v))).filter(|(_, s)| s.is_finite()).max_by(|a, b| a.1.total_cmp(&b.1))
    else {
        return Vec::new();
    };
    if share <= LARGEST_SHARE {
        return Vec::new();
    }
    let slower = *train.speed * (LARGEST_SHARE / share).sqrt() * 3.6;
    let diagnostic = Diagnostic::new(
        Code::L1013,
        format!(
            "over a crest of radius {} m at x = {} m a wheel of `{}` loses about {} % of its load at {} km/h",
            number((10.0 / sharpest).round() / 10.0),
            number((x * 100.0).round() / 100.0),
            vehicle.name,
            number((share * 100.0).round()),
            number((*train.speed * 36.0).round() / 10.0)
        ),
    )
    .help(format!(
        "smooth the level, or run below {} km/h: the limit is {} %",
        number(slower.floor()),
        LARGEST_SHARE * 100.0
    ));
    vec![match profile.origin.span() {
        Some(span) => diagnostic.label(span, "this level"),
        None => diagnostic,
    }]
}
