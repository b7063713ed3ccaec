//! One cause gives one diagnostic, however much depends on it.

use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::diag::{Code, Severity};

const ZONE: &str = include_str!("../scenarios/transition.track");
const TRIAXIAL: &str = include_str!("../scenarios/triaxial.track");
const BOX: &str = include_str!("../scenarios/box_test.track");
const BRIDGE: &str = include_str!("../scenarios/bridge.track");
const WEDGE: &str = include_str!("../scenarios/wedge.track");

/// A scene in which some text stands in the place of another.
fn with(scene: &str, find: &str, replace: &str) -> String {
    assert!(scene.contains(find), "{find}");
    scene.replacen(find, replace, 1)
}

/// A scene without a block, from its first words to the brace that closes it at the start of a line.
fn without(scene: &str, block: &str) -> String {
    let start = scene.find(block).unwrap();
    let end = start + scene[start..].find("\n}\n").unwrap() + 3;
    format!("{}{}", &scene[..start], &scene[end..])
}

/// What a scene says that another one does not.
fn told(scene: &str, before: &str) -> Vec<(Code, String, String)> {
    let all = |text: &str| {
        let diagnostics = compile("scene.track", text, &NoModules, &[]).diagnostics;
        diagnostics
            .into_iter()
            .filter(|d| d.severity != Severity::Note)
            .map(|d| (d.code, d.message, d.help.unwrap_or_default()))
            .collect::<Vec<_>>()
    };
    let known = all(before);
    all(scene).into_iter().filter(|said| !known.iter().any(|k| k.1 == said.1)).collect()
}

/// What breaks a scene, the one code that follows and a part of the way out.
#[track_caller]
fn one(scene: &str, before: &str, code: Code, help: &str) {
    let found = told(scene, before);
    assert!(found.len() == 1 && found[0].0 == code && found[0].2.contains(help), "{found:#?}");
}

#[test]
fn a_settlement_under_a_slab_is_refused_and_need_not_reach_over_it() {
    for settlement in ["[-42 m: 0 mm, -10 m: 0 mm, 0 m: 4 mm]", "[-42 .. -10 m: 0 mm, -10 .. 0 m: 4 mm]", "4 mm"] {
        let scene = with(ZONE, "  spacing = 0.6 m\n", &format!("  spacing = 0.6 m\n  settlement = {settlement}\n"));
        one(&scene, ZONE, Code::E0407, "write `settlement = 0 mm` in trackform `stiff`");
        let mended = with(&scene, "  sleeper = none\n", "  sleeper = none\n  settlement = 0 mm\n");
        assert_eq!(told(&mended, ZONE), []);
    }
}

#[test]
fn pairs_the_other_way_round_are_one_error() {
    let sections = "[open: 42 m, stiff: 24 m]";
    let way_out = format!("write `{sections}`");
    one(&with(ZONE, sections, "[42 m: open, 24 m: stiff]"), ZONE, Code::E0406, &way_out);
    one(&with(TRIAXIAL, "[stone: 600 mm]", "[600 mm: stone]"), TRIAXIAL, Code::E0406, "write `[stone: 600 mm]`");
}

#[test]
fn a_rig_that_lacks_something_is_told_what_it_lacks() {
    for (scene, block) in [(TRIAXIAL, "load press"), (BOX, "load actuator")] {
        one(&without(scene, block), scene, Code::E0601, "add a `load`");
    }
    for (scene, on) in [(TRIAXIAL, "  on          = bed\n"), (BOX, "  on    = sleepers\n")] {
        one(&with(scene, on, ""), scene, Code::E0403, "");
    }
    one(
        &with(TRIAXIAL, "  layers  = [stone: 600 mm]\n", ""),
        TRIAXIAL,
        Code::E0611,
        "`layers` with a `granular` on top",
    );
    for scene in [TRIAXIAL, BOX] {
        let law = with(scene, "substructure = full", "substructure = law");
        one(&law, scene, Code::E0611, "write `solve { substructure = full }`");
        // and what asks for no tier is a rig all the same
        assert_eq!(told(&with(scene, "substructure = full", ""), scene), []);
    }
}

#[test]
fn what_several_parts_need_is_told_once() {
    one(&with(ZONE, "  slab    = slabs.half_width_1600\n", ""), ZONE, Code::E0403, "");
    one(&with(WEDGE, "soil fill", "soil fil"), WEDGE, Code::E0201, "`fil`");
    one(&without(BRIDGE, "traffic {"), BRIDGE, Code::E0601, "add `traffic");
    let sides = "[west: stiff_to_soft, east: soft_to_stiff]";
    one(&with(BRIDGE, sides, "[east: soft_to_stiff, west: stiff_to_soft]"), BRIDGE, Code::E0418, "");
    let total = with(ZONE, "total = 500 axles", "total = 80 axles");
    one(&with(&total, "[0, 100, 500] axles", "[0, 100, 500] axles"), ZONE, Code::E0602, "");
}

/// Two sections of ballasted track and a bridge of 4.8 m between them, on ballast too.
fn short_bridge(before: f64, after: f64) -> String {
    format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.medium, sleeper = sleepers.B70, spacing = 0.6 m
  support = {{ stiffness = 40 MN/m per seat }}
}}
trackform bridge : open {{ support = {{ stiffness = 45 MN/m per seat }} }}
track line {{
  sections    = [open: {before} m, bridge: 4.8 m, open: {after} m]
  transitions = [west: soft_to_stiff, east: stiff_to_soft]
}}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }}
traffic {{ trains = ore, total = 400 axles }}
"
    )
}

#[test]
fn no_advice_lengthens_a_bridge() {
    // all its sleepers are passed, few as they are
    assert_eq!(told(&short_bridge(36.0, 36.0), ""), []);
    let short = told(&short_bridge(18.0, 36.0), "");
    assert!(short.len() == 1 && short[0].0 == Code::L1003, "{short:#?}");
    assert!(short[0].2.starts_with("add 4 m of track at the left end of the model"), "{short:#?}");
    let longer = told(&short_bridge(24.0, 36.0), "");
    assert_eq!(longer, [], "the advice helps");
    let scene = with(&short_bridge(36.0, 36.0), "bridge: 4.8 m", "bridge: 5 m");
    one(&scene, "", Code::E0502, "if the length is fixed, write `spacing = 5 m / 8`");
    let spaced = with(&scene, "45 MN/m per seat }", "45 MN/m per seat }, spacing = 5 m / 8");
    assert_eq!(told(&spaced, ""), []);
}
