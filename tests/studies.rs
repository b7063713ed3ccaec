//! Studies: what is wrong with them is told before anything runs; they run, are killed, go on, and say which design is
//! best.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;
use trackbed::check::NoModules;
use trackbed::diag::{Code, Diagnostic};
use trackbed::store::Directory;
use trackbed::study::{Plan, PlannedPoint, Scene, plan, values};
use trackbed::{Compiled, compile};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// 21 m of track under one wagon.
const SMALL: &str = r#"use std
scenario { title = "small", allow = [stiffness_jump: "small", track_too_short: "small", critical_speed: "small", wheel_on_track: "small"] }
let ground = 50 MN/m per seat
let first = 0.1 N/mm^3
let last = 0.3 N/mm^3
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = ground, damping_time = 1 ms }
  usp = { bedding_modulus = ramp(first .. last) }
}
trackform stiff : open { sleeper = none, support = none, usp = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 8 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s, law = laws.varandas_2014 }
let dip = max(settlement) - mean(settlement, over = -12 .. -8 m)
"#;

fn with(study: &str) -> String {
    format!("{SMALL}{study}\n")
}

fn compiled(text: &str) -> Compiled {
    compile("small.track", text, &NoModules, &[])
}

/// The one mistake of a study: its code, the text under it and its message with the help.
fn mistake(study: &str) -> (Code, String, String) {
    let compiled = compiled(&with(study));
    let [only] = compiled.diagnostics.as_slice() else { panic!("{study}\n{:#?}", compiled.diagnostics) };
    told(only, &compiled)
}

fn told(diagnostic: &Diagnostic, compiled: &Compiled) -> (Code, String, String) {
    let under = compiled.sources.text(diagnostic.labels[0].span).to_string();
    (diagnostic.code, under, format!("{}; {}", diagnostic.message, diagnostic.help.clone().unwrap_or_default()))
}

fn planned(study: &str) -> (Plan, Compiled) {
    let text = with(study);
    let compiled = compiled(&text);
    assert!(compiled.diagnostics.is_empty(), "{:#?}", compiled.diagnostics);
    let scene = Scene { name: "small.track", text: &text, modules: &NoModules, set: &[] };
    (plan(scene, &compiled, &compiled.studies[0]), compiled)
}

/// The points of the design, in its order; the scene as it is may be one of them.
fn designed(plan: &Plan) -> Vec<&PlannedPoint> {
    let mut points: Vec<&PlannedPoint> = plan.points.iter().filter(|p| p.number > 0).collect();
    points.sort_by_key(|p| p.number);
    points
}

fn designs(plan: &Plan) -> Vec<String> {
    designed(plan).iter().map(|p| values(&plan.study, &p.levels)).collect()
}

#[test]
fn every_form_of_values_is_read() {
    for (vary, points) in [
        ("ground: [20, 40.5] MN/m per seat", vec!["ground = 20 MN/m per seat", "ground = 40.5 MN/m per seat"]),
        (
            "ground: steps(20 .. 40 MN/m, by = 10 MN/m) per seat",
            vec!["ground = 20 MN/m per seat", "ground = 30 MN/m per seat", "ground = 40 MN/m per seat"],
        ),
        ("ore.speed: steps(110 .. 140 km/h, count = 2)", vec!["ore.speed = 110 km/h", "ore.speed = 140 km/h"]),
        (
            "stiff.pad: [pads.soft, pads.soft { stiffness = 70 MN/m }]",
            vec!["stiff.pad = pads.soft", "stiff.pad = pads.soft { stiffness = 70 MN/m }"],
        ),
        ("ore.direction: [forward, backward]", vec!["ore.direction = forward", "ore.direction = backward"]),
        ("line.sections.open: [12, 12.6] m", vec!["line.sections.open = 12 m", "line.sections.open = 12.6 m"]),
        (
            "open.usp.bedding_modulus: [ramp(first .. last), smooth(first .. last)]",
            vec!["open.usp.bedding_modulus = ramp(first .. last)", "open.usp.bedding_modulus = smooth(first .. last)"],
        ),
        (
            "solve.elements_per_bay: [1, 2], ore.direction: [forward, backward]",
            vec![
                "solve.elements_per_bay = 1, ore.direction = forward",
                "solve.elements_per_bay = 1, ore.direction = backward",
                "solve.elements_per_bay = 2, ore.direction = forward",
                "solve.elements_per_bay = 2, ore.direction = backward",
            ],
        ),
    ] {
        let (plan, _) = planned(&format!("study s {{ vary = [{vary}], minimise = dip }}"));
        assert!(plan.diagnostics.is_empty(), "{vary}: {:#?}", plan.diagnostics);
        assert_eq!(designs(&plan), points);
        assert!(plan.seconds()[0] > 0.0);
    }
}

