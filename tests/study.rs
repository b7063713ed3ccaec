//! `trackbed chart` and `trackbed stability` from end to end, on a scene that passes in a moment.

use std::fs;
use std::path::{Path, PathBuf};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// 21 m of track under one wagon.
const SMALL: &str = r#"
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
solve { update_every = 8 axles, elements_per_bay = 2, time_step = 2e-4 s }
"#;

fn scene(dir: &Path, text: &str) -> PathBuf {
    let path = dir.join("small.track");
    fs::write(&path, text).unwrap();
    path
}

/// Rows of a table, each as its fields by name.
fn rows(path: &Path) -> Vec<std::collections::HashMap<String, String>> {
    csv::Reader::from_path(path).unwrap().deserialize().map(Result::unwrap).collect()
}

fn check_picture(path: &Path) -> String {
    let svg = fs::read_to_string(path).unwrap();
    roxmltree::Document::parse(&svg).unwrap();
    assert!(!svg.contains("NaN"));
    svg
}

#[test]
fn a_chart_sets_error_against_time() {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (scene(dir.path(), SMALL), dir.path().join("out"));
    let (file, out_text) = (file.to_str().unwrap(), out.to_str().unwrap());
    let output = trackbed(&["chart", file, "--after", "16", "--halvings", "2", "--out", out_text, "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));

    let rows = rows(&out.join("chart.csv"));
    let number = |row: &std::collections::HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    for row in rows.iter().filter(|r| r["sweep"] == "reference") {
        assert_eq!(number(row, "wheel_force_error"), 0.0);
        assert_eq!(number(row, "seat_load_error"), 0.0);
    }
    assert_eq!(rows.iter().filter(|r| r["sweep"] == "reference" && r["level"] == "settled").count(), 2);
    let own: Vec<_> = rows.iter().filter(|r| r["default"] == "yes" && r["level"] == "settled").collect();
    assert_eq!(own.len(), 1);
    assert_eq!((own[0]["integrator"].as_str(), own[0]["elements_per_bay"].as_str()), ("generalised_alpha(0.85)", "2"));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["axles"], 16);
    let orders = answer["orders"].as_array().unwrap();
    assert_eq!(orders.len(), 5);
    for order in orders {
        let smooth = order["released"].as_f64().unwrap();
        assert!((1.7..2.3).contains(&smooth), "{order}");
    }
    let picture = check_picture(&out.join("chart.svg"));
    assert!(picture.contains("numerics of the scene") && picture.contains("newmark"));
}

/// Steps that vary are set against even ones, whichever the scene has.
/// Whole runs against the finest of them. A second call runs nothing and says the same, and a count that differs is
/// another chart.
#[test]
fn a_chart_of_runs_compares_with_the_finest() {
    let dir = tempfile::tempdir().unwrap();
    // questions about counts that a shortened run never reaches
    let asks = "record track_response { at = [-1] sleepers, after = 40 axles, quantities = [rail_seat_load] }\n\
                expect { that = [max(settlement) < 1 um] }\n";
    let (file, out) = (scene(dir.path(), &format!("{SMALL}{asks}")), dir.path().join("out"));
    let arguments =
        ["chart", file.to_str().unwrap(), "--of", "run", "--out", out.to_str().unwrap(), "--format", "json"];
    let short = |axles: &str| trackbed(&[&arguments[..], &["--axles", axles]].concat());
    let output = short("16");
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&answer["axles"], &answer["reference"]), (&16.into(), &"fine".into()));
    assert_eq!(answer["shortened"], serde_json::json!(["16 axles instead of 40"]));

    let rows = rows(&out.join("chart.csv"));
    let error = |name: &str| {
        let row = rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(row["outcome"], "done");
        row["settlement_error"].parse::<f64>().unwrap()
    };
    // a tighter exchange is as near or nearer, and nearer than blocks of 8 axles; none has the bits of the reference
    assert!(0.0 < error("adaptive_0.001_mm") && error("adaptive_0.001_mm") <= error("adaptive_0.03_mm"));
    assert!(error("adaptive_0.03_mm") < error("scene") && error("scene") < 0.1);
    assert!(rows.iter().any(|row| row["efficient"] == "yes"));
    let picture = check_picture(&out.join("chart.svg"));
    assert!(picture.contains("adaptive_0.001_mm"));
    assert!(fs::read_to_string(out.join("chart.html")).unwrap().contains("solve.update_every = adaptive(0.001 mm)"));

    assert_eq!(short("16").stdout, output.stdout, "a run was computed again");
    let other = short("24");
    assert_eq!(other.status.code(), Some(1));
    assert!(said(&other).contains("E0809"), "{}", said(&other));

    // with a time that suffices for the reference at most, the table says what was left out
    let shorter = dir.path().join("shorter");
    let shorter =
        ["chart", file.to_str().unwrap(), "--of", "run", "--minutes", "0.001", "--out", shorter.to_str().unwrap()];
    let output = trackbed(&shorter);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("errors against `finer`") && text.contains("left out: about"), "{text}");
}

