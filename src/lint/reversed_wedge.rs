//! L1032: a stretch that stiffens the track is the wrong way round: it is stiffest at its far end and softens towards
//! the stiffer side of the transition.
//!
//! The rule compares the static stiffness at rail level, as in L1001, at both ends of the stretch and just before it. A
//! wedge increases this stiffness gradually towards the structure. A reversed wedge makes two jumps: one at its
//! beginning, and the old jump at the structure. A stretch that only softens the track models a defect and is not
//! reported.

use super::rail_stiffness;
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Stretch, Track};
use crate::units::number;

/// Stiffnesses that differ by less are equal.
const DIFFERS: f64 = 1.05;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found: Vec<(&str, Diagnostic)> = Vec::new();
    for stretch in &scenario.track.stretches {
        // a stretch at several transitions is reported once
        if !found.iter().any(|(name, _)| *name == stretch.name) {
            found.extend(reversed(stretch, &scenario.track, graph).map(|d| (stretch.name.as_str(), d)));
        }
    }
    found.into_iter().map(|(_, diagnostic)| diagnostic).collect()
}

fn reversed(stretch: &Stretch, track: &Track, graph: &Graph) -> Option<Diagnostic> {
    let middle = 0.5 * (stretch.start + stretch.end);
    let away = |i: &usize| (track.transitions[*i].x - middle).abs();
    let index = (0..track.transitions.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let transition = &track.transitions[index];
    let left = middle < transition.x;
    let (section, structure) = if left { (index, index + 1) } else { (index + 1, index) };
    let within = |seat: &usize| {
        let x = track.seats[*seat].x;
        (stretch.start..=stretch.end).contains(&x)
    };
    let seats = track.seats_of(section);
    let inside: Vec<usize> = seats.clone().filter(within).collect();
    let (first, last) = (*inside.first()?, *inside.last()?);
    let (far, near, before) = if left { (first, last, first.checked_sub(1)) } else { (last, first, Some(last + 1)) };
    let before = before.filter(|seat| seats.contains(seat))?;
    // a stretch that does not reach its transition is no wedge
    if (track.seats[near].x - transition.x).abs() > stretch.end - stretch.start {
        return None;
    }
    let mut structure = track.seats_of(structure);
    let beyond = if left { structure.next() } else { structure.next_back() }?;
    let load = rail_stiffness::load(graph);
    let stiffness = |seat: usize| rail_stiffness::as_at(graph, seat, load);
    let (far, near, before, beyond) = (stiffness(far)?, stiffness(near)?, stiffness(before)?, stiffness(beyond)?);
    let stiffens = far > DIFFERS * before && beyond > DIFFERS * before;
    if !stiffens || far < DIFFERS * near {
        return None;
    }
    let shown = |stiffness: f64| number((stiffness / 1e5).round() / 10.0);
    let name = if transition.name.is_empty() { String::new() } else { format!(" `{}`", transition.name) };
    let message = format!(
        "stretch `{}` becomes softer towards the stiffer side of transition{name}: the stiffness at rail level is {} \
         MN/m before it, \
         {} at its far end, {} at the transition, {} beyond",
        stretch.name,
        shown(before),
        shown(far),
        shown(near),
        shown(beyond)
    );
    let diagnostic = Diagnostic::new(Code::L1032, message)
        .label(stretch.span, "from its first end to its last")
        .help("reverse it: swap the two ends of `over`, or the two values of its ramp");
    Some(diagnostic)
}
