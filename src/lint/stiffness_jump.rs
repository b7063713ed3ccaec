//! L1001: the static stiffness at rail level jumps at a transition.
//!
//! Each side is a uniform track that repeats the nearest seat of its section, by the function that makes the table of
//! stiffness of a run. A ratio above 1.15 starts the mechanism of Fig. 1 of the paper.

use super::rail_stiffness;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Seat, Track};
use crate::units::number;

const LARGEST_RATIO: f64 = 1.15;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let track = &scenario.track;
    let load = rail_stiffness::load(graph);
    let stiffness_beside = |section: usize, x: f64| rail_stiffness::as_at(graph, nearest(track, section, x)?, load);
    let mut found = Vec::new();
    for (i, transition) in track.transitions.iter().enumerate() {
        let (Some(a), Some(b)) = (stiffness_beside(i, transition.x), stiffness_beside(i + 1, transition.x)) else {
            continue;
        };
        let ratio = a.max(b) / a.min(b);
        if ratio <= LARGEST_RATIO {
            continue;
        }
        let name = if transition.name.is_empty() { String::new() } else { format!(" `{}`", transition.name) };
        let mut diagnostic = Diagnostic::new(
            Code::L1001,
            format!(
                "the stiffness at rail level jumps from {} to {} MN/m at transition{name}, by a factor of {} within \
                 {} m",
                number((a / 1e5).round() / 10.0),
                number((b / 1e5).round() / 10.0),
                number((ratio * 100.0).round() / 100.0),
                number((apart(track, i, transition.x) * 100.0).round() / 100.0)
            ),
        )
        .help(format!(
            "bring both sides within a factor of {LARGEST_RATIO}: use softer pads on the stiff side or a stiffer \
             support on the soft side"
        ));
        for section in [i, i + 1] {
            let seat = track.seats[track.seats_of(section)].first();
            let stiffness = |seat: &Seat| match seat.is_ballasted() {
                true => seat.support().map(|support| support.stiffness),
                false => seat.pad.as_ref().map(|pad| pad.stiffness),
            };
            if let Some(span) = seat.and_then(stiffness).and_then(|given| given.origin.span()) {
                diagnostic = diagnostic.label(span, format!("section `{}`", track.sections[section].name));
            }
        }
        found.push(diagnostic);
    }
    found
}

/// The seat of a section that is nearest to a chainage.
fn nearest(track: &Track, section: usize, x: f64) -> Option<usize> {
    let from = |index: &usize| (track.seats[*index].x - x).abs();
    track.seats_of(section).min_by(|a, b| from(a).total_cmp(&from(b)))
}

/// Distance, m, of the two seats that are compared.
fn apart(track: &Track, left: usize, x: f64) -> f64 {
    let away =
        |section: usize| nearest(track, section, x).map_or(f64::INFINITY, |seat| (track.seats[seat].x - x).abs());
    away(left) + away(left + 1)
}
