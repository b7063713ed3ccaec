//! A field that does nothing says so: what a file states and its plan does not use is told, once for each reason.

use std::collections::BTreeSet;
use trackbed::check::{self, Folder, NoModules, Override};
use trackbed::diag::{Code, Diagnostic};
use trackbed::lower::Planner;
use trackbed::schema::{KINDS, kind};
use trackbed::study::{Scene, plan};
use trackbed::{Compiled, compile, lint, report};

/// A track under one wagon, on supports and on layers; `solve` follows.
const TRACK: &str = r#"use std
granular stone {
  grading = gradings.ballast_32_80, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  shape = clumps(2 .. 3), packing = { lifts = 2 }, youngs_modulus = 110 MPa
}
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  layers = [stone: 300 mm, soils.sandy_gravel: 1 m]
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
track line { sections = [open: 42 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 8 axles }
"#;

/// Twenty sleepers on a box of grains.
const RIG: &str = r#"use std
trackform bed { sleeper = sleepers.concrete, spacing = 0.6 m, layers = [ballasts.granite_31_63: 400 mm] }
track box { sections = [bed: 1 sleeper], bed_width = 2.6 m per track }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 20 Hz) per sleeper, total = 50 cycles }
record { quantities = ballast_stress, at = 1 sleeper, depth = 150 mm, after = [1, 50] cycles }
"#;

/// A jack on fixed sleepers.
const JACK: &str = r#"use std
trackform seats { rail = rails.UIC60, pad = pads.medium, spacing = 0.6 m, support = rigid }
track bench { sections = [seats: 20 sleepers] }
load jack { on = rail, at = 10 sleepers, force = 100 kN per rail }
"#;

fn compiled(text: &str, set: &[(&str, &str)]) -> Compiled {
    let set: Vec<Override> =
        set.iter().map(|(path, value)| Override { path: (*path).into(), value: (*value).into() }).collect();
    let compiled = compile("main.track", text, &NoModules, &set);
    assert!(compiled.scenario.is_some() && compiled.diagnostics.iter().all(|d| !d.is_error()), "{}", shown(&compiled));
    compiled
}

fn shown(compiled: &Compiled) -> String {
    trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120)
}

fn idle(compiled: &Compiled) -> Vec<&Diagnostic> {
    compiled.diagnostics.iter().filter(|d| d.code == Code::E0429).collect()
}

/// The messages about fields that do nothing.
fn told(text: &str, set: &[(&str, &str)]) -> Vec<String> {
    idle(&compiled(text, set)).into_iter().map(|d| d.message.clone()).collect()
}

fn solve(fields: &str) -> String {
    format!("{TRACK}solve {{ {fields} }}\n")
}

/// What a message goes on with where grains would have to lie under the track.
const UNDER_A_TRACK: &str = "where grains lie under a track: `substructure = cells`, `zone` or `full`";

#[test]
fn with_a_law_fields_of_grains_are_told_once_for_each_reason() {
    let text = solve(
        "substructure = law, coupling = monolithic, support_from = passage, soil_element = 0.2 m, tolerance = 2 %, \
         window = 0 .. 20 m, repeats = 3, symmetry = full, \
         update_every = 4 axles, time_step = 0.1 ms, elements_per_bay = 4",
    );
    let compiled = compiled(&text, &[]);
    let mut found: Vec<(String, usize)> = idle(&compiled).iter().map(|d| (d.message.clone(), d.labels.len())).collect();
    found.sort();
    let expected = [
        (format!("`coupling` acts only {UNDER_A_TRACK}"), 1),
        (
            "`repeats` and `symmetry` act only where grains are modelled: on a test rig, or with `substructure = cells`, `zone` or `full`"
                .to_owned(),
            2,
        ),
        ("`support_from`, `soil_element` and `window` act only where grains lie under bays of a track: `substructure = zone` or `full`".to_owned(), 3),
        ("`tolerance` acts only where trains run and `solve` does not state `update_every`, `time_step` or `elements_per_bay`, or where grains lie under some sleepers of a track: `substructure = cells` or `zone`".to_owned(), 1),
    ];
    assert_eq!(found, expected, "{}", shown(&compiled));
    assert!(idle(&compiled).iter().all(|d| !d.is_error()));
    let under = |d: &Diagnostic| d.labels.iter().map(|l| compiled.sources.text(l.span).to_owned()).collect::<Vec<_>>();
    let unread = idle(&compiled).into_iter().find(|d| d.labels.len() == 3).map(under);
    assert_eq!(unread.unwrap(), ["passage", "0.2 m", "0 .. 20 m"], "each field is pointed at");
}