#[test]
fn samples_lie_where_they_are_asked_for() {
    for sampling in ["sobol(16)", "latin_hypercube(16)"] {
        let study = format!(
            "study s {{ vary = [ground: log_normal(50 MN/m, cov = 20 %) per seat, ore.speed: 110 .. 180 km/h], \
             sampling = {sampling}, minimise = dip }}"
        );
        let (plan, _) = planned(&study);
        assert!(plan.diagnostics.is_empty(), "{:#?}", plan.diagnostics);
        let numbers = |axis: usize| designed(&plan).iter().map(|p| p.levels[axis].number.unwrap()).collect::<Vec<_>>();
        let below = numbers(0).iter().filter(|x| **x < 50.0).count();
        assert_eq!(below, 8, "half of the points lie below the median");
        let slow = numbers(1).iter().filter(|x| (110.0..145.0).contains(*x)).count();
        assert_eq!(slow, 8);
        assert!(numbers(1).iter().all(|x| (110.0..=180.0).contains(x)));
        assert_eq!(designs(&plan), designs(&planned(&study).0));
    }
}

#[test]
fn mistakes_of_a_study_are_told_at_their_place() {
    let near = |study: &str, code: Code, under: &str, says: &str| {
        let (found, place, message) = mistake(study);
        assert_eq!((found, place.as_str()), (code, under), "{study}: {message}");
        assert!(message.contains(says), "{study}: {message}");
    };
    let vary = |vary: &str| format!("study s {{ vary = [{vary}], minimise = dip }}");
    near(&vary("opn.spacing: [0.6, 0.65] m"), Code::E0704, "opn", "did you mean `open`");
    near(&vary("open.pad.stifness: [20, 40] MN/m"), Code::E0704, "stifness", "did you mean `stiffness`");
    near(&vary("pads.soft.stiffness: [20, 40] MN/m"), Code::E0704, "pads", "is a module");
    near(&vary("open: [stiff]"), Code::E0704, "open", "such as `open.spacing`");
    near(&vary("open.pad.stiffness: [20] kN"), Code::E0302, "20", "a stiffness in `MN/m`");
    near(&vary("open.pad.stiffness: [20, 4000] MN/m"), Code::E0405, "4000", "5 .. 3000");
    near(&vary("ground: [20] kN per seat"), Code::E0302, "20", "expected a stiffness");
    near(&vary("open.pad.stiffness: 40 MN/m"), Code::E0406, "40 MN/m", "expected a list");
    near(&vary("open.pad.stiffness: 60 .. 40 MN/m"), Code::E0505, "60 .. 40 MN/m", "ascend");
    near(&vary("open.pad.stiffness: 20 .. 40 MN/m"), Code::E0706, "open.pad.stiffness", "a grid needs");
    near(&vary("ore.speed: steps(60 .. 90 km/h, by = 20 km/h)"), Code::E0706, "20 km/h", "1.5 steps");
    near(&vary("ore.speed: steps(60 .. 90 km/h)"), Code::E0406, "steps", "count = 4");
    near(&vary("open.pad: [pads.soft], open.pad.stiffness: [20] MN/m"), Code::E0707, "open.pad.stiffness", "overlap");
    near(&vary("ore.direction: [forward, sideways]"), Code::E0408, "sideways", "expected");
    near("study s { vary = [ore.speed: [60, 90] km/h] }", Code::E0403, "study s", "has no objective and no report");
    near("study s { minimise = dip }", Code::E0403, "study s", "needs `vary`");
    near(
        "study s { vary = [ore.speed: [60] km/h], minimise = max(setlement) }",
        Code::E0408,
        "setlement",
        "settlement",
    );
    let wrong = "study s { vary = [ore.speed: [60] km/h], minimise = dip, subject_to = dip < 3 kN }";
    near(wrong, Code::E0305, "3 kN", "same dimension");
    let wrong = "study s { vary = [ore.speed: [60] km/h], minimise = max(settlement) - max(contact_force) }";
    near(wrong, Code::E0305, "max(settlement)", "same dimension");
}

