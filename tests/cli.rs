//! The binary from end to end, as a person or a script uses it.

use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or(-1)
}

fn write(dir: &Path, name: &str, text: &str) -> PathBuf {
    let path = dir.join(name);
    fs::write(&path, text).unwrap();
    path
}

fn summary(dir: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(dir.join("summary.json")).unwrap()).unwrap()
}

fn scalar(dir: &Path, name: &str) -> f64 {
    summary(dir)[name]["value"].as_f64().unwrap_or_else(|| panic!("no {name}"))
}

/// A transition zone that runs in a moment: 18 m of track, coarse steps, 40 axles.
const SMALL: &str = r#"
use std
trackform open {
  rail = rails.UIC60
  pad = pads.ahmadi_2026
  sleeper = sleepers.B70
  spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 12 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 40 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s }
record { at = [-3, +1] sleepers, after = [0, 40] axles, quantities = [rail_seat_load, contact_force] }
"#;

#[test]
fn the_static_check_meets_the_closed_form() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("run");
    let output = trackbed(&["run", "scenarios/static_check.track", "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    // beam on discrete springs, nodally exact (closed form)
    assert_eq!(format!("{:.4}", scalar(&out, "max_rail_displacement") * 1e3), "0.9498");
    assert_eq!(format!("{:.2}", scalar(&out, "max_rail_moment") / 1e3), "17.66");
    let table = fs::read_to_string(out.join("sleepers.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let column = rows.headers().unwrap().iter().position(|h| h == "max_rail_seat_load_N").unwrap();
    let loads: Vec<f64> = rows.records().map(|r| r.unwrap()[column].parse().unwrap()).collect();
    for (seat, share) in
        [(9, "37.99"), (10, "25.10"), (8, "25.10"), (11, "8.67"), (7, "8.67"), (12, "0.39"), (6, "0.39")]
    {
        assert_eq!(format!("{:.2}", loads[seat] / 1e3), share, "seat {}", seat + 1);
    }
    let sum: f64 = loads.iter().sum();
    assert!((sum / 100e3 - 1.0).abs() < 1e-9, "the pads carry {sum} N");
    assert!(fs::read_to_string(out.join("report.html")).unwrap().contains("<svg"));
}

#[test]
fn equal_runs_give_equal_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(dir.path(), "small.track", SMALL);
    let run = |name: &str| {
        let out = dir.path().join(name);
        let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        out
    };
    let (a, b) = (run("a"), run("b"));
    same_results(&a, &b);
    assert!(!a.join("checkpoint.json").exists());
    for name in [
        "axles",
        "max_settlement",
        "max_settlement_x",
        "far_field_settlement",
        "differential_settlement",
        "max_void",
        "voided_sleepers",
        "max_wheel_force",
        "min_wheel_force",
        "dynamic_amplification",
        "max_rail_seat_load",
        "max_rail_moment",
        "max_contact_force",
        "max_contact_pressure",
        "max_rail_foot_stress",
        "longitudinal_level_d1",
        "longitudinal_level_d1_deviation",
        "loaded_longitudinal_level_d1",
    ] {
        assert!(scalar(&a, name).is_finite(), "{name}");
    }
    assert_eq!(scalar(&a, "axles"), 40.0);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL.replace("speed = 200 km/h", "speed = 200 km/h, direction = both");
    let scene = write(dir.path(), "both.track", &text.replace("update_every = 4 axles", "update_every = adaptive"));
    let run = |threads: &str| {
        let out = dir.path().join(threads);
        let (scene, folder) = (scene.to_str().unwrap(), out.to_str().unwrap());
        let output = trackbed(&["run", scene, "--out", folder, "--threads", threads]);
        assert_eq!(code(&output), 0, "{}", said(&output));
        let timings: Value = serde_json::from_slice(&fs::read(out.join("timings.json")).unwrap()).unwrap();
        assert_eq!(timings["threads"], threads.parse::<f64>().unwrap());
        out
    };
    same_results(&run("1"), &run("2"));
    assert_eq!(code(&trackbed(&["run", scene.to_str().unwrap(), "--out", "nowhere", "--threads", "0"])), 2);
}

#[test]
fn an_overshooting_run_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let law = "law fresh : laws.varandas_2014 { form.gamma = 100 mm }\nsolve { law = fresh, update_every = 40 axles";
    let scene = write(dir.path(), "fresh.track", &SMALL.replace("solve { update_every = 4 axles", law));
    let out = dir.path().join("run");
    let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    assert!(
        said(&output).contains("E0807") && said(&output).contains("repeated with half the length"),
        "{}",
        said(&output)
    );
    assert!(scalar(&out, "overshot_blocks") > 0.0 && scalar(&out, "max_overshoot") > 0.0);
    assert!(fs::read_to_string(out.join("report.html")).unwrap().contains("repeated with half the length"));
}

/// Everything but `timings.json` is equal to the last bit.
fn same_results(a: &Path, b: &Path) {
    for name in
        ["summary.json", "sleepers.csv", "blocks.csv", "rail.csv", "histories.parquet", "scenario.json", "report.html"]
    {
        assert!(fs::read(a.join(name)).unwrap() == fs::read(b.join(name)).unwrap(), "{name} differs");
    }
}

#[test]
fn a_killed_run_resumes_with_the_same_bits() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL.replace("40 axles", "400 axles");
    let scene = write(dir.path(), "small.track", &text);
    let (scene, whole, killed) = (scene.to_str().unwrap(), dir.path().join("whole"), dir.path().join("killed"));
    assert_eq!(code(&trackbed(&["run", scene, "--out", whole.to_str().unwrap()])), 0);

    let out = killed.to_str().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(["run", scene, "--out", out])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !killed.join(".trackbed/pieces/so-far").exists() && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!killed.join("summary.json").exists(), "the run was over before it could be killed");

    // where nothing is yet there is no page
    let empty = trackbed(&["report", dir.path().to_str().unwrap()]);
    assert_eq!(code(&empty), 2);
    assert!(said(&empty).contains("holds no results"), "{}", said(&empty));
    // what there is so far is shown, and said to be that
    let told = trackbed(&["report", out]);
    assert_eq!(code(&told), 0, "{}", said(&told));
    let (told, page) = (String::from_utf8_lossy(&told.stdout).into_owned(), killed.join("so_far.html"));
    assert!(told.contains("so_far.html") && told.contains(" of 400 axles after "), "{told}");
    let shown = fs::read_to_string(&page).unwrap();
    assert!(shown.contains("Not finished") && shown.contains(" of 400 axles after "));
    assert!(shown.contains("id=\"headline\"") && !killed.join("report.html").exists());

    // without --resume nothing is overwritten
    let refused = trackbed(&["run", scene, "--out", out]);
    assert_eq!(code(&refused), 1);
    assert!(said(&refused).contains("E0802"), "{}", said(&refused));
    // another scene is refused
    let other = write(dir.path(), "other.track", &text.replace("0.6 m", "0.65 m"));
    let refused = trackbed(&["run", other.to_str().unwrap(), "--out", out, "--resume"]);
    assert_eq!(code(&refused), 1);
    assert!(said(&refused).contains("E0809"), "{}", said(&refused));

    let resumed = trackbed(&["run", scene, "--out", out, "--resume"]);
    assert_eq!(code(&resumed), 0, "{}", said(&resumed));
    same_results(&whole, &killed);
    assert!(!page.exists());
    let parts = |out: &Path| {
        let timings: Value = serde_json::from_slice(&fs::read(out.join("timings.json")).unwrap()).unwrap();
        assert!(timings["total_s"].as_f64() >= timings["solve_s"].as_f64());
        timings["parts"].as_f64()
    };
    assert_eq!((parts(&whole), parts(&killed)), (Some(1.0), Some(2.0)));
}

