//! What goes wrong around the program and is no mistake of its scene: disks, clocks, signals, memory, damage. Each test
//! would fail without the guard that it is about. `cargo run --release --example faults -- 1000` kills every coupled
//! tier a thousand times.

#[path = "../common/coarse_cells.rs"]
mod coarse_cells;
mod damage;
mod disks;
mod memory;
#[path = "../common/program.rs"]
mod program;
mod signals;

use program::{said, trackbed};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// A transition zone that runs in a moment, so many axles long.
fn on_a_law(axles: u32) -> String {
    format!(
        "use std
trackform open {{
  rail = rails.UIC60, pad = pads.ahmadi_2026, sleeper = sleepers.B70, spacing = 0.6 m
  support = {{ stiffness = 50 MN/m per seat, damping_time = 1 ms }}
}}
trackform stiff : open {{ sleeper = none, support = none, slab = slabs.half_width_1600 }}
track line {{ sections = [open: 12 m, stiff: 12 m] }}
train ore {{ vehicles = vehicles.ore_wagon_20t, speed = 200 km/h }}
traffic {{ trains = ore, total = {axles} axles }}
solve {{ update_every = 4 axles, elements_per_bay = 2, time_step = 2e-4 s }}
record {{ at = [-3, +1] sleepers, after = 0 axles, quantities = rail_seat_load }}
"
    )
}

/// A scene and the directories beside it.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new(scene: &str) -> Place {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.track"), scene).unwrap();
        Place { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `trackbed run` into one of its directories, with its own beds.
    fn words(&self, out: &str, more: &[&str]) -> Vec<String> {
        let [scene, out, beds] = ["scene.track", out, "beds"].map(|name| self.path(name).display().to_string());
        let words = ["run".to_owned(), scene, "--out".to_owned(), out, "--cache".to_owned(), beds];
        words.into_iter().chain(more.iter().map(|word| (*word).to_owned())).collect()
    }

    fn run(&self, out: &str, more: &[&str]) -> Output {
        trackbed(&self.words(out, more).iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// A run that comes to its end.
    fn finish(&self, out: &str, more: &[&str]) {
        let output = self.run(out, more);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    }

    fn start(&self, out: &str, more: &[&str]) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        command.args(self.words(out, more)).env("NO_COLOR", "1");
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }

    /// Kills a run as soon as it has kept a state.
    fn killed(&self, out: &str) {
        let mut child = self.start(out, &[]);
        wait_for(&mut child, &self.path(out).join(".trackbed/checkpoint"));
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!self.path(out).join("summary.json").exists(), "the run was over before it could be killed");
    }
}

/// Waits until a run has written a file.
fn wait_for(child: &mut Child, file: &Path) {
    while !file.exists() {
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it wrote {}", file.display());
        std::thread::yield_now();
    }
}

/// What a program said, without the breaks of its lines.
fn in_one_line(output: &Output) -> String {
    said(output).replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Fails unless a program was refused with a code and these words.
fn refused(output: &Output, words: &[&str]) {
    let told = in_one_line(output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    words.iter().for_each(|word| assert!(told.contains(word), "{word}: {told}"));
}

/// All results of a directory but timings.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = entries.filter(|path| path.is_file() && !path.ends_with("timings.json"));
    files.map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(&path).unwrap())).collect()
}

fn same_results(one: &Path, other: &Path) {
    let (one, other) = (results(one), results(other));
    assert!(one.keys().eq(other.keys()), "{:?} {:?}", one.keys(), other.keys());
    one.iter().for_each(|(name, bytes)| assert!(other[name] == *bytes, "{name} differs"));
}