#[test]
fn illegal_points_are_told_once_with_the_first() {
    let (plan, compiled) = planned(
        "study s { vary = [solve.time_step: [1e-4, 2e-4, 6e-3, 8e-3] s, ore.direction: [forward, backward]], minimise = dip }",
    );
    let told: Vec<_> = plan.diagnostics.iter().map(|d| told(d, &compiled)).collect();
    assert_eq!(told.len(), 2, "{told:#?}");
    for ((code, under, message), value) in told.iter().zip(["6e-3", "8e-3"]) {
        assert_eq!((*code, under.as_str()), (Code::E0705, value));
        assert!(message.contains("2 of 8 points of study `s` cannot run") && message.contains("E0603"), "{message}");
        assert!(message.contains(&format!("solve.time_step = {value} s, ore.direction = forward")), "{message}");
    }
}

#[test]
fn repeats_change_the_seed_whatever_its_solve_is_called() {
    let study = "study s { vary = [ore.direction: [forward, backward]], minimise = dip, repeats = 3 }";
    let (plan, _) = planned(study);
    assert!(plan.diagnostics.is_empty(), "{:#?}", plan.diagnostics);
    let once = planned(&study.replace(", repeats = 3", "")).0;
    assert!((plan.seconds()[1] / once.seconds()[1] - 3.0).abs() < 1e-9);
    let text = with(study).replace("solve {", "solve mine {");
    let compiled = compiled(&text);
    let scene = Scene { name: "small.track", text: &text, modules: &NoModules, set: &[] };
    let found = trackbed::study::plan(scene, &compiled, &compiled.studies[0]).diagnostics;
    assert!(found.is_empty(), "{found:#?}");
}

/// What no run keeps is asked for in vain, and that is known before the first one.
#[test]
fn responses_that_are_not_kept_are_told_before_a_run() {
    let (plan, _) = planned(
        "study s { vary = [ore.direction: [forward, backward]], minimise = max(ballast_velocity), report = dip }",
    );
    let [only] = plan.diagnostics.as_slice() else { panic!("{:#?}", plan.diagnostics) };
    assert_eq!(only.code, Code::E0705);
    assert!(only.message.contains("2 of 2 points") && only.message.contains("`ballast_velocity`"), "{}", only.message);
}

#[test]
fn a_condition_leaves_points_out() {
    let study = "study s { vary = [first: 0.1 .. 0.3 N/mm^3, last: 0.1 .. 0.3 N/mm^3], sampling = sobol(16), \
                 minimise = dip, subject_to = [first <= last, dip < 3 mm] }";
    let (plan, _) = planned(study);
    assert!(plan.diagnostics.is_empty(), "{:#?}", plan.diagnostics);
    assert_eq!(plan.designs() + plan.left_out, 16);
    assert!((6..=10).contains(&plan.left_out), "{} left out", plan.left_out);
    assert!(designed(&plan).iter().all(|p| p.levels[0].number <= p.levels[1].number));
}

fn write(dir: &Path, text: &str) -> PathBuf {
    let path = dir.join("small.track");
    fs::write(&path, text).unwrap();
    path
}

