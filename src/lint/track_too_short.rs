//! L1003: the track is too short for its train. Wheels come so near to the ends of the model that the ends take part in the
//! answer, or a ballasted section has too few sleepers that see the whole train.
//!
//! The static deflection decays as exp(-lambda x); three characteristic lengths leave 5 %. Trains start on the track, and
//! sleepers that only some wheels pass take the mean of ten that all pass.

use super::winkler::Winkler;
use super::{Led, led};
use crate::diag::{Code, Diagnostic, and_list};
use crate::graph::Graph;
use crate::scenario::{RailEnds, Scenario, Section, Track};
use crate::units::number;
use std::ops::Range;

const LENGTHS: f64 = 3.0;
const PASSED: usize = 10;
/// Seats within this distance of a transition lie beside it, m, as for the step at the structure.
const BESIDE: f64 = 5.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let sections = 0..scenario.track.sections.len();
    let mut found = near_ends(scenario, graph, traffic);
    let sparse: Vec<Diagnostic> = sections.filter_map(|section| sparsely_passed(scenario, traffic, section)).collect();
    // a section that is hardly passed says enough of its transitions
    if sparse.is_empty() {
        found.extend(scenario.track.transitions.iter().find_map(|t| partly_passed(&scenario.track, traffic, t.x)));
    }
    found.extend(sparse);
    found
}

/// A transition beside which a ballasted seat sees only some wheels of the train: its forces there are means of seats farther on.
fn partly_passed(track: &Track, traffic: Led<'_>, x: f64) -> Option<Diagnostic> {
    let passed = traffic.blocks.passed();
    let beside = [x - BESIDE, x + BESIDE].map(|end| end.clamp(track.start(), track.end()));
    let mut seats = track.seats.iter().filter(|s| s.is_ballasted() && (beside[0]..=beside[1]).contains(&s.x));
    let unseen = seats.find(|seat| !passed.contains(&seat.x))?;
    let tenths = |x: f64| number((x * 10.0).round() / 10.0);
    let message = format!(
        "train `{}` does not pass the transition at {} m whole: all its wheels run from {} m to {} m, and sleepers beyond take means",
        traffic.train.name,
        tenths(x),
        tenths(passed.start),
        tenths(passed.end)
    );
    let (side, section) = if unseen.x < passed.start { ("left", 0) } else { ("right", track.sections.len() - 1) };
    let metres = if side == "left" { passed.start - beside[0] } else { beside[1] - passed.end };
    let advice = more_track(track, side, metres.ceil());
    Some(at_length(Diagnostic::new(Code::L1003, message).help(advice), &track.sections[section]))
}

/// Ends that wheels come near; free ends have been asked for.
fn near_ends(scenario: &Scenario, graph: &Graph, traffic: Led<'_>) -> Vec<Diagnostic> {
    let track = &scenario.track;
    if track.rail_ends == RailEnds::Free {
        return Vec::new();
    }
    let last = track.sections.len().saturating_sub(1);
    let ends = [
        (0, traffic.blocks.passage.left - track.start(), "left"),
        (last, track.end() - traffic.blocks.passage.right, "right"),
    ];
    let near = ends.into_iter().filter_map(|(section, distance, side)| {
        let needed = LENGTHS / Winkler::of_section(track, &graph.supports, section)?.lambda();
        let form = &track.sections[section];
        let diagnostic = Diagnostic::new(
            Code::L1003,
            format!("wheels come within {} m of the {side} end of the track", number((distance * 10.0).round() / 10.0)),
        )
        .help(format!(
            "{}: {} m, three characteristic lengths of the rail, keep the end out of the answer",
            more_track(track, side, ((needed - distance) * 10.0).ceil() / 10.0),
            number((needed * 10.0).ceil() / 10.0)
        ));
        (distance < needed).then(|| at_length(diagnostic, form))
    });
    near.collect()
}

/// A ballasted section in which fewer than ten sleepers see every wheel.
fn sparsely_passed(scenario: &Scenario, traffic: Led<'_>, section: usize) -> Option<Diagnostic> {
    let track = &scenario.track;
    let ballasted = track.seats[track.seats_of(section)].iter().filter(|seat| seat.is_ballasted());
    let places: Vec<f64> = ballasted.map(|seat| seat.x).collect();
    let passed = traffic.blocks.passed();
    let (seen, count) = (places.iter().filter(|x| passed.contains(x)).count(), places.len());
    // those of a short bridge may be few, and need no mean where all are passed
    if seen >= PASSED.min(count) {
        return None;
    }
    let form = &track.sections[section];
    let message = match seen {
        0 => format!(
            "no sleeper of section `{}` sees every wheel of the train: they settle by the wheels that they see",
            form.name
        ),
        n => format!(
            "only {n} of the {count} sleepers of section `{}` see every wheel of the train: the others take their mean",
            form.name
        ),
    };
    Some(at_length(Diagnostic::new(Code::L1003, message).help(to_be_passed(track, section, &places, passed)), form))
}

/// Where more track lets enough sleepers of a section, at these places, be passed: ten of an outer one, all of an inner one.
fn to_be_passed(track: &Track, section: usize, places: &[f64], passed: Range<f64>) -> String {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return String::new() };
    let (spacing, outermost) = (*track.sections[section].spacing, track.sections.len() - 1);
    let spare = places.len().saturating_sub(PASSED) as f64 * spacing;
    if outermost == 0 {
        let missing = last - first - spare - (passed.end - passed.start);
        return more_track(track, "right", missing.max(spacing).ceil());
    }
    let sides = [("left", passed.start - first, section == 0), ("right", last - passed.end, section == outermost)];
    let advice = sides.into_iter().filter(|(_, unseen, _)| *unseen > 0.0).map(|(side, unseen, outer)| {
        let metres = if outer { unseen - spare } else { unseen };
        more_track(track, side, metres.max(spacing).ceil())
    });
    and_list(&advice.collect::<Vec<_>>())
}

/// Advice to let the model begin earlier or end later. The length of a structure is given: it never changes.
fn more_track(track: &Track, side: &str, metres: f64) -> String {
    let outer = if side == "left" { track.sections.first() } else { track.sections.last() };
    let section = outer.map_or("", |section| section.name.as_str());
    let longer = match outer {
        Some(Section { slab: None, .. }) => format!("a longer section `{section}`, or a section beyond it"),
        _ => format!("a section of track beyond `{section}`"),
    };
    format!("put {} m more track at the {side} end of the model, {longer}", number(metres))
}

/// Points at the length of a section.
fn at_length(diagnostic: Diagnostic, section: &Section) -> Diagnostic {
    match section.length_origin.span() {
        Some(span) => diagnostic.label(span, format!("section `{}`", section.name)),
        None => diagnostic,
    }
}