/// Every tier and exchange of a scene on grains is planned without running it; equal runs are planned once, and what
/// exceeds the time is left out.
#[test]
fn a_chart_of_grains_is_planned_within_its_time() {
    let dry = |minutes: &str| {
        let scene = "scenarios/transition_short.track";
        let output = trackbed(&["chart", scene, "--of", "run", "--dry-run", "--packings", "3", "--minutes", minutes]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        (String::from_utf8(output.stdout.clone()).unwrap(), said(&output))
    };
    let (whole, told) = dry("600");
    assert!(told.contains("20 axles instead of 40") && !told.contains("grains from"), "{told}");
    let line = |name: &str| whole.lines().find(|line| line.trim_start().starts_with(&format!("{name} ")));
    for name in [
        "full_monolithic",
        "scene",
        "law",
        "cells",
        "every_4",
        "alone",
        "cells_of_3",
        "packing_3",
        "grain_step_10_us",
        "grain_step_30_us",
        "half_the_dashpots",
        "dashpots_in_shear",
        "other_shape",
        "cells_at_1_percent",
    ] {
        let line = line(name).unwrap_or_else(|| panic!("no {name}: {whole}"));
        assert!(!line.contains("left out") && !line.contains("refused"), "{line}");
    }
    assert!(line("larger_grains").is_some_and(|line| line.contains("refused: layer `subballast`")), "{whole}");
    // the scene is `full` with blocks of 20 axles, its reference is `monolithic`, and its window is shorter than a zone
    for same in ["full", "monolithic", "every_20", "zone"] {
        assert!(line(same).is_none(), "{whole}");
    }
    let (_, told) = dry("10");
    assert!(told.contains("grains from"), "{told}");
}

#[test]
fn a_scene_of_varying_steps_is_charted_against_even_ones() {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (scene(dir.path(), SMALL), dir.path().join("out"));
    let adaptive = "solve.time_step=adaptive(2e-5)";
    let arguments = ["chart", file.to_str().unwrap(), "--after", "16", "--halvings", "1", "--set", adaptive];
    let output = trackbed(&[&arguments[..], &["--out", out.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let rows = rows(&out.join("chart.csv"));
    for row in &rows {
        assert_eq!(row["tolerance"].is_empty(), row["sweep"] != "tolerance", "{row:?}");
    }
    let own: Vec<_> = rows.iter().filter(|r| r["default"] == "yes").collect();
    assert_eq!(own.len(), 1);
    assert_eq!((own[0]["sweep"].as_str(), own[0]["tolerance"].parse()), ("tolerance", Ok(2e-5)));
    assert!(own[0]["wheel_force_error"].parse::<f64>().unwrap() < 0.02, "{:?}", own[0]);
}

#[test]
fn nothing_is_silently_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (scene(dir.path(), SMALL), dir.path().join("out"));
    let output = trackbed(&["stability", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let rows = rows(&out.join("stability.csv"));
    assert_eq!(rows.iter().filter(|r| r["trial"] == "map").count(), 5 * 4 * 4 * 7);
    assert!(rows.iter().filter(|r| r["trial"] != "map").count() > 30);
    for row in &rows {
        assert_ne!(row["verdict"], "wrong", "{row:?}");
        // what is not right has a code
        assert!(row["verdict"] == "stable" || row["code"].len() == 5, "{row:?}");
    }
    let ends = |trial: &str| rows.iter().find(|r| r["trial"] == trial).unwrap_or_else(|| panic!("no {trial}"));
    assert_eq!(ends("the scene as it is")["verdict"], "stable");
    assert_eq!(ends("a step of two elements' transit")["code"], "E0603");
    assert_eq!(ends("no gravity")["code"], "E0618");
    check_picture(&out.join("stability.svg"));
}

/// Arguments that would do nothing are refused.
#[test]
fn arguments_of_the_other_chart_are_refused() {
    let scene = "scenarios/transition.track";
    for (arguments, names) in [
        (["chart", scene, "--dry-run", "-q"].as_slice(), "need `--of run`"),
        (&["chart", scene, "--minutes", "5"], "need `--of run`"),
        (&["chart", scene, "--of", "run", "--dry-run", "--after", "0"], "`--after` is for a chart of a passage"),
        (&["stability", scene, "--of", "grains", "-q"], "has no grains under its track: leave out `--of grains`"),
    ] {
        let output = trackbed(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output).contains(names), "{}", said(&output));
    }
}

#[test]
fn a_study_needs_trains_and_known_counts() {
    let output = trackbed(&["chart", "scenarios/static_check.track"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("E0701"), "{}", said(&output));
    let output = trackbed(&["chart", "scenarios/static_check.track", "--of", "run", "--dry-run"]);
    assert!(said(&output).contains("E0701"), "{}", said(&output));

    let dir = tempfile::tempdir().unwrap();
    let file = scene(dir.path(), SMALL);
    let output = trackbed(&["chart", file.to_str().unwrap(), "--after", "12"]);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    assert!(text.contains("E0702") && text.contains("`--after 8` or `--after 16`"), "{text}");
}

#[test]
fn a_run_that_fails_names_the_block_of_the_scene() {
    let dir = tempfile::tempdir().unwrap();
    // a soft track, and a train that outruns its waves
    let text = SMALL
        .replace("50 MN/m per seat", "1 MN/m per seat")
        .replace("200 km/h", "450 km/h")
        .replace("open: 12 m, stiff: 9 m", "open: 36 m, stiff: 24 m")
        .replace("track_too_short: \"small\"", "critical_speed: \"small\"");
    let file = scene(dir.path(), &text);
    let out = dir.path().join("out");
    let output = trackbed(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    assert!(text.contains("E0703") && text.contains("at this speed") && text.contains("225 km/h"), "{text}");
    assert!(!out.join("summary.json").exists());
}

/// A support that is damped so much that it does not come back between two wheels: no shorter step helps.
#[test]
fn a_support_that_its_damper_holds_down_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL.replace(
        "stiffness = 50 MN/m per seat, damping_time = 1 ms",
        "stiffness = 1.9 MN/m per seat, damping = 3433 kN s/m per seat",
    );
    assert_ne!(text, SMALL);
    let file = scene(dir.path(), &text);
    let output = trackbed(&["run", file.to_str().unwrap(), "--out", dir.path().join("out").to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    assert!(
        text.contains("needs 1.81 s until its 1.9 MN/m spring has returned") && text.contains("damping_time = 1 ms"),
        "{text}"
    );
    assert!(!text.contains("write `time_step"), "{text}");
}
