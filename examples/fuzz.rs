//! Throws texts and files at what reads them that nobody would write.
//!
//! ```sh
//! cargo run --release --example fuzz -- parse 1000000
//! cargo run --release --example fuzz -- check 1000000 --from 5000000
//! cargo run --release --example fuzz -- stl 1000000
//! cargo run --release --example fuzz -- show-piece 879
//! ```
//!
//! Run `k` is the same everywhere, so a run that ends the program (a stack that overflows) is found again by its
//! number. What fails is written to `fuzz/corpus`, or to `fuzz/files` where it is no text of the language; the tests
//! replay both.

#[path = "../fuzz/bytes.rs"]
mod bytes;
#[path = "../fuzz/dice.rs"]
mod dice;
#[path = "../fuzz/files.rs"]
mod files;
#[path = "../fuzz/memory.rs"]
mod memory;
#[path = "../fuzz/mutate.rs"]
mod mutate;
#[path = "../fuzz/targets.rs"]
mod targets;
#[path = "../fuzz/watchdog.rs"]
mod watchdog;

use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use watchdog::Watchdog;

/// Targets that read files.
const FILES: [&str; 5] = ["stl", "csv", "results", "checkpoint", "bed"];
/// Runs between two lines of progress.
const CHUNK: u64 = 20_000;
/// A run that takes longer hangs: the slowest checks take seconds.
const LONGEST: Duration = Duration::from_secs(60);
/// Memory that one run may ask for beyond what any before it did, MiB: files are shorter than a quarter of one.
const MORE: f64 = 256.0;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let name = arguments.first().map(String::as_str).unwrap_or_default();
    let number = |text: Option<&String>| text.and_then(|t| t.parse::<u64>().ok());
    let runs = number(arguments.get(1)).unwrap_or(1_000_000);
    let from = arguments.iter().position(|a| a == "--from").and_then(|i| number(arguments.get(i + 1))).unwrap_or(0);
    let show = |text: Text| println!("{}", text(&borrowed(&seeds(root())), runs));
    let text: Option<(Text, Holds)> = match name {
        "show-piece" => return show(mutate::piece),
        "show-text" => return show(mutate::text),
        "parse" => Some((mutate::piece, targets::parse)),
        "format" => Some((mutate::piece, targets::format)),
        // names must be found, so that numbers are looked at
        "check" => Some((mutate::text, targets::check)),
        _ => None,
    };
    let failed = match (text, files::Target::named(name)) {
        (Some((text, target)), _) => texts(name, text, target, from..from + runs),
        (None, Some(target)) => of_files(name, &target, from..from + runs),
        (None, None) => {
            let names = FILES.join("|");
            return eprintln!(
                "usage: fuzz parse|format|check|{names} RUNS [--from NUMBER], or show-piece|show-text RUN"
            );
        }
    };
    std::process::exit(i32::from(failed > 0));
}

/// Makes the text of a run.
type Text = fn(&[&str], u64) -> String;
/// Asserts what must hold of a text.
type Holds = fn(&str);

/// Texts on all cores.
fn texts(name: &str, text: Text, target: fn(&str), runs: std::ops::Range<u64>) -> u64 {
    let owned = seeds(root());
    let seeds = borrowed(&owned);
    let named = name.to_owned();
    let watchdog = Watchdog::start(LONGEST, move |k| {
        keep(&format!("fuzz/corpus/{named}-{k}.track"), text(&borrowed(&self::seeds(root())), k).as_bytes());
    });
    let (failed, started) = (AtomicU64::new(0), Instant::now());
    for start in runs.clone().step_by(CHUNK as usize) {
        let end = (start + CHUNK).min(runs.end);
        (start..end).into_par_iter().for_each(|k| {
            let text = text(&seeds, k);
            if watchdog.watched(k, || catch_unwind(|| target(&text))).is_err() {
                failed.fetch_add(1, Ordering::Relaxed);
                keep(&format!("fuzz/corpus/{name}-{k}.track"), text.as_bytes());
            }
        });
        tell(end - runs.start, &runs, failed.load(Ordering::Relaxed), started);
    }
    failed.into_inner()
}

/// Files on one core, so that the memory of each is seen.
fn of_files(name: &str, target: &files::Target, runs: std::ops::Range<u64>) -> u64 {
    target.read_seeds();
    let (mut failed, started, mut most) = (0, Instant::now(), memory::peak());
    let watchdog = Watchdog::start(LONGEST, |_| ());
    for k in runs.clone() {
        let (seed, bytes) = target.file(k);
        let survived = watchdog.watched(k, || catch_unwind(AssertUnwindSafe(|| target.read(seed, &bytes)))).is_ok();
        let peak = memory::peak();
        if !survived || peak > most + MORE {
            eprintln!("file {k} of seed {seed}: {}", if survived { "memory out of proportion" } else { "panic" });
            failed += 1;
            keep(&format!("fuzz/files/{name}-{seed}-{k}"), &bytes);
        }
        most = most.max(peak);
        let done = k + 1 - runs.start;
        if done.is_multiple_of(CHUNK) || k + 1 == runs.end {
            tell(done, &runs, failed, started);
        }
    }
    failed
}

fn tell(done: u64, runs: &std::ops::Range<u64>, failed: u64, started: Instant) {
    let (all, rate) = (runs.end - runs.start, done as f64 / started.elapsed().as_secs_f64());
    eprintln!("{done} of {all} runs, {failed} failed, {rate:.0} a second, {:.0} MiB", memory::resident());
}

fn keep(name: &str, bytes: &[u8]) {
    let path = root().join(name);
    let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    if let Err(error) = made.and_then(|()| std::fs::write(&path, bytes)) {
        eprintln!("{}: {error}", path.display());
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn borrowed(texts: &[String]) -> Vec<&str> {
    texts.iter().map(String::as_str).collect()
}

/// Every scene and library of the project, and every failing example of a diagnostic.
fn seeds(root: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for folder in ["scenarios", "stdlib", "tests/scenes", "tests/bad", "explain", "fuzz/corpus"] {
        let Ok(entries) = std::fs::read_dir(root.join(folder)) else { continue };
        let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        found.extend(paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()));
    }
    found
}
