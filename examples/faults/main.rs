//! Kills the program at random moments, lets it go on until it has ended, and compares all that it wrote with what it
//! writes when nobody kills it. Between kills it is asked to stop, as Ctrl-C and schedulers do, and the time that it
//! takes is measured.
//!
//!     cargo run --release --example faults -- 1000 [SEED] [TIER]
//!     tests/slurm/cluster.sh cargo run --release --example faults -- 1000
//!
//! With a name of a tier only works whose names begin with it are done. `docs/faults.md` says what the columns are.

#[path = "../../tests/common/coarse_cells.rs"]
mod coarse_cells;
mod life;
mod scenes;
#[path = "../../tests/common/shared_packings.rs"]
#[allow(dead_code, reason = "tests compare directories in their own way")]
mod shared_packings;

use life::{Subject, same_files};
use scenes::Work;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

/// Kills after which a work is left to end.
const OF_ONE: u64 = 12;

fn main() -> ExitCode {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let kills: Option<u64> = given.first().map_or(Some(100), |word| word.parse().ok());
    // with the words of a command this is the program itself, which the works start
    let Some(kills) = kills else { return trackbed::cli::main() };
    let seed = given.get(1).and_then(|word| word.parse().ok()).unwrap_or(1);
    let wanted = given.get(2).map(String::as_str).unwrap_or_default();
    let has_slurm = Command::new("sinfo").stdout(Stdio::null()).stderr(Stdio::null()).status();
    let works = scenes::all(has_slurm.is_ok_and(|status| status.success()));
    println!("| what is killed | whole, s | kills | stops | longest stop, s | ended | equal |");
    println!("|---|---|---|---|---|---|---|");
    let mut all_equal = true;
    for work in works.iter().filter(|work| work.name.starts_with(wanted)) {
        let mut dice = Dice(seed);
        match killed(work, (work.kills * kills).div_ceil(1000), &mut dice) {
            Ok(row) => {
                println!("{}", row.line(work));
                all_equal &= row.equal == row.ended;
            }
            Err(why) => {
                println!("| {} | {why} |", work.name);
                all_equal = false;
            }
        }
    }
    if all_equal { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// What became of a work that was killed again and again.
#[derive(Default)]
struct Row {
    /// Seconds that it takes when nobody kills it.
    whole: f64,
    kills: u64,
    stops: u64,
    longest_stop: f64,
    /// How often it was brought to its end, and to the same files.
    ended: u64,
    equal: u64,
}

impl Row {
    fn line(&self, work: &Work) -> String {
        let Row { whole, kills, stops, longest_stop, ended, equal } = self;
        format!(
            "| {} | {whole:.1} | {kills} | {stops} | {longest_stop:.2} | {ended} | {} |",
            work.name,
            if equal == ended { "yes".to_owned() } else { format!("{equal} of {ended}") }
        )
    }
}

/// Kills a work so often, over as many directories as that takes.
fn killed(work: &Work, kills: u64, dice: &mut Dice) -> Result<Row, String> {
    let whole = Subject::new(work)?;
    let began = Instant::now();
    whole.finish()?;
    let mut row = Row { whole: began.elapsed().as_secs_f64(), ..Row::default() };
    while row.kills < kills {
        let subject = Subject::new(work)?;
        for life in 0..OF_ONE.min(kills - row.kills) {
            let after = 0.6 * row.whole * dice.share();
            // one in four is asked to stop first, by turns as Ctrl-C and as a scheduler does
            if life % 4 == 3 {
                let signal = if row.stops.is_multiple_of(2) { "-INT" } else { "-TERM" };
                if let Some(seconds) = subject.stop(0.6 * row.whole * dice.share(), signal)? {
                    row.stops += 1;
                    row.longest_stop = row.longest_stop.max(seconds);
                }
            }
            if !subject.kill(after)? {
                break;
            }
            row.kills += 1;
        }
        subject.finish()?;
        row.ended += 1;
        match same_files(&whole.out(), &subject.out()) {
            Ok(()) => row.equal += 1,
            Err(what) => eprintln!("{}: {what}: see {}", work.name, subject.keep().display()),
        }
    }
    Ok(row)
}

/// Numbers by chance, the same for the same seed (SplitMix64).
struct Dice(u64);

impl Dice {
    /// From 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