#[test]
fn a_field_that_acts_is_not_told() {
    assert!(
        told(&solve("substructure = law, update_every = 4 axles, time_step = 1e-4 s, budget = 9 min"), &[]).is_empty()
    );
    assert!(
        told(&solve("substructure = full, window = 0 .. 20 m, symmetry = full, grain_step = 1e-6 s"), &[]).is_empty()
    );
    assert!(
        told(&solve("support_method = layered_elastic"), &[]).is_empty(),
        "layers give the pressure on the subgrade"
    );
    assert!(told(&format!("{RIG}solve {{ substructure = full, repeats = 3, symmetry = full }}"), &[]).is_empty());
    assert!(told(&format!("{JACK}solve {{ elements_per_bay = 8, beam = euler, gravity = 0 m/s^2 }}"), &[]).is_empty());
}

#[test]
fn what_only_trains_need_is_told_on_a_bench_and_on_a_rig() {
    let trains = "`law` acts only where trains run over supports that settle by a law";
    let run = "`update_every`, `integrator` and `time_step` act only where trains run";
    let fields = "law = laws.varandas_2014, update_every = 4 axles, integrator = newmark, time_step = 1e-4 s";
    assert_eq!(told(&format!("{JACK}solve {{ {fields} }}"), &[]), [trains, run]);
    let on_rails = "`elements_per_bay` acts only where there are rails";
    let of_rig = told(&format!("{RIG}solve {{ substructure = full, elements_per_bay = 2, {fields} }}"), &[]);
    assert_eq!(of_rig, [on_rails, trains, run]);
}

#[test]
fn a_layer_needs_its_support_method_only_where_layers_have_moduli() {
    let text = format!("{JACK}solve {{ support_method = layered_elastic }}");
    assert_eq!(
        told(&text, &[]),
        ["`support_method` acts only where sleepers of a track lie on layers of known moduli"]
    );
}

#[test]
fn a_data_sheet_may_say_more_than_a_plan_needs() {
    assert!(told(TRACK, &[]).is_empty(), "the grains of `stone` are as they are, whoever asks");
    let edited = told(TRACK, &[("stone.friction", "0.5"), ("stone.packing.lifts", "3")]);
    assert_eq!(edited.len(), 1, "an edit asks for a change: {edited:?}");
    assert!(edited[0].starts_with("`friction` and `lifts` act only where grains are modelled"), "{}", edited[0]);
    assert!(told(TRACK, &[("stone.youngs_modulus", "90 MPa")]).is_empty());
}

#[test]
fn what_no_run_reads_is_told_of_parts_too() {
    let glued = TRACK.replace(
        "friction = 0.7",
        "friction = 0.7, bond = { stiffness = 9 MN/m per contact, tensile_strength = 1 kN, shear_strength = 1 kN }",
    );
    assert!(told(&glued, &[]).is_empty(), "grains of this layer would be glued");
    let wagon = "vehicle wagon : vehicles.ore_wagon_20t { wheelset.rolling_inertia = 90 kg m^2 per wheelset }\ntrain ore { vehicles = wagon,";
    let rolling = TRACK.replace("train ore { vehicles = vehicles.ore_wagon_20t,", wagon);
    assert_eq!(told(&rolling, &[]), ["no run of this version reads `rolling_inertia` yet"]);
    let of_the_library =
        TRACK.replace("stone: 300 mm", "ballasts.bonded_granite: 300 mm").replace("granular stone", "granular other");
    assert!(told(&of_the_library, &[]).is_empty(), "only what the user's own texts state");
}

#[test]
fn an_edit_that_does_nothing_is_told() {
    let compiled = compiled(TRACK, &[("solve.cell_bays", "2"), ("solve.window", "0 .. 9 m")]);
    let names: Vec<&str> =
        idle(&compiled).iter().map(|d| compiled.sources.get(d.labels[0].span.file).name.as_str()).collect();
    assert_eq!(names, ["--set", "--set"], "{}", shown(&compiled));
}