fn rows(out: &Path) -> Vec<HashMap<String, String>> {
    csv::Reader::from_path(out.join("study.csv")).unwrap().deserialize().map(Result::unwrap).collect()
}

/// The row of a point.
fn point<'a>(rows: &'a [HashMap<String, String>], number: &str) -> &'a HashMap<String, String> {
    rows.iter().find(|row| row["point"] == number).unwrap()
}

fn found(out: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(out.join("study.json")).unwrap()).unwrap()
}

const PADS: &str = "study slab_pads {
  vary = [stiff.pad.stiffness: [20, 40, 80] MN/m, ore.direction: [forward, backward]]
  minimise = [dip, max(rail_seat_load)], report = max(wheel_force), subject_to = max(rail_seat_load) < 200 kN per seat
}";

#[test]
fn a_study_runs_and_names_its_best_designs() {
    let dir = tempfile::tempdir().unwrap();
    let file = write(dir.path(), &with(PADS));
    let run = |name: &str, jobs: &str| {
        let out = dir.path().join(name);
        let output = trackbed(&["study", file.to_str().unwrap(), "--out", out.to_str().unwrap(), "--jobs", jobs]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        (out, said(&output))
    };
    let ((one, text), (two, _)) = (run("one", "1"), run("two", "2"));
    for name in ["study.csv", "study.json", "study.html", "design.json"] {
        assert!(fs::read(one.join(name)).unwrap() == fs::read(two.join(name)).unwrap(), "{name}");
    }
    assert!(
        text.contains("6 points, number 3 of them the scene as it is") && text.contains("stiff.pad.stiffness [MN/m]"),
        "{text}"
    );
    let rows = rows(&one);
    assert_eq!(rows.len(), 6);
    assert_eq!((rows[0]["point"].as_str(), rows[0]["as_it_is"].as_str()), ("3", "yes"));
    let number = |row: &HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    for row in &rows {
        assert_eq!((row["status"].as_str(), row["constraints_met"].as_str()), ("done", "yes"));
        assert_eq!(row["max(rail_seat_load) < 200 kN per seat missed by [kN]"], "0");
        assert!(number(row, "dip [mm]") > 0.0 && number(row, "max(wheel_force) [kN]") > 90.0);
        let beaten = rows.iter().any(|other| {
            let less = |name: &str| number(other, name) < number(row, name);
            less("dip [mm]") && less("max(rail_seat_load) [kN]")
        });
        assert!(!(beaten && row["best"] == "yes"), "{row:?}");
    }
    let found = found(&one);
    let best = rows.iter().filter(|r| r["best"] == "yes").count();
    assert_eq!(found["best"].as_array().unwrap().len(), best);
    assert_eq!(found["provenance"]["file"], "small.track");
    let page = fs::read_to_string(one.join("study.html")).unwrap();
    // the script at the end of the page knows the word
    let shown = page.split("<script").next().unwrap();
    assert!(shown.contains("Pareto front") && shown.contains("Main effects") && !shown.contains("NaN"));
    for svg in page.split("<svg").skip(1) {
        let svg = format!("<svg{}</svg>", svg.split("</svg>").next().unwrap());
        roxmltree::Document::parse(&svg).unwrap();
    }
    // a point is the scene with those lines edited
    let point = dir.path().join("point");
    let set = ["stiff.pad.stiffness=20 MN/m", "ore.direction=backward"];
    let arguments = ["run", file.to_str().unwrap(), "--out", point.to_str().unwrap(), "--set", set[0], "--set", set[1]];
    assert_eq!(trackbed(&arguments).status.code(), Some(0));
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(point.join("summary.json")).unwrap()).unwrap();
    assert_eq!(
        summary["max_wheel_force"]["value"].as_f64().unwrap() / 1e3,
        number(self::point(&rows, "2"), "max(wheel_force) [kN]")
    );
}

