//! Test rigs run as a person runs them: from a scene to cycles, a report and a verdict.

use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::time::Duration;
use trackbed::check::NoModules;
use trackbed::diag::{Code, Diagnostic};
use trackbed::execute::{Event, Executor};
use trackbed::store::Beds;
use trackbed::{Scene, compile};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// Coarse spheres under one sleeper: packed and run in seconds.
const SCENE: &str = r#"
use std
grading coarse { passing = [50 mm: 0 %, 65 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa, friction = 0.2 }
}
trackform bed { sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm] }
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 4 cycles }
solve { substructure = full }
record { at = 1 sleeper, depth = 75 mm, volume = sphere(70 mm), after = [1, 4] cycles, quantities = ballast_stress }
expect { that = [0 mm < max(settlement) < 10 mm, max(ballast_stress, after = 4 cycles) > 1 kPa, max(contact_force) < 50 kN per seat] }
"#;

fn scene(directory: &Path, text: &str) -> String {
    let path = directory.join("box.track");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

#[test]
fn a_rig_runs_from_its_scene_to_its_report() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), SCENE);
    let path = |name: &str| directory.path().join(name).display().to_string();
    let run = |out: &str, more: &[&str]| {
        trackbed(&[&["run", &scene, "--out", &path(out), "--cache", &path("cache")], more].concat())
    };
    let first = run("first", &["--threads", "2"]);
    assert!(first.status.success() && said(&first).contains("resilient stiffness"), "{}", said(&first));
    let cycles = fs::read_to_string(path("first/cycles.csv")).unwrap();
    assert_eq!(cycles.lines().count(), 5, "{cycles}");
    let summary: Value = serde_json::from_str(&fs::read_to_string(path("first/summary.json")).unwrap()).unwrap();
    let of = |name: &str| summary[name]["value"].as_f64().unwrap();
    assert!(of("max_settlement") > 0.0 && of("support_stiffness") > 1e6 && of("cycles") == 4.0, "{summary}");
    assert!(summary["expectations"].as_array().unwrap().iter().all(|v| v["met"] == true), "{summary}");
    let page = fs::read_to_string(path("first/report.html")).unwrap();
    for figure in ["settlement", "settlement_log", "stiffness", "loops", "stress", "velocity", "along", "across"] {
        assert!(page.contains(&format!("<section id=\"{figure}\">")), "{figure}");
    }
    // equal runs leave equal tables, on any number of threads and with a bed that was kept
    let again = run("again", &["--threads", "1"]);
    assert!(again.status.success(), "{}", said(&again));
    for file in ["cycles.csv", "loops.csv", "sensors.csv", "volumes.csv", "summary.json", "beds.json", "report.html"] {
        let read = |run: &str| fs::read(path(&format!("{run}/{file}"))).unwrap();
        assert!(read("first") == read("again"), "{file}");
    }
    // the page again, from its directory
    fs::remove_file(path("first/report.html")).unwrap();
    let report = trackbed(&["report", &path("first"), "--figures"]);
    assert!(report.status.success(), "{}", said(&report));
    assert!(fs::read_to_string(path("first/report.html")).unwrap() == page, "not the same page");
    assert!(fs::read_to_string(path("first/along.svg")).unwrap().starts_with("<svg"));
    let taken = run("first", &[]);
    assert!(!taken.status.success() && said(&taken).contains("E0802"), "{}", said(&taken));
}

#[test]
fn further_packings_give_a_band_and_a_missed_expectation_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), &SCENE.replace("0 mm < max(settlement) < 10 mm", "max(settlement) < 0.001 mm"));
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let arguments = ["run", &scene, "--out", &out, "--cache", cache.to_str().unwrap(), "--set", "solve.repeats=2"];
    let run = trackbed(&arguments);
    assert!(!run.status.success() && said(&run).contains("E0804"), "{}", said(&run));
    let summary: Value = serde_json::from_str(&fs::read_to_string(format!("{out}/summary.json")).unwrap()).unwrap();
    assert!(summary["max_settlement_confidence"]["value"].as_f64().unwrap() > 0.0, "{summary}");
    let cycles = fs::read_to_string(format!("{out}/cycles.csv")).unwrap();
    let seeds: Vec<&str> = cycles.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(seeds, ["1", "1", "1", "1", "2", "2", "2", "2"]);
}