/// Ctrl-C in a terminal, SIGTERM of a scheduler.
#[cfg(unix)]
#[test]
fn a_run_that_is_asked_to_stop_keeps_what_it_has_and_says_how_to_go_on() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(dir.path(), "small.track", &SMALL.replace("40 axles", "2000 axles"));
    let (scene, out) = (scene.to_str().unwrap(), dir.path().join("out"));
    for (signal, more) in [("-INT", None), ("-TERM", Some("--resume"))] {
        let arguments = ["run", scene, "--out", out.to_str().unwrap()].into_iter().chain(more);
        let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        let mut child = child.args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let (mut stderr, mut said) = (BufReader::new(child.stderr.take().unwrap()), String::new());
        let listens = |said: &str| match more {
            Some(_) => said.contains("goes on after "),
            None => out.join(".trackbed/pieces/so-far").exists(),
        };
        while !listens(&said) {
            if more.is_some() {
                assert!(stderr.read_line(&mut said).unwrap() > 0, "{said}");
            }
        }
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        stderr.read_to_string(&mut said).unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(1), "it ends by itself: {said}");
        assert!(said.contains("to go on, run the same command with `--resume`"), "{said}");
        assert!(!out.join("summary.json").exists());
        // the page of what there is so far shows that something was kept
        let told = trackbed(&["report", out.to_str().unwrap()]);
        let told = String::from_utf8(told.stdout).unwrap();
        assert!(told.contains(" of 2000 axles after "), "{told}");
    }
}