/// What varies, and what the scene as it is has there.
#[test]
fn the_scene_as_it_is_stands_beside_the_points() {
    let speeds = |list: &str| planned(&format!("study s {{ vary = [ore.speed: {list}], minimise = dip }}")).0;
    let beside = speeds("[120, 150] km/h");
    assert!(beside.diagnostics.is_empty(), "{:#?}", beside.diagnostics);
    let first = &beside.points[0];
    assert_eq!((first.number, first.as_it_is, beside.designs(), beside.points.len()), (0, true, 2, 3));
    assert_eq!((first.levels[0].text.as_str(), first.levels[0].number), ("200 km/h", Some(200.0)));
    assert!(first.overrides.is_empty() && first.seconds > 0.0);
    let all: f64 = beside.points.iter().map(|p| p.seconds).sum();
    assert!((beside.seconds()[0] / all - 1.0).abs() < 1e-12, "it counts in the estimate");
    // a point that is the same takes its place, however it is written
    for same in ["[120, 200] km/h", "[120, 0.2e3] km/h"] {
        let (plan, numbers) = (speeds(same), |plan: &Plan| plan.points.iter().map(|p| p.number).collect::<Vec<_>>());
        assert_eq!(numbers(&plan), [2, 1], "{same}");
        assert!(plan.points[0].as_it_is && !plan.points[1].as_it_is);
    }
    // what a study sets is set there too
    let (set, _) =
        planned("study s { vary = [ore.speed: [120] km/h], set = [ground: 40 MN/m per seat], minimise = dip }");
    assert_eq!(set.points[0].overrides[0].path, "ground");
    // what is measured elsewhere is another point, though the track is the same
    let text = with(
        "let reach = 8 m\nstudy s { vary = [reach: [6, 8] m], minimise = mean(settlement, over = -reach .. -1 m) }",
    );
    let compiled = compiled(&text);
    let scene = Scene { name: "small.track", text: &text, modules: &NoModules, set: &[] };
    let reach = plan(scene, &compiled, &compiled.studies[0]);
    assert_eq!(reach.points.iter().map(|p| p.number).collect::<Vec<_>>(), [2, 1]);
}

/// What stands there where a study varies: words of libraries, nothing at all, arguments, pairs and lists.
#[test]
fn the_values_of_the_scene_as_it_is_are_told_as_written() {
    for (vary, text, number) in [
        ("ground: [20] MN/m per seat", "50 MN/m per seat", Some(50.0)),
        ("ground: [40] MN/m per sleeper", "50 MN/m per seat", None),
        ("open.pad: [pads.soft, none]", "pads.ahmadi_2026", None),
        ("stiff.pad.stiffness: [20] MN/m", "40 MN/m", Some(40.0)),
        ("stiff.usp: [none]", "none", None),
        ("line.sections.open: [12.6] m", "12 m", Some(12.0)),
        ("line.stretches: [[]]", "none", None),
        ("line.rail_ends: [pinned]", "clamped", None),
        ("open.auxiliary_rails: [none]", "none", None),
    ] {
        let (plan, _) = planned(&format!("study s {{ vary = [{vary}], minimise = dip }}"));
        let level = &plan.study.axes[0].written.clone().unwrap();
        assert_eq!((level.text.as_str(), level.number), (text, number), "{vary}");
    }
}

