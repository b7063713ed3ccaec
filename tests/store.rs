//! Directories of results as a person has them: killed, finished, damaged, shared, and full of other things.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use trackbed::store::{Directory, Mode, Work};

mod common {
    pub mod program;
}
use common::program::{said, trackbed};

/// 21 m of track under one wagon, and a study of six points.
const SCENE: &str = r#"use std
scenario { title = "small", allow = [stiffness_jump: "small", track_too_short: "small", critical_speed: "small", wheel_on_track: "small"] }
trackform open {
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = { stiffness = 50 MN/m per seat, damping_time = 1 ms }
}
trackform stiff : open { sleeper = none, support = none, slab = slabs.half_width_1600 }
track line { sections = [open: 12 m, stiff: 9 m] }
train ore { vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }
traffic { trains = ore, total = 8 axles }
solve { update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s, law = laws.varandas_2014 }
study slab_pads {
  vary = [stiff.pad.stiffness: [20, 30, 40, 60, 80, 100] MN/m]
  minimise = max(settlement)
}
"#;

struct Study {
    folder: tempfile::TempDir,
}

impl Study {
    fn new() -> Study {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("small.track"), SCENE).unwrap();
        Study { folder }
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    fn arguments(&self, more: &[&str]) -> Vec<String> {
        let file = self.folder.path().join("small.track").display().to_string();
        let fixed = ["study".to_string(), file, "--jobs".into(), "1".into(), "--out".into()];
        let out = [self.out().display().to_string()];
        fixed.into_iter().chain(out).chain(more.iter().map(|s| s.to_string())).collect()
    }

    fn run(&self, more: &[&str]) -> Output {
        trackbed(&self.arguments(more).iter().map(String::as_str).collect::<Vec<_>>())
    }

    fn spawn(&self, more: &[&str]) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        command.args(self.arguments(more)).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    fn kept(&self) -> usize {
        self.out()
            .join(".trackbed/pieces")
            .read_dir()
            .map_or(0, |entries| entries.flatten().filter(|entry| entry.path().extension().is_none()).count())
    }

    /// Starts it, waits until it has kept so many points, and gives it back running.
    fn until(&self, kept: usize, more: &[&str]) -> Child {
        let mut child = self.spawn(more);
        let started = Instant::now();
        while self.kept() < kept && child.try_wait().unwrap().is_none() && started.elapsed() < Duration::from_secs(120)
        {
            std::thread::sleep(Duration::from_millis(1));
        }
        child
    }
}

impl Study {
    /// Leaves it killed with so many points. On a busy machine it may end before it is killed: then it begins anew.
    fn interrupt(&self, kept: usize) {
        while self.kept() < kept {
            let _ = fs::remove_dir_all(self.out());
            kill(self.until(kept, &[]));
        }
    }
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

fn fails_with(output: &Output, code: &str, words: &str) {
    let text = said(output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains(code) && text.contains(words), "{text}");
}

fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_study_that_is_killed_again_and_again_ends_with_the_same_files() {
    let (whole, cut) = (Study::new(), Study::new());
    let output = whole.run(&[]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    cut.interrupt(1);
    for points in 2..6 {
        kill(cut.until(points, &["--resume"]));
    }
    let output = cut.run(&["--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    for name in ["study.csv", "study.json", "study.html", "design.json", "points.json", "manifest.json"] {
        assert!(fs::read(whole.out().join(name)).unwrap() == fs::read(cut.out().join(name)).unwrap(), "{name}");
    }
}

#[test]
fn a_finished_study_is_resumed_to_its_own_answer_and_checked() {
    let study = Study::new();
    let first = study.run(&[]);
    assert_eq!(first.status.code(), Some(0), "{}", said(&first));
    let table = fs::read(study.out().join("study.csv")).unwrap();
    fails_with(&study.run(&[]), "E0802", "holds the results of a finished study `slab_pads`");
    let again = study.run(&["--resume"]);
    assert_eq!(again.status.code(), Some(0), "{}", said(&again));
    assert!(said(&again).contains("finished before") && said(&again).contains("best: point"), "{}", said(&again));
    let told = trackbed(&["report", study.out().to_str().unwrap()]);
    assert_eq!(told.status.code(), Some(0), "{}", said(&told));
    assert!(said(&told).contains("Its page is") && said(&told).contains("study.html"), "{}", said(&told));
    fails_with(&study.run(&["--resume", "--set", "ore.speed=190 km/h"]), "E0809", "belongs to another scene");
    // a file that is gone or changed is named, whichever it is
    fs::remove_file(study.out().join("design.json")).unwrap();
    fails_with(&study.run(&["--resume", "--set", "ore.speed=190 km/h"]), "E0809", "belongs to another scene");
    fails_with(&study.run(&["--resume"]), "E0802", "design.json");
    // `--force` replaces what is the study's, and nothing else
    fs::write(study.out().join("notes.txt"), "mine").unwrap();
    damage(&study.out().join("study.csv"));
    let forced = study.run(&["--force"]);
    assert_eq!(forced.status.code(), Some(0), "{}", said(&forced));
    assert!(fs::read(study.out().join("study.csv")).unwrap() == table);
    assert_eq!(fs::read_to_string(study.out().join("notes.txt")).unwrap(), "mine");
    damage(&study.out().join("study.csv"));
    fails_with(&study.run(&["--resume"]), "E0802", "study.csv");
}

#[test]
fn a_point_stands_for_what_it_is_made_of() {
    let study = Study::new();
    study.interrupt(2);
    let pieces = study.out().join(".trackbed/pieces");
    let mut names: Vec<PathBuf> = pieces.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    names.retain(|path| path.extension().is_none());
    names.sort();
    // one point under the name of another
    fs::copy(&names[0], &names[1]).unwrap();
    let output = study.run(&["--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(said(&output).matches("runs again").count(), 1, "{}", said(&output));
    let whole = Study::new();
    assert_eq!(whole.run(&[]).status.code(), Some(0));
    assert!(fs::read(study.out().join("points.json")).unwrap() == fs::read(whole.out().join("points.json")).unwrap());
}

#[test]
fn whose_points_they_are_is_asked_even_where_the_answer_is_gone() {
    let study = Study::new();
    study.interrupt(1);
    fs::remove_file(study.out().join(".trackbed/work")).unwrap();
    fails_with(&study.run(&["--resume", "--set", "ore.speed=190 km/h"]), "E0802", "work");
    assert_eq!(study.run(&["--force"]).status.code(), Some(0));
}

#[test]
fn two_do_not_work_in_one_directory() {
    let study = Study::new();
    let work = Work { name: "run".into(), scene_sha256: "abc".into() };
    let other = Directory::open(&study.out(), work, Mode::New).unwrap();
    for more in [&[][..], &["--resume"], &["--force"]] {
        fails_with(&study.run(more), "E0802", "another process is working in");
    }
    drop(other);
    assert_eq!(study.run(&[]).status.code(), Some(0));
}

#[test]
fn other_peoples_files_are_not_mixed_with_results() {
    let study = Study::new();
    fs::create_dir(study.out()).unwrap();
    fs::write(study.out().join("summary.json"), "{}").unwrap();
    for more in [&[][..], &["--resume"]] {
        fails_with(&study.run(more), "E0802", "`summary.json`");
    }
    assert!(!study.out().join(".trackbed").exists());
}