#[test]
fn a_missed_expectation_is_named_and_sets_the_exit_code() {
    let dir = tempfile::tempdir().unwrap();
    let text = format!("{SMALL}\nexpect {{ that = [max(settlement) < 1e-6 mm, max(wheel_force) > 10 kN] }}\n");
    let scene = write(dir.path(), "small.track", &text);
    let out = dir.path().join("run");
    let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 1);
    assert!(said(&output).contains("E0804") && said(&output).contains("max(settlement)"), "{}", said(&output));
    assert!(!said(&output).contains("expected `max(wheel_force)"), "{}", said(&output));
    let verdicts = summary(&out)["expectations"].clone();
    assert_eq!((verdicts[0]["met"].as_bool(), verdicts[1]["met"].as_bool()), (Some(false), Some(true)));
}

/// A table of numbers, column by column.
fn columns(path: &Path) -> std::collections::HashMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let column = |i: usize| rows.iter().map(|row| row[i].parse().unwrap_or(f64::NAN)).collect();
    header.iter().enumerate().map(|(i, name)| (name.to_owned(), column(i))).collect()
}

/// The rail's profile: its table, the responses made of it and what a scene without a `record` keeps.
#[test]
fn the_rail_is_profiled_and_a_record_is_not_needed() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL.lines().filter(|line| !line.starts_with("record")).collect::<Vec<_>>().join("\n");
    let text = format!(
        "{text}\nexpect {{\n that = [\n min(rail_stiffness, over = -4 .. -3 m) > 60 MN/m\n max(rail_stiffness) < 100 MN/m\n \
         max(contact_pressure) < 0.5 MPa\n -3 m < place_of_max(contact_pressure) < 0 m\n \
         max(rail_stiffness, after = 0 axles) > mean(rail_stiffness, after = 0 axles)\n ]\n}}\n"
    );
    let scene = write(dir.path(), "small.track", &text);
    let out = dir.path().join("run");
    let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    let verdicts = summary(&out)["expectations"].clone();
    assert_eq!(code(&output), 0, "{}\n{verdicts:#}", said(&output));

    let rail = columns(&out.join("rail.csv"));
    let after = |name: &str, axles: f64| -> Vec<f64> {
        rail["axles"].iter().zip(&rail[name]).filter(|(a, _)| **a == axles).map(|(_, value)| *value).collect()
    };
    let (x, first, last) = (after("x_m", 0.0), after("stiffness_N_per_m", 0.0), after("stiffness_N_per_m", 40.0));
    // four places in each bay, seats and the middles of bays among them
    assert!(x.windows(2).all(|pair| (pair[1] - pair[0] - 0.15).abs() < 1e-9));
    let at = |values: &[f64], place: f64| values[x.iter().position(|x| (x - place).abs() < 1e-9).unwrap()];
    assert!(at(&first, -3.6) > at(&first, -3.3), "stiffer over a sleeper than between two");
    // voids beside the slab make the track softer there, and no softer where nothing hangs
    assert!(at(&last, -0.6) < 0.99 * at(&first, -0.6) && (at(&last, -4.8) / at(&first, -4.8) - 1.0).abs() < 0.01);
    // the largest moment of the table is that of the summary, but for nodes between its places
    let moments = after("max_moment_N_m", 40.0);
    let largest = moments.iter().copied().fold(0.0, f64::max);
    assert!((largest / scalar(&out, "max_rail_moment") - 1.0).abs() < 0.05);
    assert!(scalar(&out, "longitudinal_level_d1") < scalar(&out, "max_settlement"));

    let plan = summary(&out)["provenance"]["plan"].as_str().unwrap().to_owned();
    assert!(plan.contains("pass record: histories at seats -13, -5, -3, -1, +1, +7"), "{plan}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    for id in [
        "rail_stiffness",
        "longitudinal_level",
        "rail_moment",
        "wheel_force",
        "history_rail_seat_load",
        "hanging_sleeper",
    ] {
        assert!(page.contains(&format!("<section id=\"{id}\">")), "{id}");
    }
}

