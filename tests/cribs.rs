//! Grains between and beside sleepers, `crib` and `shoulder`: what a scene may say, what its plan holds, and that a rig
//! with them runs.

use trackbed::check::NoModules;
use trackbed::diag::{Code, Diagnostic};
use trackbed::execute::Executor;
use trackbed::graph::{Graph, Model};
use trackbed::solvers::granular::rig::Crib;
use trackbed::store::Beds;
use trackbed::{Compiled, Scene, compile};

/// Coarse spheres under one sleeper of 2.6 m x 0.3 m x 0.214 m: packed and run in seconds.
const RIG: &str = r#"use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70 { height = 0.2 m }, spacing = 0.6 m, layers = [stone: 150 mm]CRIB }
track box { sections = [bed: 1 sleeper]WIDTH }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 2 cycles }
solve { substructure = full }
"#;

/// The rig with fields of its trackform and of its track.
fn rig(crib: &str, width: &str) -> String {
    RIG.replace("CRIB", crib).replace("WIDTH", width)
}

fn compiled(text: &str) -> Compiled {
    compile("scene.track", text, &NoModules, &[])
}

fn shown(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 110)
}

fn errors(text: &str) -> Vec<Diagnostic> {
    compiled(text).diagnostics.into_iter().filter(Diagnostic::is_error).collect()
}

/// The one error of a scene: its code, and words of its message and its help.
#[track_caller]
fn refused(text: &str, code: Code, message: &str, help: &str) {
    let found = errors(text);
    let [one] = &found[..] else { panic!("one error expected:\n{}", shown(&compiled(text))) };
    let (said, way_out) = (&one.message, one.help.clone().unwrap_or_default());
    assert!(one.code == code && said.contains(message) && way_out.contains(help), "{}", shown(&compiled(text)));
    assert!(!one.labels.is_empty(), "{said}: no place is named");
}

fn graph(text: &str) -> Graph {
    let compiled = compiled(text);
    compiled.runnable().cloned().unwrap_or_else(|| panic!("{}", shown(&compiled)))
}

/// The cribs and the width of the bed of a rig.
fn planned(text: &str) -> (Option<Crib>, f64) {
    let graph = graph(text);
    let bed = graph.nodes.iter().find_map(|node| if let Model::Bed(bed) = &node.model { Some(bed) } else { None });
    let bed = bed.unwrap();
    (bed.crib, bed.bed.numbers().plan[1])
}

#[test]
fn a_plan_holds_the_crib_of_its_trackform_and_a_bed_as_wide_as_it_needs() {
    assert_eq!(planned(&rig("", "")), (None, 1.3));
    assert_eq!(planned(&rig(", crib = none, shoulder = none", "")), (None, 1.3));
    assert_eq!(planned(&rig(", crib = 150 mm", "")), (Some(Crib { height: 0.15, shoulder: 0.0 }), 1.3));
    let both = ", crib = 150 mm, shoulder = 0.3 m";
    assert_eq!(planned(&rig(both, "")), (Some(Crib { height: 0.15, shoulder: 0.3 }), 1.6));
    assert_eq!(planned(&rig(both, ", bed_width = 1.9 m per rail")).1, 1.9);
}

