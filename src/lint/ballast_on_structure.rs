//! L1034: ballast lies on both sides of a transition, and the law knows forces alone.
//!
//! Where the track is stiffer, a sleeper takes more of the wheel and a law of force settles it more; in the field the softer side
//! settles more, since its subgrade does (section 1 of the paper). The step then has the wrong sign.

use super::transition_sides::median;
use super::winkler::Winkler;
use super::{laws, led, pointed};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, SettlementLaw};

/// A structure is stiffer than the track before it by so much.
const STIFFER: f64 = 1.15;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    if led(scenario, graph).is_none() || graph.laws().next().is_none() {
        return Vec::new();
    }
    let Some((softer, structure)) = structure(scenario, graph) else { return Vec::new() };
    let of_law = |law: &SettlementLaw| {
        let message = format!(
            "law `{}` counts forces on the ballast and knows no subgrade: on `{structure}`, which is stiffer, sleepers carry more and settle more than on `{softer}`",
            law.name
        );
        let diagnostic = Diagnostic::new(Code::L1034, message).help(
            "give what the subgrade settles as `settlement` of the softer trackform, choose a law of deflection such as \
             `laws.guerin_1996`, or read the step at the structure as the ballast's part alone",
        );
        pointed(diagnostic, scenario, law, "this law")
    };
    laws(scenario).filter(|law| law.law.knows_forces_alone()).map(of_law).collect()
}

/// The first transition with ballast on both sides of which one is stiffer: the names of the softer and of the stiffer section. A
/// settlement that the scene states for the softer side is what its subgrade does.
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

/// Median stiffness at rail level of the seats of a section, N/m: it says which sleepers carry more.
fn of_section(scenario: &Scenario, graph: &Graph, section: usize) -> Option<f64> {
    let track = &scenario.track;
    let at_seat = |seat| Some(Winkler::at_seat(track, &graph.supports, seat)?.rail_stiffness());
    median(track.seats_of(section).map(at_seat).collect::<Option<_>>()?)
}