#[test]
fn check_speaks_json() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(dir.path(), "bad.track", "use std\n\ntrack line { sections = [open: 42] }\n");
    let output = trackbed(&["check", scene.to_str().unwrap(), "--format", "json"]);
    assert_eq!(code(&output), 1);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let found = json["diagnostics"].as_array().unwrap();
    let unit = found.iter().find(|d| d["code"] == "E0301").expect("the missing unit is found");
    assert_eq!(unit["severity"], "error");
    assert_eq!(unit["start"], serde_json::json!({"line": 3, "column": 32}));
    assert_eq!(unit["end"], serde_json::json!({"line": 3, "column": 34}));
    assert!(unit["file"].as_str().unwrap().ends_with("bad.track"));
    assert!(unit["help"].as_str().unwrap().contains("42"));
}

#[test]
fn wrong_usage_exits_with_two() {
    for arguments in [
        &["check"][..],
        &["check", "no/such.track"],
        &["explain", "E9999"],
        &["docs", "rial"],
        &["run", "x.track"],
        &["sing"],
    ] {
        let output = trackbed(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", said(&output));
    }
    assert!(said(&trackbed(&["docs", "rial"])).contains("did you mean `rail`?"));
    assert_eq!(code(&trackbed(&["--help"])), 0);
}

#[test]
fn what_cannot_be_read_gets_a_diagnostic() {
    let dir = tempfile::tempdir().unwrap();
    let cases: [(&str, Vec<u8>, &str); 4] = [
        ("empty.track", Vec::new(), "E0601"),
        ("binary.track", vec![0x7f, b'E', b'L', b'F', 0, 0xff, 0xfe, 0x80], "E0102"),
        ("deep.track", [b"rail r { mass = ".as_slice(), &[b'('; 100_000]].concat(), "E0103"),
        ("cycle.track", b"use std\nrail a : b { }\nrail b : a { }\n".to_vec(), "E0203"),
    ];
    for (name, bytes, expected) in cases {
        let path = dir.path().join(name);
        fs::write(&path, bytes).unwrap();
        for command in [&["check"][..], &["run", "--out", "nowhere"], &["plan"]] {
            let arguments: Vec<&str> = [&command[..1], &[path.to_str().unwrap()], &command[1..]].concat();
            let output = trackbed(&arguments);
            assert_eq!(code(&output), 1, "{arguments:?}: {}", said(&output));
            assert!(said(&output).contains(expected), "{arguments:?}: {}", said(&output));
        }
    }
    assert!(!Path::new("nowhere").exists(), "a refused run leaves nothing behind");
}

#[test]
fn a_new_scene_checks_plans_and_is_laid_out() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mine.track");
    let name = path.to_str().unwrap();
    assert_eq!(code(&trackbed(&["new", name])), 0);
    assert_eq!(code(&trackbed(&["new", name])), 2, "an existing file is not overwritten");
    let checked = trackbed(&["check", name]);
    assert_eq!(code(&checked), 0, "{}", said(&checked));
    assert!(!said(&checked).contains("warning"), "{}", said(&checked));
    assert_eq!(code(&trackbed(&["fmt", "--check", name])), 0);
    let plan = trackbed(&["plan", name]);
    assert!(said(&plan).contains("10000 axles"), "{}", said(&plan));
    assert_eq!(code(&trackbed(&["plan", name, "--format", "json"])), 0);
    assert!(said(&trackbed(&["plan", name, "--format", "dot"])).contains("digraph"));
}

#[test]
fn shipped_files_are_laid_out() {
    for folder in ["scenarios", "stdlib"] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|e| e != "track") {
                continue;
            }
            let output = trackbed(&["fmt", "--check", path.to_str().unwrap()]);
            assert_eq!(code(&output), 0, "{}", said(&output));
        }
    }
}

#[test]
fn a_value_set_on_the_command_line_counts_as_written() {
    let output = trackbed(&["plan", "scenarios/transition.track", "--set", "traffic.total=1000 axles"]);
    assert!(said(&output).contains("1000 axles in 50 blocks"), "{}", said(&output));
    let output = trackbed(&["check", "scenarios/transition.track", "--set", "open.pad.stiffness=40 kN"]);
    assert_eq!(code(&output), 1);
    assert!(said(&output).contains("E0302"), "{}", said(&output));
}

#[test]
fn a_seed_on_the_command_line_is_that_of_the_scene() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL.replace("50 MN/m per seat", "random(50 MN/m per seat, cov = 10 %)");
    // whatever its `solve` is called
    let scene = write(dir.path(), "small.track", &text.replace("solve {", "solve coarse {"));
    let scene = scene.to_str().unwrap();
    let run = |name: &str, more: &[&str]| {
        let out = dir.path().join(name);
        let output = trackbed(&[&["run", scene, "--out", out.to_str().unwrap()], more].concat());
        assert_eq!(code(&output), 0, "{}", said(&output));
        (summary(&out)["provenance"]["seed"].clone(), fs::read(out.join("sleepers.csv")).unwrap())
    };
    let (seed, table) = run("seed", &["--seed", "7"]);
    assert_eq!(seed, 7);
    assert!((seed, table.clone()) == run("set", &["--set", "solve.seed=7"]), "it is the same line");
    assert!(table != run("own", &[]).1);
    assert!(said(&trackbed(&["run", "--help"])).contains("--seed <N>"));
    assert!(said(&trackbed(&["study", "--help"])).contains("--seed <N>"));
}

