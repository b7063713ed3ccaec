//! `trackbed calibrate` as a person uses it: known parameters come back, and every bad curve or wish is told with its
//! place.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trackbed::check::NoModules;
use trackbed::compile;
use trackbed::solvers::settlement::{CyclePer, Form, Law, Peak, Varandas, curve};

const SCENE: &str = "use std
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
track line { sections = [open: 24 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 60 km/h }
traffic { trains = ore, total = 40 axles }
solve { law = laws.varandas_2014, elements_per_bay = 2, time_step = 2e-4 s }
";
const COUNTS: [u64; 7] = [4, 20, 100, 1_000, 10_000, 50_000, 200_000];

fn write(dir: &Path, name: &str, text: &str) -> PathBuf {
    let path = dir.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn calibrate(dir: &Path, scene: &str, measured: &str, more: &[&str]) -> Output {
    let scene = write(dir, "scene.track", scene);
    let measured = write(dir, "curve.csv", measured);
    Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(["calibrate", scene.to_str().unwrap(), "--measured", measured.to_str().unwrap()])
        .args(more)
        .env("NO_COLOR", "1")
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}\n{}", said(output)))
}

/// A curve of the law with gamma = 7 mm and beta = 0.9, times 1 + noise of alternating sign.
fn synthetic(noise: f64) -> String {
    let form = Form::Varandas(Varandas { gamma: 7e-3, beta: 0.9, ..Varandas::default() });
    let law = Law { form, cycle_per: CyclePer::Axle };
    let settled = curve(&law, &[Peak { force: 40e3, deflection: 1e-3, void: 0.0 }], &COUNTS);
    let mut text = "axles,settlement_mm\n".to_string();
    for (k, (axles, settlement)) in COUNTS.iter().zip(settled).enumerate() {
        let sign = [1.0, -1.0, -0.5, 0.8, -1.0, 0.6, -0.2][k];
        text.push_str(&format!("{axles},{}\n", settlement * 1e3 * (1.0 + noise * sign)));
    }
    text
}

#[test]
fn known_parameters_come_back() {
    let dir = tempfile::tempdir().unwrap();
    let found = json(&calibrate(dir.path(), SCENE, &synthetic(0.0), &["--seat-load", "40 kN", "--format", "json"]));
    let value = |name: &str| {
        let all = found["parameters"].as_array().unwrap();
        all.iter().find(|p| p["name"] == name).and_then(|p| p["value"].as_f64()).unwrap()
    };
    assert!((value("gamma") / 7e-3 - 1.0).abs() < 1e-6 && (value("beta") / 0.9 - 1.0).abs() < 1e-6, "{found:#}");
    assert!(found["rms_m"].as_f64().unwrap() < 1e-9);

    let noisy = json(&calibrate(dir.path(), SCENE, &synthetic(0.03), &["--seat-load", "40 kN", "--format", "json"]));
    for (parameter, truth) in noisy["parameters"].as_array().unwrap().iter().zip([7e-3, 0.9]) {
        let (value, error) = (parameter["value"].as_f64().unwrap(), parameter["standard_error"].as_f64().unwrap());
        assert!((value - truth).abs() < 3.0 * error && error < 0.1 * value, "{parameter:#}");
    }
}

/// The declaration that is printed can be pasted, and fits the curve that it came from.
#[test]
fn the_fitted_law_can_be_pasted() {
    let dir = tempfile::tempdir().unwrap();
    for law in ["varandas_2014", "hettler_1984", "nasrollahi_2023", "shenton_1985", "sato_1995", "selig_waters_1994"] {
        let scene = SCENE.replace("varandas_2014", law);
        let output = calibrate(dir.path(), &scene, &synthetic(0.02), &["--seat-load", "40 kN"]);
        assert!(output.status.success(), "{law}: {}", said(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("standard error") && text.contains("% of the largest settlement"), "{text}");
        let declaration = &text[text.find(&format!("law {law}_fitted {{")).unwrap()..];
        let pasted = scene.replace(&format!("laws.{law}"), &format!("{law}_fitted")) + declaration;
        let compiled = compile("pasted.track", &pasted, &NoModules, &[]);
        let told = trackbed::diag::render::human(&compiled.diagnostics, &compiled.sources, false, 120);
        assert!(compiled.graph.is_some() && !told.contains("error"), "{told}");
    }
}

#[test]
fn the_force_comes_from_a_passage_of_the_scene() {
    let dir = tempfile::tempdir().unwrap();
    let found = json(&calibrate(dir.path(), SCENE, &synthetic(0.0), &["--format", "json"]));
    let peaks: Vec<f64> = found["wheel_peaks_N"].as_array().unwrap().iter().map(|p| p.as_f64().unwrap()).collect();
    assert_eq!(peaks.len(), 4);
    assert!(peaks.iter().all(|force| (28e3..42e3).contains(force)), "{peaks:?}");
    let other = json(&calibrate(dir.path(), SCENE, &synthetic(0.0), &["--sleeper", "20", "--format", "json"]));
    assert!(other["force"].as_str().unwrap().ends_with("at sleeper +20"), "{}", other["force"]);
    let none = calibrate(dir.path(), SCENE, &synthetic(0.0), &["--sleeper", "-20"]);
    assert_eq!(none.status.code(), Some(1));
    assert!(said(&none).contains("no ballasted sleeper is called `-20`"), "{}", said(&none));
    let still = SCENE.lines().filter(|l| !l.starts_with("traffic")).collect::<Vec<_>>().join("\n");
    let none = calibrate(dir.path(), &still.replace("train ore", "// train"), &synthetic(0.0), &[]);
    assert!(said(&none).contains("give the force: `--seat-load '40 kN'`"), "{}", said(&none));
}

#[test]
fn bad_curves_are_told_line_by_line() {
    let dir = tempfile::tempdir().unwrap();
    let bad = "axles,settlement_mm\n10,0.5\n5,0.6\n20,deep\n30,-1\n";
    let output = calibrate(dir.path(), SCENE, bad, &["--seat-load", "40 kN"]);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    assert_eq!(text.matches("error E0805").count(), 3, "{text}");
    for place in ["curve.csv:3:1", "curve.csv:4:4", "curve.csv:5:4"] {
        assert!(text.contains(place), "{place}\n{text}");
    }
    let few = calibrate(dir.path(), SCENE, "axles,settlement_mm\n10,0.5\n20,0.6\n", &["--seat-load", "40 kN"]);
    assert!(said(&few).contains("2 measurements are too few, at least 3 are needed"), "{}", said(&few));
    let missing = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(["calibrate", dir.path().join("scene.track").to_str().unwrap(), "--measured", "nowhere.csv"])
        .output()
        .unwrap();
    assert!(
        said(&missing).contains("E0805") && said(&missing).contains("cannot read `nowhere.csv`"),
        "{}",
        said(&missing)
    );
}

#[test]
fn what_cannot_be_fitted_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let with = |scene: &str, more: &[&str]| {
        let output = calibrate(dir.path(), scene, &synthetic(0.0), more);
        assert_ne!(output.status.code(), Some(0), "{}", said(&output));
        said(&output)
    };
    let load = |fit: &'static str| ["--seat-load", "40 kN", "--fit", fit];
    assert!(with(SCENE, &load("gamma,gama,logarithm")).contains("did you mean `gamma`?"));
    assert!(with(SCENE, &load("gamma,gamma")).contains("`gamma` is to be fitted twice"));
    assert!(with(SCENE, &load("gamma,reference_force")).contains("does not tell `gamma` and `reference_force` apart"));
    let sato = SCENE.replace("varandas_2014", "sato_1995");
    assert!(with(&sato, &load("gamma,reference_force")).contains("does not depend on `reference_force`"));
    let nasrollahi = SCENE.replace("varandas_2014", "nasrollahi_2023");
    let below = with(&nasrollahi, &["--seat-load", "30 kN"]);
    assert!(below.contains("30 kN a seat stay below the threshold of law `nasrollahi_2023`, 35 kN"), "{below}");
    for force in ["40", "40 mm", "-3 kN", "kN"] {
        let text = with(SCENE, &["--seat-load", force]);
        assert!(text.contains("--seat-load") || text.contains("unexpected argument"), "{text}");
    }
}

/// A curve that falls behind any power of the count presses its exponent against the bound, and that is said.
#[test]
fn a_parameter_on_its_bound_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let scene = SCENE.replace("laws.varandas_2014", "own")
        + "law own { form = power(a = 1 mm, m = 1, b = 0.3, reference_force = 40 kN per seat) }\n";
    let flat = "axles,settlement_mm\n10,2\n100,2\n1000,2\n10000,2\n";
    let output = calibrate(dir.path(), &scene, flat, &["--seat-load", "40 kN"]);
    assert!(said(&output).contains("rests on its bound"), "{}", said(&output));
}
