//! Beds from scenes: packed, described, kept, and refused where there can be none.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Coarse spheres under one sleeper: a bed that is packed in a moment.
const SCENE: &str = r#"
use std
grading coarse { passing = [45 mm: 0 %, 60 mm: 100 %] }
granular stone {
  grading = coarse, density = 2700 kg/m^3, contact_stiffness = 13 MN/m per contact, friction = 0.7
  packing = { lifts = 1, pressure = 200 kPa }
}
trackform bed {
  sleeper = sleepers.B70, spacing = 0.6 m, layers = [stone: 150 mm]
}
track box { sections = [bed: 1 sleeper] }
load actuator { on = sleepers, at = 1 sleeper, force = cyclic(5 .. 60 kN, 5 Hz) per sleeper }
solve { substructure = full }
"#;

fn pack(scene: &Path, arguments: &[&str], threads: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.arg("pack").arg(scene).args(arguments).env("NO_COLOR", "1").env("RAYON_NUM_THREADS", threads);
    command.output().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn a_bed_is_packed_once_and_is_the_same_on_any_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("box.track");
    fs::write(&scene, SCENE).unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let built = pack(&scene, &["--cache", &path("cache"), "--out", &path("bed")], "2");
    assert!(built.status.success(), "{}", said(&built));
    assert!(!said(&built).contains("as it was kept"), "{}", said(&built));
    let bed: Value = serde_json::from_str(&fs::read_to_string(path("bed/bed.json")).unwrap()).unwrap();
    let layer = &bed["layers"][0];
    let of = |name: &str| layer[name].as_f64().unwrap();
    // one lift of three grains, which floor and plate loosen all through
    assert!((of("thickness_m") / 0.15 - 1.0).abs() < 0.03, "{layer}");
    // spheres of like sizes without friction: close to random close packing, looser at floor, walls and top
    assert!((0.33..0.46).contains(&of("inner_porosity")), "{layer}");
    assert!((4.0..6.5).contains(&of("coordination_pressed")), "{layer}");
    assert!((3.0..of("coordination_pressed")).contains(&of("coordination")), "{layer}");
    assert!(of("grading_error") < 0.02, "{layer}");
    let stages: Vec<&str> = bed["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(stages, ["stone, lift 1 of 1", "plate eased", "friction restored", "plate lifted"]);
    for stage in bed["stages"].as_array().unwrap() {
        assert!(stage["state"]["unbalance"].as_f64().unwrap() < 0.011, "{stage}");
    }
    what_is_read_off_it_is_sound(&bed);
    for name in ["bed.html", "along.svg", "chains.svg", "bodies.vtp", "contacts.vtp"] {
        assert!(fs::metadata(dir.path().join("bed").join(name)).unwrap().len() > 1000, "{name}");
    }
    let kept = pack(&scene, &["--cache", &path("cache"), "--format", "json"], "2");
    let again = pack(&scene, &["--fresh", "--format", "json"], "1");
    for output in [&kept, &again] {
        let other: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(bed, other);
    }
    let kept = pack(&scene, &["--cache", &path("cache")], "2");
    assert!(said(&kept).contains("as it was kept"), "{}", said(&kept));
    for words in ["of their friction used", "plate of 0.3 m x 1.3 m to 100 kPa:", "Ev2/Ev1"] {
        assert!(said(&kept).contains(words), "{}", said(&kept));
    }
    let page = fs::read_to_string(path("bed/bed.html")).unwrap();
    for id in ["plate", "profile", "contacts"] {
        assert!(page.contains(&format!("<section id=\"{id}\">")), "{id}");
    }
    assert!(!page.contains("NaN"));
}

fn what_is_read_off_it_is_sound(bed: &Value) {
    let readings = &bed["readings"];
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value}"));
    // the floor carries the weight of the grains, less what hangs on the walls
    let profile = readings["profile"].as_array().unwrap();
    let porosity = number(&bed["layers"][0]["porosity"]);
    let weight = 2700.0 * 9.81 * (1.0 - porosity) * number(&bed["layers"][0]["thickness_m"]);
    let floor = number(&profile[0]["vertical_Pa"]);
    assert!((0.75..1.0).contains(&(floor / weight)), "{floor} of {weight}");
    // slabs of equal height are the layer
    let mean = profile.iter().map(|row| number(&row["porosity"])).sum::<f64>() / profile.len() as f64;
    assert!((mean - porosity).abs() < 1e-9, "{mean} and {porosity}");
    let plate = &readings["plate"];
    let [first, again] = [0, 1].map(|k| number(&plate["stiffness_N_per_m"][k]));
    // a dense bed is no stiffer the second time, and one of three spheres loses a little
    assert!(1e7 < first && 0.75 * first < again && again < 5e8, "{plate}");
    let [ev1, ev2] = [0, 1].map(|k| number(&plate["moduli_Pa"][k]));
    assert!((ev2 / ev1 / (again / first) - 1.0).abs() < 1e-12, "{plate}");
    assert_eq!(number(&plate["sides_m"][0]), 0.3);
    // right under the plate there is its pressure, less what the border of the slab cuts
    let top = number(&plate["loaded"].as_array().unwrap().last().unwrap()["vertical_Pa"]);
    assert!((0.85..1.05).contains(&(top / number(&plate["pressure_Pa"]))), "{top}");
    let forces = &readings["forces"];
    assert!((0.3..0.5).contains(&number(&forces["above"])), "{forces}");
    assert!((0.0..1.0).contains(&number(&forces["mobilised"])), "{forces}");
    let trace: f64 = (0..3).map(|k| number(&readings["directions"]["fabric"]["tensor"][k][k])).sum();
    assert!((trace - 1.0).abs() < 1e-9, "{trace}");
}