#[test]
fn a_scene_may_expect_how_many_bonds_break() {
    let directory = tempfile::tempdir().unwrap();
    let expecting = SCENE.replace("0 mm < max(settlement) < 10 mm", "broken_bonds_share < 5 %");
    let glued = |strength: &str| {
        let bond = format!(
            "bond = {{ stiffness = 50 MN/m per contact, tensile_strength = {strength}, shear_strength = {strength} }}"
        );
        expecting.replace("friction = 0.7\n", &format!("friction = 0.7\n  {bond}\n"))
    };
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let run = |text: &str| {
        let scene = scene(directory.path(), text);
        let run = trackbed(&["run", &scene, "--out", &out, "--cache", cache.to_str().unwrap(), "--force"]);
        (run.status.code(), said(&run))
    };
    let (code, told) = run(&glued("500 kN"));
    assert_eq!(code, Some(0), "{told}");
    let (code, told) = run(&glued("1 N"));
    assert!(
        code == Some(1) && told.contains("E0804") && told.contains("expected `broken_bonds_share < 5 %`"),
        "{told}"
    );
    let (code, told) = run(&expecting);
    assert!(code == Some(1) && told.contains("E0616") && told.contains("glued grains"), "{told}");
}

#[test]
fn a_force_that_no_bed_carries_is_told() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), &SCENE.replace("5 .. 60 kN", "5 .. 9000 kN"));
    let (out, cache) = (directory.path().join("out"), directory.path().join("cache"));
    let run = trackbed(&["run", &scene, "--out", out.to_str().unwrap(), "--cache", cache.to_str().unwrap()]);
    assert!(!run.status.success() && said(&run).contains("E0812") && said(&run).contains("in cycle"), "{}", said(&run));
    assert!(!out.join("summary.json").exists());
}

/// A plate of 0.6 m2 on the bed, under the given load.
fn plate(load: &str) -> String {
    SCENE
        .replace("sleeper = sleepers.B70, ", "")
        .replace("sections = [bed: 1 sleeper]", "sections = [bed: 0.6 m], bed_width = 1 m per track")
        .replace(
            "on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 4 cycles",
            &format!("on = bed, at = 0.3 m, {load}"),
        )
}

#[test]
fn a_plate_over_the_bed_gives_stress_against_strain() {
    let directory = tempfile::tempdir().unwrap();
    let text = plate("force = cyclic(0.6 .. 60 kN, 20 Hz) per rail, total = 2 cycles")
        .replace("after = [1, 4]", "after = [1, 2]")
        .replace(
            "max(ballast_stress, after = 4 cycles) > 1 kPa, max(contact_force) < 50 kN per seat",
            "max(ballast_stress) > 50 kPa",
        );
    let scene = scene(directory.path(), &text);
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let run = trackbed(&["run", &scene, "--out", &out, "--cache", cache.to_str().unwrap()]);
    assert!(run.status.success() && said(&run).contains("oedometric modulus"), "{}", said(&run));
    let summary: Value = serde_json::from_str(&fs::read_to_string(format!("{out}/summary.json")).unwrap()).unwrap();
    let modulus = |name: &str| summary[name]["value"].as_f64().unwrap();
    // stiffer on the way back than when it was first loaded; MPa, not GPa
    assert!(modulus("oedometric_modulus") > modulus("first_oedometric_modulus"), "{summary}");
    assert!((5e6..500e6).contains(&modulus("first_oedometric_modulus")), "{summary}");
    assert!(fs::read_to_string(format!("{out}/report.html")).unwrap().contains("<section id=\"strain\">"));
}

#[test]
fn a_constant_force_has_no_modulus_of_first_loading() {
    let directory = tempfile::tempdir().unwrap();
    let text = plate("force = 120 kN per track");
    let scene = scene(directory.path(), &text[..text.find("record").unwrap()]);
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let run = trackbed(&["run", &scene, "--out", &out, "--cache", cache.to_str().unwrap()]);
    assert!(run.status.success(), "{}", said(&run));
    let summary: Value = serde_json::from_str(&fs::read_to_string(format!("{out}/summary.json")).unwrap()).unwrap();
    let modulus = summary["oedometric_modulus"]["value"].as_f64().unwrap();
    assert!((5e6..500e6).contains(&modulus) && summary.get("first_oedometric_modulus").is_none(), "{summary}");
}

