//! What only a model of grains can run, and runs only where it is asked for by name, or not in this version: told at what asks for it.

use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Loading, Scenario, Section, Tier, Track};

/// Why a scene waits for grains; `None` where nothing of it asks for them.
pub(super) fn refusal(scenario: &Scenario) -> Option<Diagnostic> {
    let tier = scenario.solve.grains.tier;
    let changing = changing(scenario);
    let track = &scenario.track;
    let on_grains = (0..track.sections.len()).find(|section| stands_on_grains(track, *section));
    let on_grains = on_grains.map(|section| &track.sections[section]);
    match *tier {
        _ if changing.is_some() => changing.map(changes),
        Tier::Auto => on_grains.map(unknown_stiffness),
        Tier::Law | Tier::Cells | Tier::Zone | Tier::Full => None,
    }
}

fn changes(at: Span) -> Diagnostic {
    let message = "this version checks cyclic and moving loads and cannot run them yet".to_owned();
    let help = "a constant `force` gives the equilibrium of the track under it".to_owned();
    waits(message, Some(at), "not a constant force at one place", help)
}

fn unknown_stiffness(section: &Section) -> Diagnostic {
    let message = format!("trackform `{}` has no `support`, and grains without a modulus in its layers", section.name);
    let text = "only a model of grains finds their stiffness, which takes hours and is asked for by name";
    let help = "write `substructure = zone` to run grains; or add `support = { stiffness = 50 MN/m per seat }`, or give each granular its `youngs_modulus`, to run it with a settlement law";
    waits(message, section.layers_span, text, help.to_owned())
}

fn waits(message: String, at: Option<Span>, text: &str, help: String) -> Diagnostic {
    let mut diagnostic = Diagnostic::new(Code::E0604, message);
    if let Some(span) = at {
        diagnostic = diagnostic.label(span, text);
    }
    diagnostic.help(help)
}

/// Where the first load is that is more than a constant force at one place.
fn changing(scenario: &Scenario) -> Option<Span> {
    let Some(Loading::Rig(loads)) = &scenario.loading else { return None };
    loads.iter().find_map(|load| load.changes)
}

/// Whether only grains can say how stiff the layers of a section are.
fn stands_on_grains(track: &Track, section: usize) -> bool {
    let unknown = track.sections[section].layers.iter().any(|layer| layer.youngs_modulus().is_none());
    unknown && track.seats[track.seats_of(section)].iter().any(|seat| seat.is_ballasted() && seat.support().is_none())
}
