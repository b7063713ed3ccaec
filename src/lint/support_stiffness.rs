//! L1016: a support is softer or stiffer than any that has been measured.
//!
//! Measured ballasted track has 20 .. 100 MN/m under half a sleeper. Values below 10 mean a swamp or a gap, values
//! above 200 a sleeper on concrete. The usual cause is a value for a whole sleeper, or for the whole track, with a
//! wrong `per`.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Origin, Scenario};
use crate::units::number;

/// N/m per seat.
const SOFTEST: f64 = 10e6;
const STIFFEST: f64 = 200e6;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    // a rig tests its layers
    if graph.track().is_none() {
        return Vec::new();
    }
    let track = &scenario.track;
    // the stiffness of a seat, and the place at which the scene states it
    let stiffness = |index: usize| {
        let support = graph.supports.get(index)?.support?;
        Some((
            support.stiffness,
            track.seats[index].support().map_or(Origin::Derived, |stated| stated.stiffness.origin),
        ))
    };
    let mut found: Vec<Diagnostic> = Vec::new();
    for (i, section) in track.sections.iter().enumerate() {
        let supports = || track.seats_of(i).filter_map(stiffness);
        let soft = supports().filter(|k| k.0 < SOFTEST).min_by(|a, b| a.0.total_cmp(&b.0));
        let stiff = supports().filter(|k| k.0 > STIFFEST).max_by(|a, b| a.0.total_cmp(&b.0));
        let beyond = supports().filter(|k| !(SOFTEST..=STIFFEST).contains(&k.0)).count();
        let said = |what: &str, (k, origin): (f64, Origin)| {
            let message = format!(
                "{beyond} of {} supports of `{}` are {what} than any measured support: {} MN/m per seat",
                supports().count(),
                section.name,
                number((k / 1e5).round() / 10.0)
            );
            let diagnostic = Diagnostic::new(Code::L1016, message)
                .help("20 .. 100 MN/m is usual under half a sleeper: is the value per seat, per sleeper or per track?");
            match origin.span() {
                Some(span) => diagnostic.label(span, "this support"),
                None => diagnostic,
            }
        };
        found.extend(soft.map(|k| said("softer", k)));
        found.extend(stiff.map(|k| said("stiffer", k)));
    }
    found
}