#[test]
fn actuators_load_sleepers_one_after_the_other() {
    let directory = tempfile::tempdir().unwrap();
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let smaller = [
        "rig.sections=[bed: 3 sleepers]",
        "bed.layers=[stone: 150 mm]",
        "stone.shape=spheres",
        "stone.scale=1",
        "stone.grading.cut_below=50 mm",
        "stone.packing.lifts=1",
        "actuators.force=cyclic(5 .. 60 kN, 40 Hz) per sleeper",
        "actuators.total=2 cycles",
        "pressure.at=2 sleepers",
        "pressure.after=[1, 2] cycles",
    ];
    let mut arguments = vec!["run", "scenarios/bian_rig.track", "--out", &out, "--cache", cache.to_str().unwrap()];
    arguments.extend(smaller.iter().flat_map(|edit| ["--set", edit]));
    let run = trackbed(&arguments);
    assert!(run.status.success(), "{}", said(&run));
    let cycles = fs::read_to_string(format!("{out}/cycles.csv")).unwrap();
    let ended: Vec<(&str, &str)> = cycles
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (cells[1], cells[2])
        })
        .collect();
    // 10 ms from sleeper to sleeper, and 25 ms a cycle
    assert_eq!(ended, [("+1", "1"), ("+2", "1"), ("+3", "1"), ("+1", "2"), ("+2", "2"), ("+3", "2")]);
}

#[test]
fn a_plan_says_what_a_rig_costs_without_packing_it() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), SCENE);
    let plan = trackbed(&["plan", &scene]);
    let text = said(&plan);
    for word in [
        "node bed: 1 sleeper on a packed bed",
        " grains of ",
        " steps to pack the bed",
        "on two cores, within a factor of two",
    ] {
        assert!(plan.status.success() && text.contains(word), "{word}: {text}");
    }
    let hertz = trackbed(&["run", &scene, "--out", "unused", "--set", "stone.contact=hertz(50 GPa, 0.2)"]);
    assert!(!hertz.status.success() && said(&hertz).contains("E0610"), "{}", said(&hertz));
    assert!(!Path::new("unused").exists(), "nothing is written for what cannot be packed");
}

#[test]
fn what_no_rig_has_is_refused_by_the_check() {
    let rig = |from: &str, to: &str| {
        assert!(SCENE.contains(from), "{from}");
        let compiled = compile("box.track", &SCENE.replace(from, to), &NoModules, &[]);
        let mistakes = compiled.diagnostics.into_iter().filter(Diagnostic::is_error);
        mistakes.map(|d| (d.code, d.message)).collect::<Vec<(Code, String)>>()
    };
    assert_eq!(rig("4 cycles }", "4 cycles }"), []);
    let second = "4 cycles }\nload other { on = sleepers, at = 1 sleeper, force = 3 kN per sleeper }";
    for (from, to, expected) in [
        ("4 cycles }", second, "both act on sleeper +1"),
        ("sections = [bed: 1 sleeper]", "sections = [bed: 1 sleeper, other: 1 sleeper]", "a test rig has one bed"),
        ("spacing = 0.6 m", "spacing = 0.3 m", "a test rig needs a gap between sleepers"),
    ] {
        let from_bed = "trackform other : bed { layers.stone = 200 mm }\ntrack box";
        let text = SCENE.replace(from, to);
        let text = if to.contains("other: 1") { text.replace("track box", from_bed) } else { text };
        let compiled = compile("box.track", &text, &NoModules, &[]);
        let found: Vec<(Code, &str)> = compiled.diagnostics.iter().map(|d| (d.code, d.message.as_str())).collect();
        assert!(found.iter().any(|(c, m)| *c == Code::E0611 && m.contains(expected)), "{expected}: {found:?}");
        let mut refusals = compiled.diagnostics.iter().filter(|d| d.code == Code::E0611);
        assert!(refusals.all(|refusal| !refusal.labels.is_empty()), "each has its line: {found:?}");
        assert!(compiled.graph.is_some() && compiled.runnable().is_none(), "what is refused is planned all the same");
    }
}

/// A box of the same spheres, shortened under a pressure on its sides.
fn triaxial() -> String {
    let record = SCENE.find("record").unwrap();
    SCENE[..record]
        .replace("sleeper = sleepers.B70, spacing = 0.6 m", "spacing = 0.35 m")
        .replace("stone: 150 mm", "stone: 350 mm")
        .replace("friction = 0.7\n", "friction = 0.7, wall_friction = 0\n")
        .replace("sections = [bed: 1 sleeper]", "sections = [bed: 0.35 m], bed_width = 0.7 m per track")
        .replace(
            "on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 40 Hz) per sleeper, total = 4 cycles",
            "on = bed, at = 0.2 m, strain = 4 %, confinement = 100 kPa",
        )
}