#[test]
fn what_cannot_be_packed_is_refused_before_anything_runs() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("box.track");
    fs::write(&scene, SCENE).unwrap();
    let output = pack(&scene, &["--set", "stone.contact=hertz(50 GPa, 0.2)", "--fresh"], "2");
    assert!(!output.status.success() && said(&output).contains("E0610"), "{}", said(&output));
    assert!(said(&output).contains("have `contact = hertz`"), "{}", said(&output));
    let output = pack(&scene, &["--section", "bde", "--fresh"], "2");
    assert!(said(&output).contains("no bed of its own") && said(&output).contains("`bed`"), "{}", said(&output));
    let output = pack(Path::new("scenarios/transition.track"), &["--fresh"], "2");
    assert!(said(&output).contains("this scene has no grains to pack"), "{}", said(&output));
}

#[test]
fn a_damaged_bed_is_told_and_packed_anew() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("box.track");
    fs::write(&scene, SCENE).unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let (cache, out) = (path("cache"), path("bed"));
    let packed = |more: &[&str]| pack(&scene, &[&["--cache", cache.as_str()], more].concat(), "2");
    // two that want the same bed at once: one packs it, the other takes it
    let both: Vec<Output> = std::thread::scope(|scope| {
        let json = || packed(&["--format", "json"]);
        let workers = [scope.spawn(json), scope.spawn(json)];
        workers.into_iter().map(|worker| worker.join().unwrap()).collect()
    });
    assert!(both.iter().all(|output| output.status.success()), "{} {}", said(&both[0]), said(&both[1]));
    assert!(both[0].stdout == both[1].stdout);
    for kind in ["bed", "readings"] {
        let kept = fs::read_dir(&cache).unwrap().map(|entry| entry.unwrap().path());
        let kept: Vec<_> = kept.filter(|path| path.extension().is_some_and(|end| end == kind)).collect();
        let [file] = kept.as_slice() else { panic!("{kept:?}") };
        let mut bytes = fs::read(file).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(file, bytes).unwrap();
        let mended = packed(&["--format", "json"]);
        assert!(mended.status.success() && mended.stdout == both[0].stdout, "{}", said(&mended));
        let told = String::from_utf8_lossy(&mended.stderr).into_owned();
        assert!(told.contains("anew") && told.contains(&format!(".{kind}`")), "{told}");
        assert!(!String::from_utf8_lossy(&packed(&[]).stderr).contains("anew"));
    }
    // a directory that holds a bed holds it until it is told otherwise
    assert!(packed(&["--out", &out]).status.success());
    let again = packed(&["--out", &out]);
    assert!(
        !again.status.success() && said(&again).contains("holds the results of a finished bed"),
        "{}",
        said(&again)
    );
    let forced = packed(&["--out", &out, "--force", "--bays", "2"]);
    assert!(forced.status.success(), "{}", said(&forced));
    let manifest = fs::read_to_string(dir.path().join("bed/manifest.json")).unwrap();
    for name in ["bed.html", "track.vtp", "track.json"] {
        assert!(manifest.contains(&format!("\"{name}\"")), "{manifest}");
    }
}
