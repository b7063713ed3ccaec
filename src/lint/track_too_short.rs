//! L1003: the track is too short for its train. Wheels come so near to the ends of the model that the ends take part in the
//! answer, or a ballasted section has too few sleepers that see the whole train.
//!
//! The static deflection decays as exp(-lambda x); three characteristic lengths leave 5 %. Trains start on the track, and
//! sleepers that only some wheels pass take the mean of ten that all pass.

use super::winkler::Winkler;
use super::{Led, led};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{RailEnds, Scenario, Section};
use crate::units::number;

const LENGTHS: f64 = 3.0;
const PASSED: usize = 10;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let sections = 0..scenario.track.sections.len();
    let sparse = sections.filter_map(|section| sparsely_passed(scenario, traffic, section));
    near_ends(scenario, graph, traffic).into_iter().chain(sparse).collect()
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
            "lengthen section `{}`: {} m, three characteristic lengths of the rail, keep the end out of the answer",
            form.name,
            number((needed * 10.0).ceil() / 10.0)
        ));
        (distance < needed).then(|| at_length(diagnostic, form))
    });
    near.collect()
}

/// A ballasted section in which fewer than ten sleepers see every wheel.
fn sparsely_passed(scenario: &Scenario, traffic: Led<'_>, section: usize) -> Option<Diagnostic> {
    let track = &scenario.track;
    let ballasted = || track.seats[track.seats_of(section)].iter().filter(|s| s.is_ballasted());
    let passed = traffic.blocks.passed();
    let seen = ballasted().filter(|s| passed.contains(&s.x)).count();
    if seen >= PASSED || ballasted().next().is_none() {
        return None;
    }
    let form = &track.sections[section];
    let missing = (PASSED - seen) as f64 * *form.spacing;
    let starts = if seen == 0 && passed.start > form.end { passed.start - form.end } else { 0.0 };
    let count = ballasted().count();
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
    let wanted = number((form.end - form.start + missing + starts).ceil());
    let diagnostic =
        Diagnostic::new(Code::L1003, message).help(format!("lengthen section `{}` to about {wanted} m", form.name));
    Some(at_length(diagnostic, form))
}

/// Points at the length of a section.
fn at_length(diagnostic: Diagnostic, section: &Section) -> Diagnostic {
    match section.length_origin.span() {
        Some(span) => diagnostic.label(span, format!("section `{}`", section.name)),
        None => diagnostic,
    }
}