#[test]
fn a_triaxial_test_gives_the_strength_of_its_grains() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), &triaxial());
    let (out, cache) = (directory.path().join("out").display().to_string(), directory.path().join("cache"));
    let run = trackbed(&["run", &scene, "--out", &out, "--cache", cache.to_str().unwrap()]);
    assert!(run.status.success() && said(&run).contains("largest friction angle"), "{}", said(&run));
    let summary: Value = serde_json::from_str(&fs::read_to_string(format!("{out}/summary.json")).unwrap()).unwrap();
    let of = |name: &str| summary[name]["value"].as_f64().unwrap();
    // published ballast at such pressures: 40 to 60 degrees; a few spheres between smooth walls half of it
    assert!((18.0..60.0).contains(&of("peak_friction_angle").to_degrees()), "{summary}");
    assert!((1e6..1e9).contains(&of("secant_modulus")) && of("least_volume_strain") < 0.0, "{summary}");
    assert!(summary.get("support_stiffness").is_none() && summary.get("oedometric_modulus").is_none(), "{summary}");
    let rows = fs::read_to_string(format!("{out}/specimen.csv")).unwrap();
    assert_eq!(rows.lines().count(), 65);
    let page = fs::read_to_string(format!("{out}/report.html")).unwrap();
    for figure in ["deviator", "volume"] {
        assert!(page.contains(&format!("<section id=\"{figure}\">")), "{figure}");
    }
    assert!(!page.contains("<section id=\"settlement\">"), "one cycle has nothing to show against cycles");
}

#[test]
fn sides_give_way_only_under_a_plate() {
    let found = |text: &str| {
        let diagnostics = compile("box.track", text, &NoModules, &[]).diagnostics;
        diagnostics.into_iter().filter(Diagnostic::is_error).map(|d| (d.code, d.message)).collect::<Vec<_>>()
    };
    assert_eq!(found(&triaxial()), []);
    let on_sleepers = SCENE.replace("total = 4 cycles", "total = 4 cycles, confinement = 60 kPa");
    let [(Code::E0611, message)] = &found(&on_sleepers)[..] else { panic!("{:?}", found(&on_sleepers)) };
    assert!(message.contains("`confinement` is only for a specimen under a plate"), "{message}");
    // a plate needs a bed under it, which only grains make
    let by_law = triaxial().replace("substructure = full", "substructure = law");
    let [(Code::E0611, message)] = &found(&by_law)[..] else { panic!("{:?}", found(&by_law)) };
    assert!(message.contains("acts on a bed of grains, but this scene does not ask for a bed"), "{message}");
    // a plate is loaded or driven, not both
    let both = triaxial().replace("strain = 4 %", "strain = 4 %, force = 10 kN per rail");
    assert!(matches!(found(&both)[..], [(Code::E0404, _)]), "{:?}", found(&both));
    assert!(!found(&triaxial().replace("strain = 4 %, ", "")).is_empty());
}

#[test]
fn a_killed_rig_goes_on_with_the_same_answer() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), SCENE);
    let path = |name: &str| directory.path().join(name).display().to_string();
    let cache = path("cache");
    let words = |out: &str, more: &[&str]| {
        let out = path(out);
        let words = ["run", &scene, "--out", &out, "--cache", &cache, "--set", "solve.repeats=2"];
        words.iter().chain(more).map(|word| word.to_string()).collect::<Vec<_>>()
    };
    let mut first = Command::new(env!("CARGO_BIN_EXE_trackbed")).args(words("killed", &[])).spawn().unwrap();
    while !Path::new(&path("killed/.trackbed/checkpoint")).exists() {
        assert!(first.try_wait().unwrap().is_none(), "the run ended before it could be killed");
        std::thread::sleep(Duration::from_millis(5));
    }
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(!Path::new(&path("killed/summary.json")).exists());
    for (out, more) in [("killed", &["--resume"][..]), ("whole", &[])] {
        let words = words(out, more);
        let run = trackbed(&words.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(run.status.success(), "{}", said(&run));
    }
    for file in ["cycles.csv", "loops.csv", "sensors.csv", "volumes.csv", "summary.json", "beds.json"] {
        assert!(
            fs::read(path(&format!("killed/{file}"))).unwrap() == fs::read(path(&format!("whole/{file}"))).unwrap()
        );
    }
}

/// Two points that pack alike, one that does not; the study is named after what it varies.
const STUDY: &str = r#"
study how {
  vary   = [actuator.force: [cyclic(5 .. 40 kN, 40 Hz) per sleeper, cyclic(5 .. 60 kN, 40 Hz) per sleeper], stone.density: [2500, 2700] kg/m^3]
  report = [max(settlement), mean(support_stiffness), mean(porosity)]
}
"#;

