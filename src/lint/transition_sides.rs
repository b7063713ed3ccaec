//! L1033: the declared stiffer side of a transition is the softer side.
//!
//! The sides are declared, so that a study that changes a stiffness renumbers nothing. The rule compares them with the
//! median stiffness under the pads of both sections. Pads are left out, because soft pads lie on structures to reduce
//! their stiffness.

use crate::diag::{Code, Diagnostic, and_list};
use crate::graph::{Graph, SupportNode};
use crate::scenario::{Foot, Scenario, Side, Track, point_stiffness, seat_stiffness};

/// Sections whose stiffnesses differ by less have no stiffer side.
const ALIKE: f64 = 1.05;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let track = &scenario.track;
    let sections = 0..track.sections.len();
    let stiffness: Vec<Option<f64>> = sections.map(|section| under_pads(track, &graph.supports, section)).collect();
    // if the stiffnesses do not decide, the declared side stays
    let computed = |i: usize| match (stiffness[i], stiffness[i + 1]) {
        (Some(before), Some(behind)) if behind > ALIKE * before => Side::SoftToStiff,
        (Some(before), Some(behind)) if before > ALIKE * behind => Side::StiffToSoft,
        _ => track.transitions[i].side,
    };
    let sides: Vec<Side> = (0..track.transitions.len()).map(computed).collect();
    let swapped: Vec<usize> = (0..sides.len()).filter(|i| sides[*i] != track.transitions[*i].side).collect();
    let Some(first) = swapped.first() else { return Vec::new() };
    let mut diagnostic = Diagnostic::new(Code::L1033, message(track, &swapped)).help(format!(
        "write `{}`: sleepers -1, -2, ... then lie on the softer side; places counted from there change sides",
        line(track, &sides)
    ));
    for section in [*first, first + 1] {
        let at = &track.sections[section];
        if let (Some(span), Some(stiffness)) = (at.length_origin.span(), stiffness[section]) {
            diagnostic = diagnostic.label(span, format!("`{}`: {}", at.name, seat_stiffness(stiffness)));
        }
    }
    vec![diagnostic]
}

/// The message that names the transitions with a wrong side.
fn message(track: &Track, swapped: &[usize]) -> String {
    let named = |i: &usize| format!("`{}`", track.transitions[*i].name);
    match swapped {
        [one] if track.transitions[*one].name.is_empty() => {
            "a transition without a word counts as `soft_to_stiff`, but the support under the pads is stiffer before \
             it than behind it"
                .into()
        }
        [one] => {
            let side = track.transitions[*one].side;
            let behind = if side == Side::SoftToStiff { "softer" } else { "stiffer" };
            let side = side.word();
            format!(
                "transition {} is declared `{side}`, but the support under the pads is {behind} behind it",
                named(one)
            )
        }
        several => {
            let names: Vec<String> = several.iter().map(named).collect();
            format!(
                "transitions {} are declared the wrong way round, compared with the stiffness under the pads",
                and_list(&names)
            )
        }
    }
}

/// The line that declares these sides; a transition without a name gets one.
fn line(track: &Track, sides: &[Side]) -> String {
    let pairs = track.transitions.iter().zip(sides).map(|(transition, side)| {
        let name = if transition.name.is_empty() { "edge" } else { &transition.name };
        format!("{name}: {}", side.word())
    });
    format!("transitions = [{}]", pairs.collect::<Vec<_>>().join(", "))
}

/// Median stiffness under the pads of the seats of a section, N/m: the support under sleepers, or a slab as a beam
/// under one seat.
fn under_pads(track: &Track, supports: &[SupportNode], section: usize) -> Option<f64> {
    let of_seat = |seat: usize| match (&track.seats[seat].foot, &track.sections[section].slab) {
        (Foot::Rigid, _) => Some(f64::INFINITY),
        (Foot::Slab, Some(slab)) => Some(point_stiffness(*slab.foundation_stiffness, *slab.bending_stiffness)),
        (Foot::Slab, None) => None,
        (Foot::Sleeper { .. }, _) => Some(supports.get(seat)?.support?.stiffness),
    };
    median(track.seats_of(section).map(of_seat).collect::<Option<_>>()?)
}

/// The median; `None` without values.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
