//! Packings of the grains as a person asks for them: a number, or a range in which the results decide.

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

/// Coarse spheres under one sleeper: packed and run in seconds.
const RIG: &str = "use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 2 cycles }
solve { substructure = full }
";

/// Four times the force settles more on any bed; a hundredth more force makes no difference that matters.
const STUDY: &str = "
study which {
  vary      = [actuator.force: [cyclic(5 .. 240 kN, 40 Hz) per sleeper, cyclic(5 .. 60.5 kN, 40 Hz) per sleeper]]
  minimise  = max(settlement)
  repeats   = 2 .. 5
  tolerance = 20 %
}
";

/// A track on cells.
const TRACK: &str = "use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7, viscous_damping = 0.3
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform open {
  rail = rails.UIC60, pad = { stiffness = 40 MN/m, damping = 5 kN s/m }
  sleeper = sleepers.concrete { mass = 150 kg per seat, length = 2 m }, spacing = 0.6 m, layers = [stone: 200 mm]
}
trackform stiff : open { sleeper = none, slab = slabs.half_width_1600 }
track line { sections = [open: 18 m, stiff: 15 m], transitions = [edge: soft_to_stiff] }
vehicle wagon : vehicles.ore_wagon_20t { length = 12 m }
train ore { vehicles = wagon, speed = 200 km/h, direction = forward }
traffic { trains = ore, total = 4 axles }
solve { substructure = cells, repeats = 2 .. 3, tolerance = 5 %, update_every = 4 axles }
record { at = [-2, -1, +1] sleepers, after = [0, 4] axles, quantities = rail_seat_load }
";

fn write(folder: &Path, text: &str) -> String {
    let path = folder.join("scene.track");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    csv::Reader::from_path(path).unwrap().deserialize().map(Result::unwrap).collect()
}

#[test]
fn a_study_gives_each_point_the_packings_that_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    let file = write(folder.path(), &format!("{RIG}{STUDY}"));
    let (out, cache) = (folder.path().join("out"), folder.path().join("cache"));
    let study = |out: &Path, more: &[&str]| {
        let words = ["study", &file, "--out", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
        trackbed(&[&words, more].concat())
    };
    let first = study(&out, &["--jobs", "2"]);
    assert!(first.status.success(), "{}", said(&first));
    let told = said(&first);
    assert!(told.contains("6 to 15 runs") && told.contains("packings a point"), "{told}");

    let table = rows(&out.join("study.csv"));
    let number = |row: usize, name: &str| table[row][name].parse::<f64>().unwrap();
    let packings: Vec<f64> = (0..3).map(|row| number(row, "packings")).collect();
    assert!(packings.iter().all(|count| (2.0..=5.0).contains(count)), "{packings:?}");
    // the difference is one of the same packings: its interval is a part of the scatter of both
    let (of, half) = ("max(settlement) difference [mm]", "max(settlement) difference +- [mm]");
    assert!(number(1, of) > number(1, half), "four times the force: {table:?}");
    let scatter = number(0, "max(settlement) sd [mm]");
    assert!(number(2, of).abs() < scatter && number(2, half) < 3.0 * scatter, "{table:?}");

    let found = json(&out.join("study.json"));
    assert_eq!(found["repeats"], serde_json::json!([2, 5]));
    assert_eq!(found["runs"].as_f64(), Some(packings.iter().sum()));
    let certainty = found["certainty"].as_str().unwrap();
    assert!(told.replace('\n', " ").contains(certainty), "{certainty}");
    let page = fs::read_to_string(out.join("study.html")).unwrap();
    assert!(page.contains("<th>packings</th>") && page.contains("on 2 to 5 packings"), "{certainty}");
    // what is finished is read again, and gives the same answer
    let again = study(&out, &["--resume"]);
    assert!(said(&again).contains("nothing is run"), "{}", said(&again));
    assert!(fs::read_to_string(out.join("study.html")).unwrap() == page);

    // any number of threads, and runs of other processes, give the same bits
    let shared = folder.path().join("shared");
    let mut rounds = 0;
    while !shared.join("study.json").exists() {
        let more: &[&str] = if rounds == 0 { &[] } else { &["--resume"] };
        let begun = study(&shared, &[&["--executor", "workers"], more].concat());
        assert!(begun.status.success(), "{}", said(&begun));
        if !shared.join("study.json").exists() {
            let worked = trackbed(&["work", shared.to_str().unwrap()]);
            assert!(worked.status.success(), "{}", said(&worked));
        }
        rounds += 1;
        assert!(rounds < 8, "a round for each packing");
    }
    for name in ["study.csv", "study.json", "points.json"] {
        assert!(fs::read(out.join(name)).unwrap() == fs::read(shared.join(name)).unwrap(), "{name}");
    }
    let compared = trackbed(&["compare", out.to_str().unwrap(), shared.to_str().unwrap()]);
    assert!(compared.status.success(), "{}", said(&compared));
}

