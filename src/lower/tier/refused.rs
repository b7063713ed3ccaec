//! What grains under a track cannot run, told at what asks for it.

use crate::diag::{Code, Diagnostic, Span};
use crate::graph::GrainStretch;
use crate::lower::bed;
use crate::scenario::{Base, Loading, Scenario};
use crate::units::number;

/// Why a track on grains cannot run this traffic, whatever lies where; nothing where it can.
pub(super) fn of_traffic(scenario: &Scenario) -> Vec<Diagnostic> {
    let grains = &scenario.solve.grains;
    let mut found = Vec::new();
    let Some(Loading::Traffic(traffic)) = &scenario.loading else {
        found.push(waits(
            "grains under a track run under trains, and no train runs here".into(),
            None,
            "give the scene `traffic`",
        ));
        return found;
    };
    if traffic.is_mixed() {
        let message = "trains of several kinds cannot run over grains in this version";
        found.push(waits(message.into(), traffic.total.origin.span(), "name one train in `traffic`"));
    }
    if !scenario.tampings.is_empty() {
        let message = "grains cannot be tamped in this version";
        found.push(waits(message.into(), grains.tier.origin.span(), "leave the `tamping` out"));
    }
    if scenario.track.bed.base == Base::Quiet {
        found.push(waits(
            "under grains `base = quiet` lets the soil sink: a quiet base bears no load that stays".into(),
            None,
            "leave out `base = quiet`, and let the lowest layer of soil be deeper",
        ));
    }
    if grains.both_rails {
        found.push(waits(
            "the bed of both rails cannot carry a track in this version".into(),
            None,
            "write `symmetry = half`",
        ));
    }
    let short: Vec<&str> =
        traffic.train.vehicles.iter().filter(|v| v.length.is_none()).map(|v| v.name.as_str()).collect();
    if *grains.continuous
        && let Some(name) = short.first()
    {
        let message = format!("vehicle `{name}` has no `length`: how closely do trains follow each other?");
        let help = "give the vehicle its `length` over couplers, such as `length = 10.3 m`";
        found.push(waits(message, grains.continuous.origin.span(), help));
    }
    found
}

/// Grains that change along a section, where beds lie between these ends (m): a bed is one from end to end. Glue may change.
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
                format!("from {from} to {to} m other layers of grains lie than in the rest of section `{name}`");
            let help = "let the grains be the same there but for their `bond`, and change the soil below them; or run `substructure = law`";
            found.push(Diagnostic::new(Code::E0604, message).help(help));
        }
    }
    found
}

/// Lengths closer than this are one, m.
const TINY: f64 = 1e-6;

/// Too few sleepers on grains.
pub(super) fn few_sleepers(stretches: &[GrainStretch]) -> Option<Diagnostic> {
    (stretches.iter().map(|stretch| stretch.sleepers.len()).sum::<usize>() < FEWEST).then(|| {
        let message = format!("fewer than {FEWEST} sleepers stand on grains");
        waits(message, None, "let `solve.window` reach over more bays of a section with a layer of grains")
    })
}

/// Vehicles that ride on the rail over the grains, where no rail joins the grains.
pub(super) fn ridden(scenario: &Scenario) -> Option<Diagnostic> {
    scenario.solve.grains.monolithic.then(|| {
        let message = "vehicles cannot ride over cells of grains: no rail joins the cells".to_owned();
        let tier = scenario.solve.grains.tier;
        waits(message, tier.origin.span(), "leave out `coupling = monolithic`, or write `substructure = zone`")
    })
}

/// Sleepers on grains, at least.
const FEWEST: usize = 2;

pub(super) fn waits(message: String, at: Option<Span>, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::E0604, message);
    let diagnostic = match at {
        Some(span) => diagnostic.label(span, "asked for here"),
        None => diagnostic,
    };
    diagnostic.help(help)
}
