//! Throws texts at the parser, the formatter and the checker that nobody would write.
//!
//! ```sh
//! cargo run --release --example fuzz -- parse 1000000
//! cargo run --release --example fuzz -- check 1000000 --from 5000000
//! ```
//!
//! Run `k` is the same text everywhere, so a run that ends the program (a stack that overflows) is found again by its
//! number. What fails is written to `fuzz/corpus`, which the tests replay.

#[path = "../fuzz/mutate.rs"]
mod mutate;
#[path = "../fuzz/targets.rs"]
mod targets;

use rayon::prelude::*;
use std::panic::catch_unwind;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Runs between two lines of progress.
const CHUNK: u64 = 50_000;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let target: fn(&str) = match arguments.first().map(String::as_str) {
        Some("parse") => targets::parse,
        Some("format") => targets::format,
        Some("check") => targets::check,
        _ => return eprintln!("usage: fuzz parse|format|check RUNS [--from NUMBER]"),
    };
    let number = |text: Option<&String>| text.and_then(|t| t.parse::<u64>().ok());
    let runs = number(arguments.get(1)).unwrap_or(1_000_000);
    let from = arguments.iter().position(|a| a == "--from").and_then(|i| number(arguments.get(i + 1))).unwrap_or(0);
    let owned = seeds(Path::new(env!("CARGO_MANIFEST_DIR")));
    let seeds: Vec<&str> = owned.iter().map(String::as_str).collect();
    let failed = AtomicU64::new(0);
    for start in (from..from + runs).step_by(CHUNK as usize) {
        let end = (start + CHUNK).min(from + runs);
        (start..end).into_par_iter().for_each(|k| {
            let text = mutate::text(&seeds, k);
            if catch_unwind(|| target(&text)).is_err() {
                failed.fetch_add(1, Ordering::Relaxed);
                let path =
                    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("fuzz/corpus/{}-{k}.track", arguments[0]));
                if let Err(error) = std::fs::write(&path, &text) {
                    eprintln!("{}: {error}", path.display());
                }
            }
        });
        eprintln!("{} of {runs} runs, {} failed", end - from, failed.load(Ordering::Relaxed));
    }
    std::process::exit(i32::from(failed.into_inner() > 0));
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
