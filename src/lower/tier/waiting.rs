//! Scenes that only a model of grains can run. The tier must be requested by name, or this version cannot run the
//! scene. The diagnostic stands at the text that needs grains.

use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Loading, Scenario, Section, Tier, Track};

/// Reason why a scene needs grains; `None` if it needs none.
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
    let message = "this version checks cyclic and moving loads but cannot run them".to_owned();
    let help = "a constant `force` gives the equilibrium of the track under it".to_owned();
    waits(message, Some(at), "not a constant force at one place", help)
}

fn unknown_stiffness(section: &Section) -> Diagnostic {
    let message =
        format!("trackform `{}` has no `support`, and its layers have grains without `youngs_modulus`", section.name);
    let text = "only a model of grains can compute the stiffness; it takes hours and must be requested by name";
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

/// Place of the first load that is not a constant force at one place.
fn changing(scenario: &Scenario) -> Option<Span> {
    let Some(Loading::Rig(loads)) = &scenario.loading else { return None };
    loads.iter().find_map(|load| load.changes)
}

/// Whether the stiffness of the layers of a section can be computed only with grains.
fn stands_on_grains(track: &Track, section: usize) -> bool {
    let unknown = track.sections[section].layers.iter().any(|layer| layer.youngs_modulus().is_none());
    unknown && track.seats[track.seats_of(section)].iter().any(|seat| seat.is_ballasted() && seat.support().is_none())
}