#[test]
fn a_study_over_a_field_that_does_nothing_is_told_once() {
    let study = "study idle { vary = [solve.soil_element: [0.1, 0.2, 0.3] m, ore.speed: [100, 120] km/h], minimise = max(settlement) }";
    let text = format!("{TRACK}solve {{ substructure = law, window = 0 .. 20 m }}\n{study}\n");
    let base = compiled(&text, &[]);
    let scene = Scene { name: "main.track", text: &text, modules: &NoModules, set: &[] };
    let plan = plan(scene, &base, &base.studies[0]);
    let found: Vec<&Diagnostic> = plan.diagnostics.iter().filter(|d| d.code == Code::E0429).collect();
    // the window of the scene is told there
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].message.contains("`substructure = zone` or `full` (6 of 6 points"), "{found:?}");
    assert_eq!(base.sources.text(found[0].labels[0].span), "solve.soil_element");
}

#[test]
fn shipped_scenes_state_nothing_to_no_purpose() {
    let folders = ["scenarios", "scenarios/cookbook"].map(|folder| std::fs::read_dir(folder).unwrap());
    let paths = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    for path in paths.filter(|path| path.extension().is_some_and(|e| e == "track")) {
        let text = std::fs::read_to_string(&path).unwrap();
        let folder = Folder(path.parent().unwrap().into());
        let compiled = compile(&path.display().to_string(), &text, &folder, &[]);
        assert!(idle(&compiled).is_empty(), "{}:\n{}", path.display(), shown(&compiled));
    }
}

/// Every field that some part of the program says that it reads.
fn read_by_someone() -> BTreeSet<&'static str> {
    let compiled = compiled(JACK, &[]);
    let (scenario, graph) = (compiled.scenario.unwrap(), compiled.graph.unwrap());
    let readers = [check::readers(&scenario, &[]), Planner::default().readers(&scenario, None), lint::readers(&graph)];
    let fields = readers.into_iter().flatten().flat_map(|reader| reader.reads.fields);
    check::ALWAYS_READ.iter().chain(report::DRAWN).chain(fields).copied().collect()
}

#[test]
fn of_every_field_it_is_known_who_reads_it() {
    let read = read_by_someone();
    for (kind, field) in KINDS.iter().flat_map(|kind| kind.fields.iter().map(move |field| (kind, field))) {
        let path = format!("{}.{}", kind.name, field.name);
        let said = read.contains(path.as_str());
        assert!(
            said || field.unread,
            "`{path}`: name it where it is read (`Reads`, `check::ALWAYS_READ`), or mark it `unread`"
        );
        assert!(!(said && field.unread), "`{path}` is marked `unread`, and somebody reads it");
    }
}

#[test]
fn nobody_reads_a_field_that_there_is_not() {
    for path in read_by_someone() {
        let (of, field) = path.split_once('.').unwrap();
        assert!(kind(of).is_some_and(|kind| kind.fields.iter().any(|known| known.name == field)), "`{path}`");
    }
}

#[test]
fn the_former_name_of_the_size_of_soil_elements_is_told() {
    let text = solve("zone_size = 0.2 m");
    let compiled = compile("main.track", &text, &NoModules, &[]);
    let told = compiled.diagnostics.iter().find(|d| d.code == Code::E0402).expect("an unknown field");
    assert!(told.message.contains("zone_size"), "{}", told.message);
    assert!(shown(&compiled).contains("soil_element"), "{}", shown(&compiled));
}

#[test]
fn the_tolerance_of_a_study_acts_on_several_packings() {
    let study = |repeats: &str| {
        let vary = "vary = [solve.time_step: [0.1 ms, 0.2 ms]], report = max(settlement)";
        told(&format!("{}\nstudy steps {{ {vary}, {repeats}tolerance = 3 % }}\n", solve("substructure = law")), &[])
    };
    let found = study("");
    assert!(found.len() == 1 && found[0].contains("a point of the study has several `repeats`"), "{found:?}");
    assert!(study("repeats = 3, ").is_empty() && study("repeats = 2 .. 5, ").is_empty());
}
