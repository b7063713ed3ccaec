//! Pages as a reader sees them, in a real browser without a window: nothing is cut on a phone, no picture is empty, and
//! the script does what it says. Where no Chromium is installed the tests say so and look at nothing.

use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// Put before everything else on a page, so that no mistake of its script is missed.
const LISTEN: &str =
    "<script>window.probeErrors = []; addEventListener('error', event => probeErrors.push(event.message));</script>";
const PROBE: &str = include_str!("browser_probe.js");

/// Where Chromium is, or a word that it is not.
fn chromium() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).collect();
    let found =
        NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file());
    if found.is_none() {
        println!("skipped: there is no Chromium here; Debian's package is `chromium`");
    }
    found
}

/// Runs Chromium without a window: what it printed, and the errors of the page's console.
fn browse(chromium: &Path, page: &Path, width: u32, more: &[&OsStr]) -> (String, Vec<String>) {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--enable-logging=stderr",
            "--virtual-time-budget=5000",
        ])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--window-size={width},900"))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let logged = String::from_utf8_lossy(&output.stderr).into_owned();
    let errors = logged.lines().filter(|line| line.contains("CONSOLE"));
    (String::from_utf8_lossy(&output.stdout).into_owned(), errors.map(str::to_owned).collect())
}

/// What the probe finds on a page that is so many pixels wide: in a frame, since a window cannot be as narrow as a
/// phone.
fn look(chromium: &Path, page: &Path, width: u32) -> Value {
    let text = fs::read_to_string(page).unwrap();
    let text = text.replacen("<head>", &format!("<head>{LISTEN}"), 1);
    let [probed, frame] = ["probed.html", "frame.html"].map(|name| page.with_file_name(name));
    fs::write(&probed, text.replacen("</body>", &format!("<script>{PROBE}</script></body>"), 1)).unwrap();
    let framed = format!(
        "<!doctype html><body style=\"margin:0\"><script>addEventListener('message', event => \
         document.body.append(Object.assign(document.createElement('pre'), {{ id: 'found', textContent: event.data }})))</script>\
         <iframe src=\"probed.html\" style=\"border:0;width:{width}px;height:900px\"></iframe></body>"
    );
    fs::write(&frame, framed).unwrap();
    let (dom, console) = browse(chromium, &frame, width.max(500), &["--dump-dom".as_ref()]);
    assert!(console.is_empty(), "{console:?}");
    let (_, found) = dom.split_once("<pre id=\"found\">").unwrap_or_else(|| panic!("the probe did not end: {dom}"));
    let (found, _) = found.split_once("</pre>").unwrap();
    let found = found.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&found).unwrap()
}

/// What holds of every page at every width.
fn check(found: &Value, width: u32, page: &str) {
    let none = |what: &str| assert_eq!(found[what], serde_json::json!([]), "{page} at {width} px: {what}");
    assert_eq!(found["width"], width, "{page}");
    assert!(found["overflow"].as_f64().unwrap() <= 0.0, "{page} at {width} px is {} px too wide", found["overflow"]);
    ["errors", "raw", "empty", "cut", "overlaid", "unread", "unswitched"].into_iter().for_each(none);
    assert!(found["small"].as_f64().unwrap() >= 10.0, "{page} at {width} px: letters of {} px", found["small"]);
    assert!(found["pictures"].as_u64().unwrap() > 0, "{page}: {found}");
    if found["charts"].as_u64() != Some(0) {
        assert!(found["ticks"].as_u64().unwrap() >= 2, "{page}: an axis with {} marks", found["ticks"]);
        assert_eq!(found["keys"], true, "{page}");
    }
}

/// A phone and a desk.
const WIDTHS: [u32; 2] = [400, 1200];

fn check_widths(chromium: &Path, page: &Path, name: &str) {
    WIDTHS.iter().for_each(|width| check(&look(chromium, page, *width), *width, name));
}