#[test]
fn a_rig_stops_when_its_mean_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let file = write(folder.path(), RIG);
    let cache = folder.path().join("cache");
    let packings = |repeats: &str, tolerance: &str| {
        let (out, edits) = (folder.path().join(repeats), [format!("solve.repeats={repeats}"), tolerance.to_owned()]);
        let [out, cache] = [&out, &cache].map(|path| path.to_str().unwrap());
        let run = trackbed(&["run", &file, "--out", out, "--cache", cache, "--set", &edits[0], "--set", &edits[1]]);
        assert!(run.status.success(), "{}", said(&run));
        let summary = json(&Path::new(out).join("summary.json"));
        let of = |name: &str| summary[name]["value"].as_f64().unwrap();
        (of("repeats"), of("max_settlement"), of("max_settlement_confidence"))
    };
    // a range that any scatter fits ends at its least number, one that none fits at its most
    let (count, mean, half) = packings("2 .. 4", "solve.tolerance=50 %");
    assert!((2.0..=4.0).contains(&count) && (half <= 0.5 * mean || count == 4.0), "{count} {mean} {half}");
    let (most, ..) = packings("2 .. 3", "solve.tolerance=0.1 %");
    assert_eq!(most, 3.0);
    // and gives the values of the same number that is asked for as such
    let (times, same_mean, same_half) = packings(&count.to_string(), "solve.tolerance=50 %");
    assert_eq!((times, same_mean, same_half), (count, mean, half));
}

#[test]
fn a_track_stops_when_its_settlement_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let file = write(folder.path(), TRACK);
    let cache = folder.path().join("cache");
    let run = |out: &str, more: &[&str]| {
        let out = folder.path().join(out);
        let words = ["run", &file, "--out", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
        let run = trackbed(&[&words, more].concat());
        assert!(run.status.success(), "{}", said(&run));
        (json(&out.join("summary.json")), fs::read_dir(out.join("packings")).unwrap().count() + 1, said(&run))
    };
    let (summary, count, told) = run("loose", &["--set", "solve.tolerance=40 %"]);
    let of = |name: &str| summary[name]["value"].as_f64().unwrap();
    let known = of("max_settlement_mean_confidence") <= 0.4 * of("max_settlement_mean");
    assert!(known && count < 3 || count == 3, "{count}: {told}");
    let loose_count = count;
    assert!(told.contains("packing 2 of 2 to 3: seed 2"), "{told}");
    let (_, count, told) = run("close", &["--set", "solve.tolerance=0.1 %"]);
    assert!(count == 3 && told.contains("2 to 3 packings are too few"), "{count}: {told}");
    // the page of a run reads the packings that its answer is made of
    let loose = folder.path().join("loose");
    let page = fs::read_to_string(loose.join("report.html")).unwrap();
    let report = trackbed(&["report", loose.to_str().unwrap()]);
    assert!(report.status.success(), "{}", said(&report));
    assert!(fs::read_to_string(loose.join("report.html")).unwrap() == page && page.contains("\u{b1} 95 %"));
    assert!(page.contains("Of 2 to 3 packings these give") || loose_count == 3, "{told}");
    let page = fs::read_to_string(folder.path().join("close/report.html")).unwrap();
    assert!(page.contains("Even these 3 packings do not give"));
}

#[test]
fn a_range_is_whole_and_begins_with_two() {
    let mistake = |repeats: &str| {
        let text = RIG.replace("substructure = full", &format!("substructure = full, repeats = {repeats}"));
        let compiled = compile("scene.track", &text, &NoModules, &[]);
        let errors = compiled.diagnostics.iter().filter(|d| d.is_error());
        let told: Vec<(Code, String)> = errors.map(|d| (d.code, d.message.clone())).collect();
        told
    };
    assert_eq!(mistake("3 .. 12"), []);
    let begins = "a range of packings begins with at least 2, found 1";
    assert_eq!(mistake("1 .. 12"), [(Code::E0405, begins.to_owned())]);
    let whole = "expected a whole number of packings, found 2.5";
    assert_eq!(mistake("2.5 .. 12"), [(Code::E0405, whole.to_owned())]);
    assert!(matches!(mistake("12 .. 3")[..], [(Code::E0505, _)]), "{:?}", mistake("12 .. 3"));
    assert!(matches!(mistake("3 .. 5000")[..], [(Code::E0405, _)]), "{:?}", mistake("3 .. 5000"));
}