#[test]
fn the_report_can_be_made_again() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("run");
    assert_eq!(code(&trackbed(&["run", "scenarios/static_check.track", "--out", out.to_str().unwrap()])), 0);
    let page = fs::read(out.join("report.html")).unwrap();
    fs::remove_file(out.join("report.html")).unwrap();
    assert_eq!(code(&trackbed(&["report", out.to_str().unwrap()])), 0);
    assert!(fs::read(out.join("report.html")).unwrap() == page);
    assert_eq!(code(&trackbed(&["report", dir.path().to_str().unwrap()])), 2);
}

#[test]
fn a_track_that_nothing_holds_ends_in_a_diagnostic() {
    let dir = tempfile::tempdir().unwrap();
    let text = fs::read_to_string("scenarios/static_check.track").unwrap();
    let text = text.replace("20 sleepers", "1 sleeper").replace("at = 10 sleepers", "at = 1 sleeper");
    let scene = write(dir.path(), "one.track", &text);
    let out = dir.path().join("run");
    let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code(&output), 1);
    let said = said(&output);
    assert!(said.contains("E0801") && said.contains("x = 0.6 m") && said.contains("rail_ends = clamped"), "{said}");
    assert!(!out.join("summary.json").exists(), "no result without an equilibrium");
}

#[test]
fn a_silenced_rule_is_silent_and_the_report_says_why() {
    let dir = tempfile::tempdir().unwrap();
    let warned = write(dir.path(), "warned.track", SMALL);
    assert!(said(&trackbed(&["check", warned.to_str().unwrap()])).contains("L1003"));
    let text = format!("scenario {{ allow = [track_too_short: \"a <test> track\"] }}\n{SMALL}");
    let scene = write(dir.path(), "silenced.track", &text);
    let out = dir.path().join("run");
    let output = trackbed(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(code(&output) == 0 && !said(&output).contains("L1003"), "{}", said(&output));
    assert!(fs::read_to_string(out.join("report.html")).unwrap().contains("a &lt;test&gt; track"));
    let denied = write(dir.path(), "denied.track", &format!("scenario {{ deny = track_too_short }}\n{SMALL}"));
    assert_eq!(code(&trackbed(&["check", denied.to_str().unwrap()])), 1);
}

/// A track on cells, on two packings.
const PACKINGS: &str = "use std
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
solve { substructure = cells, repeats = 2, update_every = 4 axles }
record { at = [-2, -1, +1] sleepers, after = [0, 4] axles, quantities = rail_seat_load }
";

#[test]
fn a_track_on_two_packings_shows_both_and_their_scatter() {
    let folder = tempfile::tempdir().unwrap();
    let scene = write(folder.path(), "scene.track", PACKINGS);
    let (out, beds) = (folder.path().join("out"), folder.path().join("beds"));
    let run = |further: &[&str]| {
        let [scene, out, beds] = [&scene, &out, &beds].map(|path| path.to_str().unwrap());
        trackbed(&[&["run", scene, "--out", out, "--cache", beds], further].concat())
    };
    let first = run(&[]);
    assert_eq!(code(&first), 0, "{}", said(&first));
    let [a, b] = [&out, &out.join("packings/2")].map(|folder| scalar(folder, "max_settlement"));
    assert!(a != b, "two packings settle otherwise: {a} {b}");
    assert!((scalar(&out, "max_settlement_mean") / (0.5 * (a + b)) - 1.0).abs() < 1e-9);
    assert!((scalar(&out, "max_settlement_deviation") / ((a - b).abs() / 2f64.sqrt()) - 1.0).abs() < 1e-9);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Over packings") && page.contains("another packing of the same grains"));
    // what is finished is not computed again, and the page can be made anew
    let again = run(&["--resume"]);
    assert!(said(&again).contains("finished before"), "{}", said(&again));
    let report = trackbed(&["report", out.to_str().unwrap()]);
    assert_eq!(code(&report), 0, "{}", said(&report));
    assert_eq!(fs::read_to_string(out.join("report.html")).unwrap(), page);
}
