//! L1003: the track is too short for its train. Wheels come so near to the ends of the model that the ends affect the
//! result, or a ballasted section has too few sleepers that every wheel passes.
//!
//! The static deflection decays as exp(-lambda x); after three characteristic lengths 5 % is left. Trains start on the
//! track. Sleepers that only some wheels pass take the mean of ten sleepers that every wheel passes.

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
    // a section with too few passed sleepers is reported without its transitions
    if sparse.is_empty() {
        found.extend(scenario.track.transitions.iter().find_map(|t| partly_passed(&scenario.track, traffic, t.x)));
    }
    found.extend(sparse);
    found
}

/// A transition with a ballasted seat beside it that only some wheels of the train pass: its forces are means of other
/// seats.
fn partly_passed(track: &Track, traffic: Led<'_>, x: f64) -> Option<Diagnostic> {
    let passed = traffic.blocks.passed();
    let beside = [x - BESIDE, x + BESIDE].map(|end| end.clamp(track.start(), track.end()));
    let mut seats = track.seats.iter().filter(|s| s.is_ballasted() && (beside[0]..=beside[1]).contains(&s.x));
    let unseen = seats.find(|seat| !passed.contains(&seat.x))?;
    let tenths = |x: f64| number((x * 10.0).round() / 10.0);
    let message = format!(
        "not every wheel of train `{}` passes the transition at {} m: all pass from {} m to {} m only; other sleepers \
         take mean forces",
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

/// Ends that wheels come near; free ends are not reported, because the scene asks for them.
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
            "{}; results within {} m of an end (three characteristic lengths of the rail) depend on the end",
            more_track(track, side, ((needed - distance) * 10.0).ceil() / 10.0),
            number((needed * 10.0).ceil() / 10.0)
        ));
        (distance < needed).then(|| at_length(diagnostic, form))
    });
    near.collect()
}

/// A ballasted section with fewer than ten sleepers that every wheel passes.
fn sparsely_passed(scenario: &Scenario, traffic: Led<'_>, section: usize) -> Option<Diagnostic> {
    let track = &scenario.track;
    let ballasted = track.seats[track.seats_of(section)].iter().filter(|seat| seat.is_ballasted());
    let places: Vec<f64> = ballasted.map(|seat| seat.x).collect();
    let passed = traffic.blocks.passed();
    let (seen, count) = (places.iter().filter(|x| passed.contains(x)).count(), places.len());
    // a short bridge may have few sleepers; it needs no mean if every wheel passes all of them
    if seen >= PASSED.min(count) {
        return None;
    }
    let form = &track.sections[section];
    let message = match seen {
        0 => format!(
            "no sleeper of section `{}` is passed by every wheel of the train: the settlement there is too small",
            form.name
        ),
        n => format!(
            "every wheel of the train passes only {n} of the {count} sleepers of section `{}`: the others take their \
             mean",
            form.name
        ),
    };
    Some(at_length(Diagnostic::new(Code::L1003, message).help(to_be_passed(track, section, &places, passed)), form))
}

/// The track to add, so that every wheel passes enough sleepers of a section at these places: ten of an outer section,
/// all of an inner section.
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

/// Advice to add track at an end of the model. It never changes the length of a structure.
fn more_track(track: &Track, side: &str, metres: f64) -> String {
    let outer = if side == "left" { track.sections.first() } else { track.sections.last() };
    let section = outer.map_or("", |section| section.name.as_str());
    let longer = match outer {
        Some(Section { slab: None, .. }) => format!("make section `{section}` longer, or add a section beyond it"),
        _ => format!("add a section of track beyond `{section}`"),
    };
    format!("add {} m of track at the {side} end of the model: {longer}", number(metres))
}

/// Points at the length of a section.
fn at_length(diagnostic: Diagnostic, section: &Section) -> Diagnostic {
    match section.length_origin.span() {
        Some(span) => diagnostic.label(span, format!("section `{}`", section.name)),
        None => diagnostic,
    }
}
