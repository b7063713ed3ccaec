//! The notebooks of `examples/notebook` read what a run and a bed leave. They need Python with what `requirements.txt`
//! there names: `.ci/run` puts it into `target/notebook`. Where it is missing the tests say so and run nothing.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// A Python that has what the notebooks import, or a word that there is none.
fn python() -> Option<PathBuf> {
    let known = [Path::new(env!("CARGO_MANIFEST_DIR")).join("target/notebook/bin/python"), PathBuf::from("python3")];
    let imports = ["-c", "import matplotlib, pandas, polars, pyarrow, pyvista"];
    let has_all =
        |python: &PathBuf| Command::new(python).args(imports).output().is_ok_and(|output| output.status.success());
    let found = known.into_iter().find(has_all);
    if found.is_none() {
        println!("skipped: there is no Python with the packages of examples/notebook/requirements.txt");
    }
    found
}

/// Runs a notebook as a program.
fn notebook(python: &Path, name: &str, arguments: &[&Path]) -> Output {
    let mut command = Command::new(python);
    command.arg(Path::new("examples/notebook").join(name)).args(arguments).output().unwrap()
}

fn fine(arguments: &[&str]) {
    let output = trackbed(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

fn is_png(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG") && bytes.len() > 5000)
}

#[test]
fn a_run_is_read_with_its_units_and_what_made_it() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [scene, out] = ["transition.track", "out"].map(|name| folder.path().join(name));
    // so short a run misses what the shipped one is expected to show
    let text = fs::read_to_string("scenarios/transition.track").unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("expect ")).collect();
    fs::write(&scene, lines.join("\n")).unwrap();
    let sets = [
        "traffic.total=8 axles",
        "solve.elements_per_bay=1",
        "solve.time_step=4e-4 s",
        "track_response.after=[0, 8] axles",
    ];
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    fine(&[&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()], &sets[..]].concat());
    let output = notebook(&python, "run.py", &[&out]);
    let told = said(&output);
    assert!(output.status.success(), "{told}");
    let summary: Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let hash = summary["provenance"]["source_sha256"].as_str().unwrap();
    let of_run = format!("transition.track, seed 1, trackbed {}, scene {}", env!("CARGO_PKG_VERSION"), &hash[..12]);
    for words in
        [of_run.as_str(), "with traffic.total = 8 axles", "contact_force [N]: ", "settlement [m]: ", "rail_level [m]: "]
    {
        assert!(told.contains(words), "{words}: {told}");
    }
    // pandas finds in the histories what the summary says
    let after = |words: &str| told.split_once(words).map(|(_, rest)| rest.split_whitespace().next().unwrap());
    let settlement = after("largest settlement after 8 axles: ");
    assert!(settlement.is_some() && settlement == after("max_settlement = "), "{told}");
    assert!(told.contains("largest contact_force of a passage: "), "{told}");
    assert!(is_png(&out.join("settlement.png")));
}

#[test]
fn a_bed_is_read_and_drawn() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [scene, bed] = ["box.track", "bed"].map(|name| folder.path().join(name));
    fs::write(&scene, BED).unwrap();
    fine(&["pack", scene.to_str().unwrap(), "--fresh", "--out", bed.to_str().unwrap()]);
    let told: Value = serde_json::from_slice(&fs::read(bed.join("bed.json")).unwrap()).unwrap();
    let [bodies, contacts, picture] = ["bodies.vtp", "contacts.vtp", "bed.png"].map(|name| bed.join(name));
    let mut output = notebook(&python, "bed.py", &[&bodies, &contacts, &picture]);
    match output.status.code() {
        Some(0) => assert!(is_png(&picture)),
        Some(_) => panic!("{}", said(&output)),
        None => {
            println!("no picture: VTK ends the program where it finds no OpenGL");
            output = notebook(&python, "bed.py", &[&bodies, &contacts]);
        }
    }
    let printed = said(&output);
    let grains = format!("{} grains of {} pebbles, ", told["bodies"], told["pebbles"]);
    let file = String::from_utf8_lossy(&fs::read(&contacts).unwrap()).into_owned();
    let count = file.split("NumberOfLines=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    let links = format!("{count} contacts, ");
    for words in [&grains, &links] {
        assert!(printed.contains(words.as_str()), "{words}: {printed}");
    }
}

/// Coarse spheres under one sleeper.
const BED: &str = "use std
grading coarse { passing = [45 mm: 0 %, 60 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 5 Hz) per sleeper }
solve { substructure = full }
";
