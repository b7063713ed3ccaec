//! What broke the parser, the formatter, the checker or a reader of files once, and some texts and files that nobody
//! would write.

#[path = "../fuzz/bytes.rs"]
mod bytes;
#[path = "../fuzz/dice.rs"]
mod dice;
#[path = "../fuzz/files.rs"]
mod files;
#[path = "../fuzz/mutate.rs"]
mod mutate;
#[path = "../fuzz/targets.rs"]
mod targets;
#[path = "../fuzz/watchdog.rs"]
mod watchdog;

use std::path::Path;
use std::time::Duration;
use watchdog::Watchdog;

/// A text or file that takes longer hangs, and ends the tests with its number.
const LONGEST: Duration = Duration::from_secs(300);

fn each(target: fn(&str)) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    let watchdog = Watchdog::start(LONGEST, |_| ());
    for (number, entry) in std::fs::read_dir(corpus).unwrap().enumerate() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        watchdog.watched(number as u64, || target(&text));
    }
    let seeds = [include_str!("../scenarios/transition.track"), include_str!("../scenarios/static_check.track")];
    (0..1500).for_each(|k| watchdog.watched(k, || target(&mutate::text(&seeds, k))));
    (0..1500).for_each(|k| watchdog.watched(k, || target(&mutate::piece(&seeds, k))));
}

#[test]
fn parsing_survives() {
    each(targets::parse);
}

#[test]
fn formatting_survives() {
    each(targets::format);
}

#[test]
fn checking_survives() {
    each(targets::check);
}

/// Files that are damaged anywhere are read as what they say, in finite numbers, or refused.
fn each_file(name: &str, runs: u64) {
    let target = files::Target::named(name).unwrap();
    target.read_seeds();
    let watchdog = Watchdog::start(LONGEST, |_| ());
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/files");
    for entry in std::fs::read_dir(corpus).unwrap() {
        let path = entry.unwrap().path();
        let file = path.file_name().unwrap().to_string_lossy().into_owned();
        let mut parts = file.split('-');
        if parts.next() == Some(name) {
            let seed = parts.next().and_then(|part| part.parse().ok()).unwrap();
            watchdog.watched(0, || target.read(seed, &std::fs::read(&path).unwrap()));
        }
    }
    for k in 0..runs {
        let (seed, bytes) = target.file(k);
        watchdog.watched(k, || target.read(seed, &bytes));
    }
}

#[test]
fn reading_surfaces_survives() {
    each_file("stl", 1000);
}

#[test]
fn reading_tables_survives() {
    each_file("csv", 500);
}

#[test]
fn reading_results_survives() {
    each_file("results", 150);
}

#[test]
fn reading_checkpoints_survives() {
    each_file("checkpoint", 100);
}

#[test]
fn reading_beds_survives() {
    each_file("bed", 100);
}
