//! Layers that carry sleepers: what the stack under a seat makes of its support, what stretches and approach slabs
//! change of it, and what cannot be.

use trackbed::check::NoModules;
use trackbed::diag::Code;
use trackbed::graph::SupportNode;
use trackbed::lower::supports;
use trackbed::scenario::{Scenario, Seat};
use trackbed::{Compiled, compile};

/// Half a B70: 1.3 m x 0.3 m.
const AREA: f64 = 0.39;

/// Layers that do not spread a load: springs E A / h in series.
const MATERIALS: &str = "use std
soil top : soils.sand { youngs_modulus = 100 MPa, spread = 0 deg }
soil fill : soils.sand { youngs_modulus = 50 MPa, spread = 0 deg }
soil treated : soils.sand { youngs_modulus = 400 MPa, spread = 0 deg }
";

/// Sleepers -70 .. -1 on these layers, seats +1 .. +40 on a slab.
fn embankment(before: &str, layers: &str, stretches: &str) -> String {
    format!(
        "{MATERIALS}{before}
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  layers = [{layers}]
}}
trackform deck : open {{ sleeper = none, slab = slabs.half_width_1600 }}
track line {{ sections = [open: 70 sleepers, deck: 24 m], stretches = [{}] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }}
traffic {{ trains = ore, total = 4 axles }}
{stretches}",
        if stretches.is_empty() { "" } else { "a" }
    )
}

