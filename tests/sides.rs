//! Which side of a transition is the softer one: offered where it is missing, warned of where the ground says
//! otherwise.

use trackbed::check::NoModules;
use trackbed::diag::{Code, Diagnostic, render};
use trackbed::{Compiled, compile};

/// Ballast on ground and a deck, of which a track is made, and a load.
fn check(track: &str, rest: &str) -> Compiled {
    let text = format!(
        "use std
trackform open {{
  rail = rails.UIC60
  pad = pads.medium
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = {{ stiffness = 40 MN/m per seat }}
}}
trackform deck : open {{ sleeper = none, support = none, slab = slabs.half_width_1600, pad.stiffness = 20 MN/m }}
trackform layered : open {{ support = none, layers = [ballasts.granite_31_63: 350 mm, soils.sandy_gravel: 3 m] }}
trackform bridge : open {{ support.stiffness = 90 MN/m per seat }}
track line {{ {track} }}
scenario {{ allow = [stiffness_jump: \"a test\"] }}
{rest}
"
    );
    let mut compiled = compile("scene.track", &text, &NoModules, &[]);
    // not every track uses every trackform
    compiled.diagnostics.retain(|d| d.code != Code::E0412);
    compiled
}

const JACK: &str = "load jack { on = rail, at = 3 m, force = 100 kN per rail }";
const TRAIN: &str = "train ore { vehicles = vehicles.ore_wagon_30t, speed = 70 km/h }
traffic { trains = ore, total = 100 axles }";

fn told(compiled: &Compiled) -> String {
    render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn only(compiled: &Compiled, code: Code) -> &Diagnostic {
    let [found] = compiled.diagnostics.as_slice() else { panic!("{}", told(compiled)) };
    assert_eq!(found.code, code, "{}", told(compiled));
    found
}

/// The line that a help offers.
fn offered(diagnostic: &Diagnostic) -> String {
    let help = diagnostic.help.as_deref().unwrap();
    help.split('`').nth(1).unwrap_or_else(|| panic!("{help}")).to_owned()
}

#[test]
fn missing_sides_are_offered_as_the_ground_has_them() {
    for (sections, line) in [
        ("[open: 42 m, deck: 24 m, open: 42 m]", "transitions = [west: soft_to_stiff, east: stiff_to_soft]"),
        ("[deck: 24 m, open: 42 m, deck: 24 m]", "transitions = [west: stiff_to_soft, east: soft_to_stiff]"),
        ("[layered: 42 m, deck: 24 m, layered: 42 m]", "transitions = [west: soft_to_stiff, east: stiff_to_soft]"),
        (
            "[open: 42 m, deck: 24 m, open: 42 m, bridge: 24 m]",
            "transitions = [t1: soft_to_stiff, t2: stiff_to_soft, t3: soft_to_stiff]",
        ),
    ] {
        let compiled = check(&format!("sections = {sections}"), JACK);
        assert_eq!(offered(only(&compiled, Code::E0504)), line, "{sections}");
        let followed = check(&format!("sections = {sections}, {line}"), TRAIN);
        let followed = followed.diagnostics.iter().filter(|d| [Code::E0504, Code::L1033].contains(&d.code));
        assert_eq!(followed.count(), 0, "{sections}");
    }
}

#[test]
fn names_that_are_there_are_kept_in_the_offer() {
    let text = "sections = [deck: 24 m, open: 42 m, deck: 24 m], transitions = [gare: soft_to_stiff]";
    let compiled = check(text, JACK);
    assert_eq!(offered(only(&compiled, Code::E0504)), "transitions = [gare: stiff_to_soft, east: soft_to_stiff]");
}

#[test]
fn sides_against_the_ground_are_told_with_the_line_to_write() {
    for (track, says, line) in [
        (
            "sections = [deck: 24 m, open: 42 m]",
            "a transition without a word counts as `soft_to_stiff`",
            "transitions = [edge: stiff_to_soft]",
        ),
        (
            "sections = [open: 42 m, deck: 24 m], transitions = [gare: stiff_to_soft]",
            "transition `gare` is declared `stiff_to_soft`, but the support under the pads is stiffer behind it",
            "transitions = [gare: soft_to_stiff]",
        ),
        (
            "sections = [open: 42 m, deck: 24 m, open: 42 m], transitions = [a: stiff_to_soft, b: soft_to_stiff]",
            "transitions `a` and `b` are declared the wrong way round",
            "transitions = [a: soft_to_stiff, b: stiff_to_soft]",
        ),
    ] {
        let compiled = check(track, TRAIN);
        let found: Vec<&Diagnostic> = compiled.diagnostics.iter().filter(|d| d.code == Code::L1033).collect();
        assert!(found.len() == 1 && found[0].message.starts_with(says), "{}", told(&compiled));
        assert_eq!(offered(found[0]), line);
        // followed, nothing is left to say
        let start = track.find(", transitions").unwrap_or(track.len());
        let followed = check(&format!("{}, {line}", &track[..start]), TRAIN);
        assert!(followed.diagnostics.iter().all(|d| d.code != Code::L1033), "{}", told(&followed));
    }
}

#[test]
fn soft_pads_on_a_deck_do_not_make_it_the_softer_side() {
    let compiled = check("sections = [open: 42 m, deck: 24 m]", JACK);
    assert!(compiled.diagnostics.is_empty(), "{}", told(&compiled));
}

#[test]
fn a_law_of_force_on_a_ballasted_bridge_is_told() {
    let rule = |forms: &str, law: &str| {
        let compiled = check(forms, &format!("{TRAIN}\nsolve {{ substructure = law, law = {law} }}"));
        let found: Vec<Diagnostic> = compiled.diagnostics.iter().filter(|d| d.code == Code::L1034).cloned().collect();
        (found, told(&compiled))
    };
    let ballasted = "sections = [open: 42 m, bridge: 36 m]";
    let (found, text) = rule(ballasted, "laws.varandas_2014");
    assert!(found.len() == 1 && found[0].message.contains("the stiffer section `bridge`"), "{text}");
    for (forms, law) in [(ballasted, "laws.guerin_1996"), ("sections = [open: 42 m, deck: 36 m]", "laws.varandas_2014")]
    {
        let (found, text) = rule(forms, law);
        assert!(found.is_empty(), "{text}");
    }
}
