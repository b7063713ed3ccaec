//! `trackbed compare` on directories that the program has written: runs, tests of rigs, studies, and what cannot be
//! compared.

use serde_json::Value;
use std::fs;
use std::path::Path;

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// 21 m of track under one wagon, and a study of its supports.
const TRACK: &str = r#"
use std
scenario { title = "small", allow = [stiffness_jump: "small", track_too_short: "small"] }
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 40 axles }
solve { update_every = 20 axles, elements_per_bay = 2, time_step = 2e-4 s }
study supports {
  vary = [open.support.stiffness: [40 MN/m per seat, 60 MN/m per seat]]
  minimise = max(settlement)
}
"#;

/// Coarse spheres under one sleeper, on two packings: packed and run in seconds.
const RIG: &str = r#"
use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 2 cycles }
solve { substructure = full, repeats = 2 }
"#;

/// Runs a command into a directory below the scene's.
fn made(directory: &Path, (command, text): (&str, &str), out: &str, more: &[&str]) -> String {
    let (scene, out) = (directory.join("scene.track"), directory.join(out).display().to_string());
    fs::write(&scene, text).unwrap();
    let cache = directory.join("cache").display().to_string();
    let output = trackbed(&[&[command, scene.to_str().unwrap(), "--out", &out, "--cache", &cache], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    out
}

fn compared(directories: &[&str], more: &[&str]) -> Value {
    let output = trackbed(&[&["compare"], directories, &["--format", "json"], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn named<'a>(all: &'a Value, name: &str) -> &'a Value {
    all["numbers"].as_array().unwrap().iter().find(|number| number["name"] == name).unwrap()
}

#[test]
fn runs_are_set_side_by_side() {
    let directory = tempfile::tempdir().unwrap();
    let soft = made(directory.path(), ("run", TRACK), "soft", &[]);
    let stiff = made(directory.path(), ("run", TRACK), "stiff", &["--set", "open.support.stiffness=80 MN/m per seat"]);
    let out = directory.path().join("both");
    let found = compared(&[&soft, &stiff], &["--out", out.to_str().unwrap()]);
    // what differs in the scenes is what was set, and nothing else
    let edits = serde_json::json!([
        { "path": "open.support.stiffness", "texts": ["50 MN/m per seat", "80 MN/m per seat"] }
    ]);
    assert_eq!(found["scenes"], edits);
    let summary: Value = serde_json::from_slice(&fs::read(Path::new(&stiff).join("summary.json")).unwrap()).unwrap();
    let values = &named(&found, "max_settlement")["values"];
    let (before, after) = (values[0]["value"].as_f64().unwrap(), values[1]["value"].as_f64().unwrap());
    assert_eq!(after, summary["max_settlement"]["value"].as_f64().unwrap());
    assert_eq!(values[1]["from_first"]["difference"].as_f64().unwrap(), after - before);
    let settled = found["seats"].as_array().unwrap().iter().find(|seat| seat["column"] == "settlement_m").unwrap();
    assert_eq!(settled["axles"], 40);
    let page = fs::read_to_string(out.join("compare.html")).unwrap();
    assert!(page.contains("Settlement along the track") && page.contains("80 MN/m per seat"));
    for table in ["numbers.csv", "seats.csv", "scenes.csv"] {
        let rows = csv::Reader::from_path(out.join(table)).unwrap().into_records().count();
        assert!(rows > 0, "{table}");
    }
    // once more into the same directory, and never over anything else
    compared(&[&stiff, &soft], &["--out", out.to_str().unwrap()]);
    let output = trackbed(&["compare", &soft, &stiff, "--out", &soft]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    // a run beside itself
    let output = trackbed(&["compare", &soft, &soft]);
    let said = said(&output);
    assert!(said.contains("the scenes are the same") && said.contains("nothing differs after 40 axles"), "{said}");
}

#[test]
fn what_was_run_is_kept_as_one_scene() {
    let directory = tempfile::tempdir().unwrap();
    let first = made(directory.path(), ("run", TRACK), "first", &["--set", "open.support.stiffness=80 MN/m per seat"]);
    let resolved = fs::read_to_string(Path::new(&first).join("resolved.track")).unwrap();
    let again = made(directory.path(), ("run", &resolved), "again", &[]);
    let table = |out: &str| fs::read_to_string(Path::new(out).join("sleepers.csv")).unwrap();
    assert_eq!(table(&first), table(&again));
}

#[test]
fn tests_on_the_same_beds_are_compared_bed_by_bed() {
    let directory = tempfile::tempdir().unwrap();
    let light = made(directory.path(), ("run", RIG), "light", &[]);
    let heavy = made(
        directory.path(),
        ("run", RIG),
        "heavy",
        &["--set", "actuator.force=cyclic(5 .. 90 kN, 40 Hz) per sleeper"],
    );
    let out = directory.path().join("both");
    let found = compared(&[&light, &heavy], &["--out", out.to_str().unwrap()]);
    assert_eq!(found["kind"], "tests of a rig");
    let settled = &named(&found, "max_settlement")["values"][1];
    assert_eq!(settled["from_first"]["pairs"], 2);
    assert!(settled["from_first"]["difference"].as_f64().unwrap() > 0.0);
    assert!(settled["from_first"]["confidence"].as_f64().unwrap() > 0.0);
    assert!(fs::read_to_string(out.join("compare.html")).unwrap().contains("Settlement against cycles"));
    // a rig is no track
    let track = made(directory.path(), ("run", TRACK), "track", &[]);
    let output = trackbed(&["compare", &light, &track]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("holds tests of a rig and"), "{}", said(&output));
}

#[test]
fn studies_are_compared_point_by_point() {
    let directory = tempfile::tempdir().unwrap();
    let slow = made(directory.path(), ("study", TRACK), "slow", &["--set", "ore.speed=100 km/h"]);
    let fast = made(directory.path(), ("study", TRACK), "fast", &[]);
    let out = directory.path().join("both");
    let found = compared(&[&slow, &fast], &["--out", out.to_str().unwrap()]);
    let points = found["points"].as_array().unwrap();
    let names: Vec<&str> = points.iter().map(|point| point["point"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 3, "{names:?}");
    assert_eq!(names[0], "the scene as it is");
    for point in points {
        let (before, after) = (point["values"][0].as_f64().unwrap(), point["values"][1].as_f64().unwrap());
        assert!(before > 0.0 && after != before);
        assert_eq!(point["from_first"][1]["difference"].as_f64().unwrap(), after - before);
    }
    assert_eq!(found["scenes"][0]["path"], "ore.speed");
    assert!(fs::read_to_string(out.join("compare.html")).unwrap().contains("max(settlement)"));
    assert!(out.join("points.csv").is_file());
}

#[test]
fn what_is_no_result_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let run = made(directory.path(), ("run", TRACK), "run", &[]);
    let output = trackbed(&["compare", &run]);
    assert_eq!(output.status.code(), Some(2));
    let nothing = directory.path().join("nothing").display().to_string();
    let output = trackbed(&["compare", &run, &nothing]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("holds no finished results"), "{}", said(&output));
    // a file that somebody has changed is no result
    let table = Path::new(&run).join("sleepers.csv");
    fs::write(&table, fs::read_to_string(&table).unwrap().replace("-1,", "-2,")).unwrap();
    let output = trackbed(&["compare", &run, &run]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("is damaged"), "{}", said(&output));
}
