//! Scenes that grains under a track cannot run, reported at the text that asks for them.

use crate::diag::{Code, Diagnostic, Span};
use crate::graph::GrainStretch;
use crate::lower::bed;
use crate::scenario::{Base, Loading, Scenario};
use crate::units::number;

/// Reasons why a track on grains cannot run the traffic of the scene; empty if it can.
pub(super) fn of_traffic(scenario: &Scenario) -> Vec<Diagnostic> {
    let tamped = (!scenario.tampings.is_empty()).then(|| {
        let message = "grains cannot be tamped in this version";
        waits(message.into(), scenario.solve.grains.tier.origin.span(), "leave the `tamping` out")
    });
    of_trains(scenario).into_iter().chain(tamped).collect()
}

/// Reasons why the trains of the scene cannot run over grains; empty if they can.
fn of_trains(scenario: &Scenario) -> Vec<Diagnostic> {
    let grains = &scenario.solve.grains;
    let mut found = Vec::new();
    let Some(Loading::Traffic(traffic)) = &scenario.loading else {
        found.push(waits(
            "a track on grains needs trains, and this scene has no `traffic`".into(),
            None,
            "add `traffic` to the scene",
        ));
        return found;
    };
    if traffic.is_mixed() {
        let message = "trains of several kinds cannot run over grains in this version";
        found.push(waits(message.into(), traffic.total.origin.span(), "name one train in `traffic`"));
    }
    if scenario.track.bed.base == Base::Quiet {
        found.push(waits(
            "`base = quiet` lets the soil under grains sink: a quiet base cannot carry a permanent load".into(),
            None,
            "leave out `base = quiet`, and make the lowest layer of soil thicker",
        ));
    }
    if grains.both_rails {
        found.push(waits(
            "`symmetry = full`, the bed of both rails, cannot carry a track in this version".into(),
            None,
            "write `symmetry = half`",
        ));
    }
    let short: Vec<&str> =
        traffic.train.vehicles.iter().filter(|v| v.length.is_none()).map(|v| v.name.as_str()).collect();
    if *grains.continuous
        && let Some(name) = short.first()
    {
        let message =
            format!("vehicle `{name}` has no `length`, which gives the distance of trains that follow each other");
        let help = "give the vehicle its `length` over couplers, such as `length = 10.3 m`";
        found.push(waits(message, grains.continuous.origin.span(), help));
    }
    found
}

/// Reasons why cells of grains cannot run the traffic of the scene; empty if they can.
pub(super) fn of_cells(scenario: &Scenario) -> Vec<Diagnostic> {
    of_traffic(scenario).into_iter().chain(ridden(scenario)).chain(other_grains(scenario, &WHOLE)).collect()
}

/// Reasons why cells of grains cannot check a law; empty if they can. Tamping ends the check, and what has no effect on
/// the law is not used.
pub(super) fn of_check(scenario: &Scenario) -> Vec<Diagnostic> {
    of_trains(scenario).into_iter().chain(other_grains(scenario, &WHOLE)).collect()
}

/// The whole track, m.
const WHOLE: [[f64; 2]; 1] = [[f64::NEG_INFINITY, f64::INFINITY]];

/// Diagnostics for grains that change along a section with beds between these ends (m). A bed has the same grains from
/// end to end; only the glue may change.
pub(super) fn other_grains(scenario: &Scenario, beds: &[[f64; 2]]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (number_of, section) in scenario.track.sections.iter().enumerate() {
        let middle = 0.5 * (section.start + section.end);
        if !section.layers.iter().any(|layer| layer.granular().is_some()) {
            continue;
        }
        for part in scenario.track.ground(number_of) {
            let inside = beds.iter().any(|[left, right]| part.start < right - TINY && part.end > left + TINY);
            let alike = |x: f64| bed::packs_alike((&section.layers, middle), (&part.layers, x));
            if !inside || [part.start + TINY, part.end - TINY].into_iter().all(alike) {
                continue;
            }
            let [from, to] = [part.start, part.end].map(number);
            let name = &section.name;
            let message =
                format!("from {from} to {to} m the layers of grains differ from the rest of section `{name}`");
            let help = "use the same grains in the whole section (only `bond` may differ) and change the soil below them; or write `substructure = law`";
            found.push(Diagnostic::new(Code::E0604, message).help(help));
        }
    }
    found
}

/// Lengths that differ by less than this count as equal, m.
const TINY: f64 = 1e-6;

/// Diagnostic for too few sleepers on grains.
pub(super) fn few_sleepers(stretches: &[GrainStretch]) -> Option<Diagnostic> {
    (stretches.iter().map(|stretch| stretch.sleepers.len()).sum::<usize>() < FEWEST).then(|| {
        let message = format!("fewer than {FEWEST} sleepers stand on grains");
        waits(message, None, "make `solve.window` longer, over more bays of a section with a layer of grains")
    })
}

/// Diagnostic for `coupling = monolithic` with cells of grains.
fn ridden(scenario: &Scenario) -> Option<Diagnostic> {
    scenario.solve.grains.monolithic.then(|| {
        let message =
            "`coupling = monolithic` cannot run on cells of grains: the rail does not connect the cells".to_owned();
        let tier = scenario.solve.grains.tier;
        waits(message, tier.origin.span(), "leave out `coupling = monolithic`, or write `substructure = zone`")
    })
}

/// Least number of sleepers on grains.
const FEWEST: usize = 2;

pub(super) fn waits(message: String, at: Option<Span>, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0604, message);
    let diagnostic = match at {
        Some(span) => diagnostic.label(span, "asked for here"),
        None => diagnostic,
    };
    diagnostic.help(help)
}