#[test]
fn a_study_runs_rigs_and_points_that_pack_alike_share_a_bed() {
    let directory = tempfile::tempdir().unwrap();
    let scene = scene(directory.path(), &format!("{SCENE}{STUDY}"));
    let path = |name: &str| directory.path().join(name).display().to_string();
    let study = |out: &str, more: &[&str]| {
        trackbed(&[&["study", &scene, "--out", &path(out), "--cache", &path("cache")], more].concat())
    };
    let first = study("first", &[]);
    assert!(first.status.success() && said(&first).contains("4 points"), "{}", said(&first));
    // without an objective all of them are told
    assert!(said(&first).contains("point 4") && said(&first).contains("max(settlement) "), "{}", said(&first));
    let mut rows: Vec<HashMap<String, String>> =
        csv::Reader::from_path(path("first/study.csv")).unwrap().deserialize().map(Result::unwrap).collect();
    // the scene as it is stands in front, whether it is a point of the design or not
    assert!(rows[0]["as_it_is"] == "yes", "{rows:?}");
    rows.retain(|row| row["point"] != "0");
    rows.sort_by_key(|row| row["point"].parse::<u32>().unwrap());
    let settlements: Vec<f64> = rows.iter().map(|row| row["max(settlement) [mm]"].parse().unwrap()).collect();
    assert_eq!(settlements.len(), 4);
    // the heavier load settles more in both beds
    assert!(settlements[0] < settlements[2] && settlements[1] < settlements[3], "{rows:?}");
    let beds = fs::read_dir(path("cache")).unwrap().map(|entry| entry.unwrap().path());
    assert_eq!(beds.filter(|bed| bed.extension().is_some_and(|kind| kind == "bed")).count(), 2);
    // the same answer one after the other, with beds that were kept, and as a run alone
    let again = study("again", &["--jobs", "1"]);
    assert!(again.status.success(), "{}", said(&again));
    for file in ["study.csv", "study.json", "study.html"] {
        assert!(
            fs::read(path(&format!("first/{file}"))).unwrap() == fs::read(path(&format!("again/{file}"))).unwrap(),
            "{file}"
        );
    }
    let executor = Executor::default().with_beds(Beds::kept_in(path("cache")));
    let alone = Scene::open(&scene).unwrap().run_with(&executor, &mut ()).unwrap();
    let [run, point] = [1e3 * alone.scalar("max_settlement").unwrap(), settlements[3]];
    assert!((run / point - 1.0).abs() < 1e-12, "{run} {point} mm");
    let page = fs::read_to_string(path("first/study.html")).unwrap();
    // the script at the end of the page knows the word
    let shown = page.split("<script").next().unwrap();
    assert!(shown.contains("<section id=\"effects\">") && !shown.contains("NaN") && !shown.contains("Whiskers"));
}

#[test]
fn a_study_of_rigs_is_checked_before_it_runs() {
    let directory = tempfile::tempdir().unwrap();
    let of = |study: &str| {
        let scene = scene(directory.path(), &format!("{SCENE}{study}"));
        let check = trackbed(&["check", &scene]);
        (check.status.success(), said(&check))
    };
    let (sound, told) = of(STUDY);
    assert!(sound, "{told}");
    let (sound, told) = of("study how { vary = [stone.friction: [0.5, 0.7]], minimise = max(void) }");
    assert!(!sound && told.contains("E0705") && told.contains("`void`"), "{told}");
    // a point with a layer that is none
    let (sound, told) = of("study how { vary = [bed.layers.stone: [60, 150] mm], minimise = max(settlement) }");
    assert!(!sound && told.contains("point 1 of 2") && told.contains("(E0511)"), "{told}");
    let (_, told) =
        of("study how { vary = [stone.friction: [0.5, 0.7]], minimise = max(settlement), budget = 0.0001 h }");
    assert!(told.contains("E0709"), "{told}");
}

#[test]
fn one_call_runs_rigs_and_tracks() {
    let rig = Scene::from_text(SCENE);
    let mut packed = 0;
    let mut stop_at_the_bed = |event: &Event<'_>| match event {
        Event::Packed { .. } => {
            packed += 1;
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    };
    let run = rig.run_with(&Executor::default(), &mut stop_at_the_bed).unwrap();
    assert!(run.tests.is_some_and(|tests| tests.tests.is_empty()) && packed == 1, "a listener has ended it");
    let wrong = rig.clone().set("stone.packing.lifts", "0.5").run().unwrap_err();
    assert!(wrong.to_string().contains("lifts"), "{wrong}");
    let track = Scene::open("scenarios/static_check.track").unwrap().run().unwrap();
    assert!(track.tests.is_none() && track.scalar("max_rail_moment").is_some());
}
