//! L1001: the static stiffness at rail level jumps at a transition.
//!
//! Both sides as beams on Winkler foundations: K = 2 k / lambda. A ratio above 1.15 sets off the mechanism of Fig. 1 of
//! the paper.

use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Seat, Track};
use crate::units::number;

const LARGEST_RATIO: f64 = 1.15;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let track = &scenario.track;
    let mut found = Vec::new();
    for (i, transition) in track.transitions.iter().enumerate() {
        let (Some(left), Some(right)) = (
            Winkler::beside(track, &graph.supports, i, transition.x),
            Winkler::beside(track, &graph.supports, i + 1, transition.x),
        ) else {
            continue;
        };
        let (a, b) = (left.rail_stiffness(), right.rail_stiffness());
        let ratio = a.max(b) / a.min(b);
        if ratio <= LARGEST_RATIO {
            continue;
        }
        let name = if transition.name.is_empty() { String::new() } else { format!(" `{}`", transition.name) };
        let mut diagnostic = Diagnostic::new(
            Code::L1001,
            format!(
                "the stiffness at rail level jumps from {} to {} MN/m at transition{name}, by a factor of {} within {} m",
                number((a / 1e5).round() / 10.0),
                number((b / 1e5).round() / 10.0),
                number((ratio * 100.0).round() / 100.0),
                number((apart(track, i, transition.x) * 100.0).round() / 100.0)
            ),
        )
        .help(format!("bring both sides within a factor of {LARGEST_RATIO}: softer pads on the stiff side, a stiffer support before it"));
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

/// Distance, m, of the two seats that are compared: the nearest ones on either side.
fn apart(track: &Track, left: usize, x: f64) -> f64 {
    let nearest = |section: usize| {
        let seats = track.seats[track.seats_of(section)].iter();
        seats.map(|s| (s.x - x).abs()).fold(f64::INFINITY, f64::min)
    };
    nearest(left) + nearest(left + 1)
}