/// Pads under sleepers, with and without: `none` is a value like any other, and here it is the scene as it is.
#[test]
fn pads_are_compared_with_none() {
    let dir = tempfile::tempdir().unwrap();
    let study = "study pads_or_not { vary = [open.usp: [none, usps.soft, usps.stiff]], minimise = max(settlement), \
                 report = [max(void), max(rail_seat_load)] }";
    let file = write(dir.path(), &with(study).replace("  usp = { bedding_modulus = ramp(first .. last) }\n", ""));
    let out = dir.path().join("out");
    let output = trackbed(&["study", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    let told = said(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    let rows = rows(&out);
    let first = &rows[0];
    assert_eq!((first["point"].as_str(), first["as_it_is"].as_str(), first["open.usp"].as_str()), ("1", "yes", "none"));
    assert!(first["max(settlement) difference [mm]"].is_empty(), "{first:?}");
    let number = |row: &HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    for row in &rows[1..] {
        let (value, before) = (number(row, "max(settlement) [mm]"), number(first, "max(settlement) [mm]"));
        let difference = number(row, "max(settlement) difference [mm]");
        assert!((value - before - difference).abs() < 1e-12, "{row:?}");
        // the terminal says the same as a share
        let share = 100.0 * difference / before;
        let share = if share.abs() < 10.0 { format!("{share:+.1e}") } else { format!("{share:+.0}") };
        let shown = told.contains(&format!("({:+} %)", share.parse::<f64>().unwrap()));
        assert!(shown, "{share} % in\n{told}");
    }
    let lines: Vec<&str> = told.lines().collect();
    let head = lines.iter().position(|line| line.trim_start().starts_with("point ")).unwrap();
    assert!(lines[head + 1].trim_start().starts_with("as it is  none"), "{told}");
    let page = fs::read_to_string(out.join("study.html")).unwrap();
    assert!(page.contains("<b>as it is</b> <small>point 1</small></td><td>none</td>"), "{page}");
    assert!(page.contains("Dashed: the scene as it is.") && page.contains(">none</text>"));
    assert_eq!(found(&out)["as_it_is"]["point"], 1);
}

/// Where no design is feasible the misses are told, the nearest is named, and the exit code is 1.
#[test]
fn a_study_without_a_feasible_design_names_the_nearest() {
    let dir = tempfile::tempdir().unwrap();
    let study = |limit: &str| {
        format!(
            "study s {{ vary = [ground: [30, 40, 80] MN/m per seat], minimise = max(settlement), \
             subject_to = [max(rail_displacement) < {limit}, max(rail_seat_load) < 200 kN per seat] }}"
        )
    };
    let run = |name: &str, limit: &str| {
        let file = write(dir.path(), &with(&study(limit)));
        let out = dir.path().join(name);
        let output = trackbed(&["study", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        (output.status.code(), said(&output), out)
    };
    let (code, told, out) = run("none", "0.2 mm");
    assert_eq!(code, Some(1), "{told}");
    for words in [
        "E0711",
        "no design of study `s` meets every constraint",
        "missed by 3 of 3 designs, by",
        "the nearest is point 3",
    ] {
        assert!(told.contains(words), "{words} in\n{told}");
    }
    let missed = "max(rail_displacement) < 0.2 mm missed by [mm]";
    let rows = rows(&out);
    assert!(rows.iter().all(|row| row["constraints_met"] == "no" && row["best"] == "no"));
    let misses: Vec<f64> = ["1", "2", "3"].map(|number| point(&rows, number)[missed].parse().unwrap()).to_vec();
    assert!(misses[0] > misses[1] && misses[1] > misses[2] && misses[2] > 0.0, "{misses:?}");
    assert!(rows.iter().all(|row| row["max(rail_seat_load) < 200 kN per seat missed by [kN]"] == "0"));
    let found = found(&out);
    assert_eq!((found["nearest"]["point"].as_u64(), found["best"].as_array().unwrap().len()), (Some(3), 0));
    let share = found["nearest"]["missed"][0]["share"].as_f64().unwrap();
    assert!((share - misses[2] / 0.2).abs() < 1e-9, "{share}");
    assert_eq!(found["constraints"][0]["missed_by"], 3);
    let page = fs::read_to_string(out.join("study.html")).unwrap();
    assert!(page.contains("No design meets every constraint") && page.contains("Point 3 comes nearest"), "{page}");
    // one that some meet is told and is no error
    let (code, told, _) = run("some", &format!("{} mm", 0.2 + 0.5 * (misses[1] + misses[2])));
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("is missed by 2 of 3 designs") && told.contains("best: point 3"), "{told}");
}

/// A study that an older version finished has neither the scene as it is nor by how much its constraints are missed.
#[test]
fn what_an_older_version_left_out_runs_when_its_study_is_resumed() {
    let dir = tempfile::tempdir().unwrap();
    let text = PADS.replace("[20, 40, 80] MN/m", "[20, 80] MN/m");
    let file = write(dir.path(), &with(&text));
    let out = dir.path().join("out");
    let run = |more: &[&str]| {
        let output = trackbed(&[&["study", file.to_str().unwrap(), "--out", out.to_str().unwrap()][..], more].concat());
        (output.status.code(), said(&output))
    };
    assert_eq!(run(&[]).0, Some(0));
    let table = fs::read_to_string(out.join("study.csv")).unwrap();
    let mut points: serde_json::Value = serde_json::from_slice(&fs::read(out.join("points.json")).unwrap()).unwrap();
    let design: serde_json::Value = serde_json::from_slice(&fs::read(out.join("design.json")).unwrap()).unwrap();
    let as_it_is = design["points"][0]["sha256"].as_str().unwrap();
    let runs = points.as_object_mut().unwrap();
    runs.remove(as_it_is).unwrap();
    let old = runs.values_mut().next().unwrap()[0]["done"].as_object_mut().unwrap();
    old.remove("misses");
    old.insert("met".into(), serde_json::json!([true]));
    let bytes = serde_json::to_vec(&points).unwrap();
    let mut directory = Directory::amend(&out).unwrap();
    directory.stage("points.json", &bytes).unwrap();
    directory.commit().unwrap();
    let (code, told) = run(&["--resume"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("by a version that kept less: 2 of 5 points run"), "{told}");
    assert_eq!(fs::read_to_string(out.join("study.csv")).unwrap(), table);
    let (_, told) = run(&["--resume"]);
    assert!(told.contains("nothing is run"), "{told}");
}

#[test]
fn a_killed_study_goes_on_to_the_same_answer() {
    let dir = tempfile::tempdir().unwrap();
    let file = write(dir.path(), &with(PADS));
    let (whole, cut) = (dir.path().join("whole"), dir.path().join("cut"));
    let arguments =
        |out: &Path| ["study", file.to_str().unwrap(), "--jobs", "1", "--out", out.to_str().unwrap()].map(String::from);
    let run = |out: &Path, more: &[&str]| {
        let arguments = arguments(out);
        let all: Vec<&str> = arguments.iter().map(String::as_str).chain(more.iter().copied()).collect();
        trackbed(&all)
    };
    assert_eq!(run(&whole, &[]).status.code(), Some(0));

    let kept = || pieces(&cut).len();
    // on a busy machine it may end before it is killed
    while kept() == 0 {
        let _ = fs::remove_dir_all(&cut);
        let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"))
            .args(arguments(&cut))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while kept() < 2 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    // without `--resume` what is there is not touched, and another scene does not take it up
    let output = run(&cut, &[]);
    assert!(output.status.code() == Some(1) && said(&output).contains("E0802"), "{}", said(&output));
    let output = run(&cut, &["--resume", "--set", "ore.speed=190 km/h"]);
    assert!(output.status.code() == Some(1) && said(&output).contains("E0809"), "{}", said(&output));
    // a point whose file is damaged runs again, and no other
    let damaged = pieces(&cut).remove(0);
    let mut bytes = fs::read(&damaged).unwrap();
    let last = bytes.len() - 4;
    bytes[last] ^= 1;
    fs::write(&damaged, bytes).unwrap();
    let output = run(&cut, &["--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(said(&output).matches("runs again").count(), 1, "{}", said(&output));
    for name in ["study.csv", "study.json", "study.html", "design.json", "points.json", "manifest.json"] {
        assert!(fs::read(whole.join(name)).unwrap() == fs::read(cut.join(name)).unwrap(), "{name}");
    }
}

/// Ctrl-C in a terminal, SIGTERM of a scheduler.
#[cfg(unix)]
#[test]
fn a_study_that_is_asked_to_stop_says_how_to_go_on() {
    let dir = tempfile::tempdir().unwrap();
    // a thousand axles a point: it is in the middle of one when the signal comes
    let file = write(dir.path(), &with(PADS).replace("8 axles", "1000 axles"));
    let out = dir.path().join("out");
    let mut study = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    study.args(["study", file.to_str().unwrap(), "--jobs", "1", "--out", out.to_str().unwrap()]);
    for signal in ["-INT", "-TERM"] {
        let before = pieces(&out).len();
        let mut child = study.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        while pieces(&out).len() == before {
            assert!(child.try_wait().unwrap().is_none(), "it ended before a point was kept");
            std::thread::sleep(Duration::from_millis(2));
        }
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "it ends by itself: {said}");
        let kept = format!("stopped: {} of 6 points are kept in `{}`", pieces(&out).len(), out.display());
        assert!(said.contains(&kept) && said.contains("run the same command with `--resume`"), "{said}");
        assert!(!out.join("study.csv").exists());
        study.arg("--resume");
    }
}

/// Files of points that an unfinished study has kept.
fn pieces(out: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(out.join(".trackbed/pieces")).map(|entries| entries.flatten().map(|e| e.path()));
    let mut kept: Vec<PathBuf> =
        entries.map_or_else(|_| Vec::new(), |paths| paths.filter(|path| path.extension().is_none()).collect());
    kept.sort();
    kept
}

#[test]
fn a_point_that_fails_is_kept_and_stops_nothing() {
    let dir = tempfile::tempdir().unwrap();
    // a soft track, and a train that outruns its waves
    let text = with(
        "study speeds { vary = [ore.speed: [100, 450, 120] km/h], set = [ground: 1 MN/m per seat, open.usp: none], \
         minimise = max(wheel_force) }",
    )
    .replace("open: 12 m, stiff: 9 m", "open: 36 m, stiff: 24 m")
    .replace(", track_too_short: \"small\"", "");
    let file = write(dir.path(), &text);
    let out = dir.path().join("out");
    let output = trackbed(&["study", file.to_str().unwrap(), "speeds", "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("E0808") && said(&output).contains("point 2"), "{}", said(&output));
    let rows = rows(&out);
    let status: Vec<&str> = ["1", "2", "3"].iter().map(|number| point(&rows, number)["status"].as_str()).collect();
    assert_eq!(status, ["done", "failed", "done"]);
    let failed = point(&rows, "2");
    assert!(failed["reason"].contains("wheel") && failed["max(wheel_force) [kN]"].is_empty(), "{failed:?}");
    assert_eq!(rows.iter().filter(|r| r["best"] == "yes").count(), 1);
}

#[test]
fn a_study_is_chosen_by_its_name() {
    let dir = tempfile::tempdir().unwrap();
    let file =
        write(dir.path(), &with(&format!("{PADS}\nstudy speeds {{ vary = [ore.speed: [120] km/h], report = dip }}")));
    let out = dir.path().join("out");
    let run = |more: &[&str]| {
        let arguments = [&["study", file.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat();
        let output = trackbed(&arguments);
        (output.status.code(), said(&output))
    };
    let (code, text) = run(&[]);
    assert!(code == Some(2) && text.contains("name `slab_pads` or `speeds`"), "{text}");
    let (code, text) = run(&["speed"]);
    assert!(code == Some(2) && text.contains("did you mean `speeds`"), "{text}");
    assert!(!out.exists());
    let (code, text) = run(&["speeds"]);
    assert_eq!(code, Some(0), "{text}");
}

/// `check` looks at every point of the shipped studies.
#[test]
fn the_shipped_studies_are_without_a_mistake() {
    for name in [
        "study_speed",
        "study_pads",
        "study_support",
        "study_usp",
        "study_spacing",
        "study_wedge",
        "study_mitigations",
        "study_density",
    ] {
        let file = format!("scenarios/{name}.track");
        let output = trackbed(&["check", &file]);
        assert_eq!((output.status.code(), said(&output)), (Some(0), format!("{file}: no errors\n")));
    }
}
