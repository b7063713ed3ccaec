//! Settlement laws of trackforms and stretches.

use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::diag::Code;

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// Settlement grows with the number of axles; `slow` settles half as much under the same force, `fitted` is refused
/// beyond 80 kN.
const SCENE: &str = r#"use std
scenario { title = "laws", allow = [stiffness_jump: "small", track_too_short: "small", wheel_on_track: "small", critical_speed: "small"] }
law fast { form = power(a = 0.01 mm, reference_force = 60 kN per seat, m = 1, b = 1) }
law slow { form = power(a = 0.005 mm, reference_force = 60 kN per seat, m = 1, b = 1) }
law fitted : slow { loads = 0 .. 80 kN per seat, error = 5 % }
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
stretch treated { over = -8 .. -5 sleepers, law = slow }
track line { sections = [open: 18 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 40 axles }
solve { law = fast, update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s }
"#;

const TREATED: &str = "line { sections = [open: 18 m, stiff: 9 m], stretches = treated }";

fn treated() -> String {
    SCENE.replace("line { sections = [open: 18 m, stiff: 9 m] }", TREATED)
}

fn run(folder: &Path, name: &str, text: &str) -> (Vec<HashMap<String, String>>, Value) {
    let (file, out) = (folder.join(format!("{name}.track")), folder.join(name));
    fs::write(&file, text).unwrap();
    let run = trackbed(&["run", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(run.status.success(), "{}", said(&run));
    let rows = csv::Reader::from_path(out.join("sleepers.csv")).unwrap().deserialize().map(Result::unwrap).collect();
    (rows, serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap())
}

/// Settlement of a sleeper after all axles, mm.
fn settlement(rows: &[HashMap<String, String>], sleeper: &str) -> f64 {
    let row = rows.iter().rfind(|row| row["sleeper"] == sleeper && row["axles"] == "40").unwrap();
    1e3 * row["settlement_m"].parse::<f64>().unwrap()
}

fn mistakes(text: &str) -> Vec<(Code, String)> {
    let compiled = compile("laws.track", text, &NoModules, &[]);
    let errors = compiled.diagnostics.iter().filter(|d| d.is_error());
    errors.map(|d| (d.code, d.message.clone())).collect()
}

#[test]
fn sleepers_settle_by_the_law_of_their_stretch() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, _) = run(folder.path(), "plain", SCENE);
    let (mixed, _) = run(folder.path(), "mixed", &treated());
    // far from the stretch nothing changes, under it the settlement is a half but for the forces that follow
    let ratio = |sleeper: &str| settlement(&mixed, sleeper) / settlement(&plain, sleeper);
    assert!((ratio("-20") - 1.0).abs() < 0.02, "{}", ratio("-20"));
    for sleeper in ["-6", "-7"] {
        assert!((0.45..0.62).contains(&ratio(sleeper)), "{sleeper}: {}", ratio(sleeper));
    }
    let page = fs::read_to_string(folder.path().join("mixed/report.html")).unwrap();
    assert!(page.contains("Each sleeper settles by one of the laws"), "the page names the laws");
    let plan = trackbed(&["plan", folder.path().join("mixed.track").to_str().unwrap()]);
    assert!(said(&plan).contains("slow under 4 sleepers: power"), "{}", said(&plan));
}

#[test]
fn a_law_of_every_sleeper_is_the_law_of_solve() {
    let folder = tempfile::tempdir().unwrap();
    let by_solve = SCENE.replace("law = fast, update", "law = slow, update");
    let by_form = SCENE
        .replace("spacing = 0.6 m\n", "spacing = 0.6 m, law = slow\n")
        .replace("trackform stiff : open { sleeper = none,", "trackform stiff : open { sleeper = none, law = none,");
    // and with adaptive blocks, whose lengths follow from the laws
    for adaptive in [false, true] {
        let with = |text: &str| match adaptive {
            true => text.replace("update_every = 4 axles", "update_every = adaptive"),
            false => text.to_owned(),
        };
        let (one, _) = run(folder.path(), &format!("solve_{adaptive}"), &with(&by_solve));
        let (other, _) = run(folder.path(), &format!("form_{adaptive}"), &with(&by_form));
        assert_eq!(one, other);
    }
}

#[test]
fn tamping_begins_both_laws_again() {
    let folder = tempfile::tempdir().unwrap();
    let text = treated().replace("solve {", "tamping once { after = 20 axles, left = 10 % }\nsolve {");
    let (tamped, _) = run(folder.path(), "tamped", &text);
    let (mixed, _) = run(folder.path(), "mixed", &treated());
    // both laws begin again
    for sleeper in ["-20", "-6"] {
        assert!(settlement(&tamped, sleeper) < 0.9 * settlement(&mixed, sleeper), "{sleeper}");
    }
}

#[test]
fn each_law_is_held_to_its_own_range() {
    // the law of a few sleepers is asked only for what they carry
    let fitted = treated().replace("law = slow }", "law = fitted }");
    assert_eq!(mistakes(&fitted), []);
    let narrow = fitted.replace("0 .. 80 kN per seat", "0 .. 20 kN per seat");
    let found = mistakes(&narrow);
    assert!(matches!(&found[..], [(Code::L1004, message)] if message.contains("law `fitted`")), "{found:?}");
    // a law that no sleeper has is not asked
    let unused = SCENE.replace("law = fast, update", "law = slow, update");
    assert_eq!(mistakes(&unused), []);
    let slab = treated().replace("over = -8 .. -5", "over = 2 .. 4");
    let found = mistakes(&slab);
    assert!(matches!(&found[..], [(Code::E0418, _)]), "{found:?}");
}