fn checked(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn told(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn scene(text: &str) -> Scenario {
    let compiled = checked(text);
    let wrong = |d: &trackbed::diag::Diagnostic| d.code.rule().is_none() && d.code != Code::E0412;
    assert!(!compiled.diagnostics.iter().any(wrong), "{}", told(&compiled));
    assert!(compiled.graph.is_some(), "it runs");
    compiled.scenario.unwrap()
}

fn seat(scenario: &Scenario, number: i32) -> &Seat {
    scenario.track.seats.iter().find(|s| s.number == number).unwrap()
}

/// Stiffness and damping of a support, N/m and N s/m.
fn support(scenario: &Scenario, number: i32) -> (f64, f64) {
    let support = carrier(scenario, number).support.unwrap();
    (support.stiffness, support.damping)
}

/// What carries a seat, as every plan of the scene has it.
fn carrier(scenario: &Scenario, number: i32) -> SupportNode {
    supports(scenario)[scenario.track.seats.iter().position(|s| s.number == number).unwrap()]
}

fn stiffness(scenario: &Scenario, number: i32) -> f64 {
    support(scenario, number).0
}

#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-9, "found {found}, expected {expected}");
}

/// Springs in series, N/m, from thickness, m, and modulus, Pa, on the bearing area.
fn series(layers: &[(f64, f64)]) -> f64 {
    AREA / layers.iter().map(|(h, e)| h / e).sum::<f64>()
}

const PLAIN: &str = "top: 0.4 m, fill: 2 m";

#[test]
fn layers_that_do_not_spread_are_springs_in_series() {
    let scenario = scene(&embankment("", PLAIN, ""));
    let expected = series(&[(0.4, 100e6), (2.0, 50e6)]);
    for number in [-70, -35, -1] {
        let (stiffness, damping) = support(&scenario, number);
        close(stiffness, expected);
        close(damping, 1e-3 * expected);
        close(carrier(&scenario, number).onto_subgrade.unwrap(), 1.0 / AREA);
    }
    assert_eq!(carrier(&scenario, 1).onto_subgrade, None);
}

#[test]
fn the_plan_says_what_layers_carry_and_by_which_method() {
    let decided = |text: &str| {
        let graph = checked(text).graph.unwrap();
        let known = graph.supports.iter().filter(|node| node.spring.is_some()).count();
        let decision = graph.decisions.into_iter().find(|decision| decision.pass == "supports");
        (known, decision.map(|decision| (decision.what, decision.rejected[0].what.clone())))
    };
    let (known, decision) = decided(&embankment("", PLAIN, ""));
    let what = format!("the layers give the stiffness of {known} supports, by the stress cone");
    assert_eq!(decision, Some((what, "layered elasticity".to_owned())));
    let stated =
        embankment("", PLAIN, "").replace("layers = [", "support = { stiffness = 40 MN/m per seat }, layers = [");
    assert_eq!(decided(&stated), (known, None), "layers under stated supports only say what presses on the subgrade");
}

#[test]
fn every_seat_has_its_own_modulus_and_thickness() {
    let before = "soil graded : fill { youngs_modulus = ramp(40 .. 80 MPa, over = -21 .. -1 sleepers) }";
    let scenario = scene(&embankment(before, "top: 0.4 m, graded: ramp(2 .. 1 m, over = -21 .. -1 sleepers)", ""));
    for (number, share) in [(-40, 0.0), (-21, 0.0), (-11, 0.5), (-6, 0.75), (-1, 1.0)] {
        close(stiffness(&scenario, number), series(&[(0.4, 100e6), (2.0 - share, (40.0 + 40.0 * share) * 1e6)]));
    }
}

#[test]
fn a_load_that_spreads_meets_softer_springs_of_larger_area() {
    let wide = embankment("", PLAIN, "").replace("spread = 0 deg", "spread = 35 deg");
    let (narrow, wide) = (scene(&embankment("", PLAIN, "")), scene(&wide));
    assert!(stiffness(&wide, -30) > 1.5 * stiffness(&narrow, -30));
    assert!(carrier(&wide, -30).onto_subgrade < carrier(&narrow, -30).onto_subgrade);
    // closer sleepers have less ground each
    let closer =
        scene(&embankment("", PLAIN, "").replace("spread = 0 deg", "spread = 35 deg").replace("0.6 m", "0.5 m"));
    assert!(stiffness(&closer, -30) < stiffness(&wide, -30));
}

#[test]
fn a_method_and_what_lies_below_are_chosen() {
    let text = embankment("", "ballasts.granite_31_63: 350 mm, soils.clay: 3 m", "");
    let with = |more: &str| stiffness(&scene(&format!("{text}{more}\n")), -30);
    let (cone, elastic) = (with(""), with("solve { support_method = layered_elastic }"));
    assert_eq!(cone, with("solve { support_method = stress_cone }"));
    // on soft ground the cone is the lower bound
    assert!(elastic > 1.2 * cone, "{cone} {elastic}");
    assert!(with("solve { support_method = layered_elastic(neighbours = 0) }") > elastic);
    let quiet = text.replace("sections = [open", "base = quiet, sections = [open");
    assert!(stiffness(&scene(&quiet), -30) < cone, "ground that goes on is softer than rock");
}

#[test]
fn a_stated_support_wins_and_changes_as_the_layers_do() {
    let stated = |stretch: &str| {
        let text = embankment("", PLAIN, stretch);
        text.replace("  layers =", "  support = { stiffness = 30 MN/m per seat, damping_time = 2 ms }\n  layers =")
    };
    close(stiffness(&scene(&stated("")), -5), 30e6);
    let wedge = "stretch a { over = -10 .. -1 sleepers, layers = [top: 0.4 m, treated: 0.8 m, fill: rest] }";
    let scenario = scene(&stated(wedge));
    close(stiffness(&scenario, -11), 30e6);
    let (with, without) = (series(&[(0.4, 100e6), (0.8, 400e6), (1.2, 50e6)]), series(&[(0.4, 100e6), (2.0, 50e6)]));
    let (found, damping) = support(&scenario, -5);
    close(found, 30e6 * with / without);
    close(damping, 2e-3 * found);
    // what the stretch itself states is what it means
    let own = wedge.replace("layers =", "support.stiffness = 44 MN/m per seat, layers =");
    close(stiffness(&scene(&stated(&own)), -5), 44e6);
}

#[test]
fn a_wedge_keeps_the_depth() {
    let wedge = "stretch a { over = -12 .. 0 m, layers = [top: 0.4 m, treated: ramp(0 .. 1.2 m), fill: rest] }";
    let scenario = scene(&embankment("", PLAIN, wedge));
    let [work] = scenario.track.groundworks.as_slice() else { panic!("one groundwork") };
    assert_eq!((work.start, work.end, work.layers.len()), (-12.0, 0.0, 3));
    for x in [-12.0, -7.3, -0.6, 0.0] {
        let treated = 1.2 * (x + 12.0) / 12.0;
        assert!((work.layers[1].thickness.value_at(x) - treated).abs() < 1e-9);
        assert!((work.layers[2].thickness.value_at(x) - (2.0 - treated)).abs() < 1e-9);
    }
    for number in [-20, -13, -7, -1] {
        let treated = 1.2 * (seat(&scenario, number).x + 12.0) / 12.0;
        close(stiffness(&scenario, number), series(&[(0.4, 100e6), (treated, 400e6), (2.0 - treated, 50e6)]));
    }
    close(stiffness(&scenario, -21), series(&[(0.4, 100e6), (2.0, 50e6)]));
}

#[test]
fn one_layer_can_be_changed_by_its_name() {
    let firm =
        scene(&embankment("", PLAIN, "stretch a { over = -9 .. -1 sleepers, layers.top = 1 m, layers.fill = rest }"));
    close(stiffness(&firm, -5), series(&[(1.0, 100e6), (1.4, 50e6)]));
    close(stiffness(&firm, -10), series(&[(0.4, 100e6), (2.0, 50e6)]));
}

const SLAB: &str =
    "approach_slab = { thickness = 300 mm, youngs_modulus = 30 GPa, density = 2500 kg/m^3, depth = 400 mm";

#[test]
fn an_approach_slab_is_stiffest_at_its_hinge() {
    let with =
        |hinged: &str| scene(&embankment("", PLAIN, &format!("stretch a {{ over = -6 .. 0 m, {SLAB}{hinged} }} }}")));
    let (hinged, loose) = (with(""), with(", hinged = no"));
    // without spread nothing is gained but the plate itself
    close(stiffness(&loose, -5), series(&[(0.4, 100e6), (0.3, 30e9), (1.7, 50e6)]));
    for number in [-1, -4, -9] {
        let share = -seat(&hinged, number).x / 6.0;
        close(stiffness(&hinged, number), series(&[(0.4, 100e6), (0.3, 30e9), (1.7, 50e6 / (share * share))]));
    }
    // by the lever the structure bears the rest
    let onto = |scenario: &Scenario, number: i32| carrier(scenario, number).onto_subgrade.unwrap();
    close(onto(&hinged, -4), onto(&loose, -4) * 2.4 / 6.0);
    let falls: Vec<f64> = (1..=10).map(|n| stiffness(&hinged, -n)).collect();
    assert!(falls.windows(2).all(|pair| pair[0] > pair[1]), "{falls:?}");
    close(stiffness(&hinged, -10), stiffness(&loose, -10));
    let [work] = hinged.track.groundworks.as_slice() else { panic!("one groundwork") };
    assert_eq!(work.approach_slab.unwrap().ends, [0.0, -6.0]);
}

#[test]
fn a_plate_spreads_the_load_as_odemark_says() {
    let spreading = embankment("", PLAIN, &format!("stretch a {{ over = -6 .. 0 m, {SLAB}, hinged = no }} }}"))
        .replace("spread = 0 deg", "spread = 10 deg");
    let (plain, with) = (
        scene(&spreading.replace("stretches = [a]", "stretches = []").replace("stretch a", "stretch unused")),
        scene(&spreading),
    );
    let onto = |scenario: &Scenario| 1.0 / carrier(scenario, -5).onto_subgrade.unwrap();
    // outwards alone: neighbours and the other rail stop the cone along the track and inwards
    let tan = 10f64.to_radians().tan();
    let equivalent = 0.9 * 0.3 * f64::cbrt(30e9 / 50e6);
    close(onto(&plain), (0.3 + 2.0 * 0.4 * tan) * (1.3 + 0.4 * tan));
    close(onto(&with), 0.6 * (1.3 + (0.4 + equivalent) * tan));
}

#[test]
fn pressure_on_the_subgrade_is_compared_like_any_response() {
    let text = embankment("", PLAIN, "")
        + "expect { that = [max(subgrade_pressure) < 200 kPa, 0 kPa < mean(subgrade_pressure)] }\n";
    assert_eq!(scene(&text).expectations.len(), 2);
    let wrong = checked(&text.replace("200 kPa", "200 kN"));
    assert!(wrong.diagnostics.iter().any(|d| d.is_error()), "a pressure is no force");
}

#[test]
fn what_the_ground_cannot_be_is_refused_once() {
    let stone = "granular stone { grading = gradings.ballast_31_63, density = 2650 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7 }";
    let law = "solve { substructure = law }";
    let slab = |over: &str, more: &str| format!("stretch a {{ over = {over}, {SLAB}{more} }} }}");
    let layers = |layers: &str| format!("stretch a {{ over = -9 .. -1 sleepers, layers = [{layers}] }}");
    let cases: &[(&str, &str, String, Code, &str)] = &[
        (stone, "stone: 0.4 m, fill: 2 m", law.into(), Code::E0419, "granular `stone` needs its `youngs_modulus`"),
        ("", PLAIN, layers("top: rest, fill: rest"), Code::E0423, "two layers cannot both have"),
        ("", PLAIN, layers("top: 3 m, fill: rest"), Code::E0423, "`rest` has no thickness at seat -9"),
        ("", PLAIN, layers("top: 0.4 m, fill: 1 m"), Code::E0424, "are 1400 mm deep at seat -9"),
        ("", PLAIN, slab("-8 .. -2 m", ""), Code::E0425, "ends at -2 m"),
        ("", PLAIN, slab("-6 .. 0 m", "").replace("depth = 400 mm", "depth = 2.2 m"), Code::E0426, "reaches 2500 mm"),
        (
            "",
            PLAIN,
            slab("1 .. 9 sleepers", ""),
            Code::E0418,
            "sets `approach_slab`, but seats +1 .. +9 stand on a slab",
        ),
        ("", PLAIN, "stretch a { over = 1 .. 9 sleepers, layers = [top: 1 m] }".into(), Code::E0418, "sets `layers`"),
        (
            "",
            PLAIN,
            slab("-6 .. 0 m", "").replace("hinged", "hnged").replace("30 GPa", "30 kPa"),
            Code::E0405,
            "5 .. 60",
        ),
        ("", "top: 0 m, fill: 0 m", String::new(), Code::E0407, "cannot carry the sleeper at seat -70"),
    ];
    for (before, under, stretches, code, message) in cases {
        let mut text = embankment(before, under, stretches);
        if !stretches.starts_with("stretch") {
            text = text.replace("stretches = [a]", "stretches = []");
        }
        let compiled = checked(&text);
        let found: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(found.len() == 1 && found[0].code == *code, "{stretches}\n{}", told(&compiled));
        assert!(
            found[0].message.contains(message) && found[0].help.is_some() || *code == Code::E0405,
            "{}",
            told(&compiled)
        );
    }
}

#[test]
fn a_stretch_cannot_change_ground_that_nobody_knows() {
    let text = embankment("", PLAIN, &format!("stretch a {{ over = -6 .. 0 m, {SLAB} }} }}"))
        .replace("layers = [top: 0.4 m, fill: 2 m]", "support = { stiffness = 40 MN/m per seat }");
    let compiled = checked(&text);
    let found: Vec<Code> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
    assert_eq!(found, [Code::E0418], "{}", told(&compiled));
}

#[test]
fn a_support_that_changes_as_the_layers_do_needs_both_stacks() {
    let stone = "granular stone { grading = gradings.ballast_31_63, density = 2650 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7 }";
    let stretch = "stretch a { over = -9 .. -1 sleepers, layers = [top: 0.4 m, fill: rest] }";
    let text = embankment(stone, "stone: 0.4 m, fill: 2 m", stretch)
        .replace("  layers =", "  support = { stiffness = 40 MN/m per seat }\n  layers =");
    let compiled = checked(&text);
    let found: Vec<_> = compiled.diagnostics.iter().filter(|d| d.is_error()).collect();
    assert!(found.len() == 1 && found[0].code == Code::E0419, "{}", told(&compiled));
    assert!(found[0].message.contains("`stone` under the stretch"), "{}", told(&compiled));
}

#[test]
fn two_slabs_cannot_lie_in_one_place() {
    let one = format!("{SLAB} }} }}\n");
    let text =
        embankment("", PLAIN, &format!("stretch a {{ over = -6 .. 0 m, {one}stretch b {{ over = -4 .. 0 m, {one}"))
            .replace("stretches = [a]", "stretches = [a, b]");
    let compiled = checked(&text);
    let found: Vec<Code> = compiled.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
    assert_eq!(found, [Code::E0512], "{}", told(&compiled));
}