fn written(directory: &Path, name: &str, text: &str) -> String {
    let path = directory.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// A short transition with layers, a wedge, an approach slab, pads under sleepers, two laws, a mix of trains and
/// expectations.
const SCENE: &str = r#"use std
scenario { title = "A page with `everything`", allow = [
  stiffness_jump: "small", track_too_short: "small: `track` is short", critical_speed: "small", wheel_on_track: "small", passing_frequency: "small"
] }
soil fill : soils.sand { youngs_modulus = 60 MPa }
soil treated : soils.cement_treated { youngs_modulus = ramp(150 .. 900 MPa) }
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  layers = [ballasts.granite_31_63: 300 mm, fill: 2 m]
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, layers = [], slab = slabs.half_width_1600 }
stretch wedge { over = -8 .. 0 m, layers = [ballasts.granite_31_63: 300 mm, treated: ramp(0.1 .. 0.8 m), fill: rest] }
stretch soft { over = -8 .. -1 sleepers, usp = usps.medium }
track line { sections = [open: 42 m, stiff: 24 m], stretches = [wedge, soft] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 100 km/h }
train heavy { vehicles = vehicles.ore_wagon_30t, speed = 60 km/h }
traffic { trains = [ore: 50 %, heavy: 50 %], total = 160 axles }
solve {
  substructure = law, law = [laws.varandas_2014, laws.hettler_1984]
  update_every = 20 axles, elements_per_bay = 2, time_step = 2e-4 s
}
record { at = [-10, -3, -1] sleepers, after = [0, 4, 40, 160] axles, quantities = [rail_seat_load, contact_force, rail_displacement] }
expect { that = [max(settlement) > mean(settlement, over = -30 .. -12 m), max(wheel_force) < 400 kN] }
study softer {
  vary = [open.pad.stiffness: [40, 80] MN/m, stiff.pad.stiffness: [20, 60] MN/m]
  minimise = [max(settlement), max(wheel_force)]
}
"#;

#[test]
fn the_page_of_a_run_can_be_read_moved_and_printed() {
    let Some(chromium) = chromium() else { return };
    let directory = tempfile::tempdir().unwrap();
    let scene = written(directory.path(), "scene.track", SCENE);
    let out = directory.path().join("out");
    let run = trackbed(&["run", &scene, "--out", &out.display().to_string()]);
    assert!(run.status.success(), "{}", said(&run));
    let page = out.join("report.html");
    for width in WIDTHS {
        let found = look(&chromium, &page, width);
        check(&found, width, "the page of a run");
        // the slider moves every chart of its figure, there and back
        let slider = &found["slider"];
        assert_eq!((&slider["charts"], &slider["moved"]), (&3.into(), &3.into()), "{slider}");
        assert_eq!(slider["said"], serde_json::json!(["as built", "after 160 axles"]));
        assert_eq!((&slider["steps"], &slider["back"]), (&4.into(), &true.into()), "{slider}");
        // a value has its place, its name and its unit
        let reading = found["reading"].as_str().unwrap();
        assert!(
            reading.starts_with("Chainage ") && reading.contains("seat") && reading.contains("after 160 axles: "),
            "{reading}"
        );
        assert!(reading.contains(" mm"), "{reading}");
        assert!(found["switches"].as_u64().unwrap() > 10, "{found}");
    }
    let text = fs::read_to_string(&page).unwrap();
    for drawn in ["under sleeper pad", "treated: ", "wedge: 8 m", "A page with <code>everything</code>"] {
        assert!(text.contains(drawn), "no {drawn}");
    }
    let printed = out.join("page.pdf");
    browse(
        &chromium,
        &page,
        1200,
        &["--no-pdf-header-footer".as_ref(), format!("--print-to-pdf={}", printed.display()).as_ref()],
    );
    assert!(fs::metadata(&printed).unwrap().len() > 20_000);
}

#[test]
fn the_page_of_a_study_can_be_read() {
    let Some(chromium) = chromium() else { return };
    let directory = tempfile::tempdir().unwrap();
    let shorter =
        SCENE.replace("total = 160 axles", "total = 20 axles").replace("[0, 4, 40, 160] axles", "[0, 20] axles");
    let scene = written(directory.path(), "scene.track", &shorter);
    let out = directory.path().join("study");
    let study = trackbed(&["study", &scene, "--out", &out.display().to_string()]);
    assert!(study.status.success(), "{}", said(&study));
    check_widths(&chromium, &out.join("study.html"), "the page of a study");
}

/// A few grains under a sleeper, the cheapest that is a bed.
const RIG: &str = r#"use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 3 cycles }
solve { substructure = full }
record { at = 1 sleeper, depth = 75 mm, volume = sphere(70 mm), after = [1, 3] cycles, quantities = ballast_stress }
expect { that = [0 mm < max(settlement) < 10 mm] }
"#;

#[test]
fn the_pages_of_a_rig_and_of_a_bed_can_be_read() {
    let Some(chromium) = chromium() else { return };
    let directory = tempfile::tempdir().unwrap();
    let scene = written(directory.path(), "box.track", RIG);
    let path = |name: &str| directory.path().join(name).display().to_string();
    let run = trackbed(&["run", &scene, "--out", &path("out"), "--cache", &path("cache")]);
    assert!(run.status.success(), "{}", said(&run));
    let pack = trackbed(&["pack", &scene, "--out", &path("bed"), "--cache", &path("cache")]);
    assert!(pack.status.success(), "{}", said(&pack));
    for (page, name) in [("out/report.html", "the page of a rig"), ("bed/bed.html", "the page of a bed")] {
        check_widths(&chromium, &directory.path().join(page), name);
    }
}