#[test]
fn without_a_crib_a_plan_says_nothing_of_it_and_with_one_it_costs_more() {
    let (without, with) = (graph(&rig("", "")), graph(&rig(", crib = 150 mm, shoulder = 0.3 m", "")));
    let json = |graph: &Graph| serde_json::to_string(graph).unwrap();
    assert!(!json(&without).contains("crib") && json(&with).contains(r#""crib":{"height":0.15,"shoulder":0.3}"#));
    let back: Graph = serde_json::from_str(&json(&with)).unwrap();
    assert_eq!(back, with);
    let text = with.listing().text();
    assert!(
        text.contains("between the sleepers, up to 150 mm above the underside of the sleepers, and 300 mm"),
        "{text}"
    );
    assert!(without.listing().text().contains("there are no grains beside or between the sleepers"));
    assert!(with.cost.seconds > 1.1 * without.cost.seconds && with.cost.bytes > without.cost.bytes);
}

#[test]
fn what_cannot_be_is_told_with_a_way_out() {
    let shoulder = ", crib = 150 mm, shoulder = 0.3 m";
    refused(
        &rig(", shoulder = 0.3 m", ""),
        Code::E0403,
        "has a `shoulder` and needs a `crib`",
        "write `crib = 150 mm`",
    );
    refused(&rig(", crib = 250 mm", ""), Code::E0407, "to 250 mm, but its sleepers are 200 mm high", "`crib = 200 mm`");
    refused(&rig(shoulder, ", bed_width = 2.8 m per track"), Code::E0420, "with shoulders of 0.3 m", "3.2 m per track");
    refused(&rig(", crib = 5 mm", ""), Code::E0405, "10 .. 500 mm", "");
    refused(&rig(", crib = 5 kN", ""), Code::E0302, "a length in `mm`", "");
    let tight = rig(", crib = 150 mm", "").replace("spacing = 0.6 m", "spacing = 0.35 m");
    refused(&tight, Code::E0610, "up to 65 mm wide, and the gap between the sleepers is 50 mm", "larger `spacing`");
    let pressed = rig(", crib = 150 mm", "").replace(
        "on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper",
        "on = bed, at = 0.3 m, force = cyclic(5 .. 60 kN, 40 Hz) per rail",
    );
    refused(&pressed, Code::E0611, "there is no `crib` to fill", "`crib = none`");
}

/// A track on stated supports, on a slab behind its transition.
const TRACK: &str = "use std
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
  LAYERS
}
trackform deck : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
stretch a { over = -5 .. -1 sleepers, CHANGE }
track line { sections = [open: 30 m, deck: 24 m], stretches = [a] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 120 km/h }
traffic { trains = ore, total = 4 axles }
";

#[test]
fn on_a_track_a_crib_needs_sleepers_and_grains_and_is_that_of_a_whole_section() {
    let track = |layers: &str, change: &str| TRACK.replace("LAYERS", layers).replace("CHANGE", change);
    let usps = "usp = usps.soft";
    let dropped = |text: String| text.replace("slabs.half_width_1600 }", "slabs.half_width_1600, crib = none }");
    refused(
        &dropped(track("crib = 150 mm", usps)),
        Code::E0407,
        "has a `crib` and no layer of grains to fill it",
        "`layers` with a `granular`",
    );
    let ballast = "layers = [ballasts.granite_31_63: 300 mm, soils.sandy_gravel: 1 m], crib = 150 mm";
    refused(&track(ballast, usps), Code::E0407, "stands on a slab and has a `crib`", "write `crib = none`");
    refused(&dropped(track(ballast, "crib = 100 mm")), Code::E0411, "`crib` in a stretch", "section");
    // a law knows nothing of it
    let law = compiled(&dropped(track(ballast, usps)));
    assert!(law.runnable().is_some(), "{}", shown(&law));
}

#[test]
fn a_rig_with_cribs_runs_and_ends_with_the_same_bits_on_any_number_of_threads() {
    // one bed for both
    let beds = tempfile::tempdir().unwrap();
    let text = rig(", crib = 100 mm, shoulder = 0.1 m", "");
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let executor = Executor::default().with_beds(Beds::kept_in(beds.path()));
        pool.install(|| Scene::from_text(&text).run_with(&executor, &mut ()).unwrap())
    };
    let (one, two) = (run(1), run(2));
    let settlement = one.scalar("max_settlement").unwrap();
    assert!((0.0..10e-3).contains(&settlement), "{settlement} m");
    assert!(one.tests.is_some() && one.tests.unwrap().tests == two.tests.unwrap().tests);
}
