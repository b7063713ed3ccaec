//! Scenes drawn at random from the schema, checked and run: they end, in numbers that are finite, without a panic and
//! within a bounded memory.
//!
//! ```sh
//! cargo run --release --example soak -- check 100000
//! cargo run --release --example soak -- law 2000 --from 100000
//! cargo run --release --example soak -- grains 200 --seconds 3600
//! cargo run --release --example soak -- show 17
//! ```
//!
//! Scene `k` has the same text everywhere. What fails is written to `fuzz/soak`, which the tests replay.

#[path = "../../fuzz/dice.rs"]
mod dice;
mod draw;
#[path = "../../fuzz/memory.rs"]
mod memory;
mod tally;
mod trial;
#[path = "../../fuzz/watchdog.rs"]
mod watchdog;

use draw::{Aim, Known};
use std::path::Path;
use std::time::{Duration, Instant};
use tally::Tally;
use trial::Outcome;
use watchdog::Watchdog;

/// A scene that takes longer hangs: plans of more than a minute are not run.
const LONGEST: Duration = Duration::from_secs(600);
/// Time between two lines of progress.
const PAUSE: Duration = Duration::from_secs(20);

/// Tries a scene by its number and its text.
type Trial = dyn FnMut(u64, &str) -> Outcome;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |text: Option<&String>| text.and_then(|t| t.parse::<u64>().ok());
    let after = |flag: &str| arguments.iter().position(|a| a == flag).and_then(|i| number(arguments.get(i + 1)));
    let Some((what, count)) = arguments.first().zip(number(arguments.get(1))) else {
        return eprintln!(
            "usage: soak check|law|grains COUNT [--from NUMBER] [--seconds MOST], or soak show|show-law|show-grains NUMBER"
        );
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let texts = trial::shipped(root);
    let known = Known::read(texts.iter().map(String::as_str));
    let from = after("--from").unwrap_or(0);
    let mut trial: Box<Trial> = match what.as_str() {
        "check" => Box::new(trial::checked(root)),
        "law" => Box::new(trial::run(root, 0.4)),
        "grains" => Box::new(trial::run(root, 20.0)),
        "show" => return show(root, &draw::scene(&known, trial::aim(count), count)),
        "show-law" => return show(root, &draw::scene(&known, Aim::Law, count)),
        "show-grains" => return show(root, &draw::scene(&known, trial::grains(count), count)),
        other => return eprintln!("nothing is known of `{other}`"),
    };
    let aim = |number: u64| match what.as_str() {
        "law" => Aim::Law,
        "grains" => trial::grains(number),
        _ => trial::aim(number),
    };
    // a panic is an outcome
    std::panic::set_hook(Box::new(|_| ()));
    let (watchdog, started) = (Watchdog::start(LONGEST, |_| ()), Instant::now());
    let mut tally = Tally::default();
    let most = after("--seconds").map_or(Duration::MAX, Duration::from_secs);
    let (mut scenes, mut done, mut told) = (0, 0, Duration::ZERO);
    // of runs, `count` are wanted that begin: scenes that the check refuses do not count
    while done < count && started.elapsed() < most {
        let k = from + scenes;
        let text = draw::scene(&known, aim(k), k);
        let outcome = watchdog.watched(k, || trial(k, &text));
        scenes += 1;
        done += u64::from(what == "check" || outcome.has_begun());
        if let Some(why) = outcome.failure() {
            eprintln!("scene {k}: {why}");
            let path = root.join(format!("fuzz/soak/{what}-{k}.track"));
            if let Err(error) =
                std::fs::create_dir_all(root.join("fuzz/soak")).and_then(|()| std::fs::write(&path, &text))
            {
                eprintln!("{}: {error}", path.display());
            }
        }
        tally.add(k, aim(k), &outcome);
        if started.elapsed() > told + PAUSE || done == count {
            told = started.elapsed();
            let seconds = told.as_secs_f64();
            eprintln!(
                "{done} of {count}, {scenes} scenes, {seconds:.0} s, {:.0} MiB, {} failed",
                memory::resident(),
                tally.failed()
            );
            tally.resident.push((scenes, memory::resident()));
        }
    }
    print!("{tally}");
    println!("at most {:.0} MiB were asked for", memory::peak());
    println!(
        "{:.0} seconds, {:.1} scenes a second",
        started.elapsed().as_secs_f64(),
        scenes as f64 / started.elapsed().as_secs_f64()
    );
    std::process::exit(i32::from(tally.failed() > 0));
}

/// Prints a scene and what the check says of it.
fn show(root: &Path, text: &str) {
    println!("{text}");
    for line in trial::told(root, text) {
        eprintln!("{line}");
    }
}
