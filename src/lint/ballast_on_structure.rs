//! L1034: ballast lies on both sides of a transition, and the law depends on forces alone.
//!
//! On the stiffer side a sleeper carries more of the wheel load, so a law of force gives it more settlement. In the
//! field the softer side settles more, because its subgrade settles (section 1 of the paper). The step then has the
//! wrong sign.

use super::transition_sides::median;
use super::winkler::Winkler;
use super::{laws, led, pointed};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, SettlementLaw};

/// Least ratio of the stiffness on a structure to the stiffness before it.
const STIFFER: f64 = 1.15;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    if led(scenario, graph).is_none() || graph.laws().next().is_none() {
        return Vec::new();
    }
    let Some((softer, structure)) = structure(scenario, graph) else { return Vec::new() };
    let of_law = |law: &SettlementLaw| {
        let message = format!(
            "law `{}` depends on forces alone and ignores the subgrade: sleepers on the stiffer section `{structure}` \
             settle more than on `{softer}`",
            law.name
        );
        let diagnostic = Diagnostic::new(Code::L1034, message).help(
            "give the settlement of the subgrade as `settlement` of the softer trackform, or choose a law of \
             deflection such \
             as `laws.guerin_1996`; otherwise the step at the structure is the part of the ballast alone",
        );
        pointed(diagnostic, scenario, law, "this law")
    };
    laws(scenario).filter(|law| law.law.knows_forces_alone()).map(of_law).collect()
}

/// The first transition with ballast on both sides and a stiffer side: names of the softer and of the stiffer section.
/// A settlement that the scene states for the softer side is the settlement of its subgrade.
fn structure<'a>(scenario: &'a Scenario, graph: &Graph) -> Option<(&'a str, &'a str)> {
    let track = &scenario.track;
    let ballasted = |section: usize| track.seats[track.seats_of(section)].iter().all(|seat| seat.is_ballasted());
    let settled =
        |section: usize| track.seats[track.seats_of(section)].iter().any(|seat| *seat.initial_settlement > 0.0);
    (0..track.transitions.len()).find_map(|i| {
        let (before, behind) = (of_section(scenario, graph, i)?, of_section(scenario, graph, i + 1)?);
        let (soft, stiff) = if behind > before { (i, i + 1) } else { (i + 1, i) };
        let ratio = before.max(behind) / before.min(behind);
        let found = ratio > STIFFER && ballasted(soft) && ballasted(stiff) && !settled(soft);
        found.then(|| (track.sections[soft].name.as_str(), track.sections[stiff].name.as_str()))
    })
}

/// Median stiffness at rail level of the seats of a section, N/m: sleepers of the stiffer section carry more.
fn of_section(scenario: &Scenario, graph: &Graph, section: usize) -> Option<f64> {
    let track = &scenario.track;
    let at_seat = |seat| Some(Winkler::at_seat(track, &graph.supports, seat)?.rail_stiffness());
    median(track.seats_of(section).map(at_seat).collect::<Option<_>>()?)
}
