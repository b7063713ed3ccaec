//! `trackbed stability`: where a passage fails, and whether it says so; in which blocks of axles a disturbance of the
//! settlement grows; at which steps the bed of grains runs away.

use super::scene::SceneArguments;
use super::subject::{self, Subject};
use super::{Format, Outcome, progress, stability_grains, terminal};
use crate::execute::BLOCKS;
use crate::report;
use crate::trials::stability::stability;
use crate::trials::{
    ExchangeMap, GrainMap, Stability, exchange_csv, exchange_map, grain_speeds_csv, grain_steps_csv, most_cells,
    stability_csv,
};
use crate::units::number;
use serde::Serialize;
use std::path::PathBuf;

/// Map where a passage is stable, and try the scene under stress
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed stability scenarios/transition.track --out stability
  trackbed stability scenarios/transition_short.track --of grains --out stability")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Where the tables and pictures go: `stability`, `exchange` for a scene by a law, `grain_steps`, `grain_speeds`
    /// and `grains` for a scene on grains.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Which maps: of passages and the exchange of forces and settlement, of the grains, or all that the scene has.
    #[arg(long, value_enum, default_value = "all")]
    of: Maps,
    /// Where packed beds and cells are kept, by what made them.
    #[arg(long, value_name = "DIR", env = "TRACKBED_CACHE")]
    cache: Option<PathBuf>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Maps {
    All,
    Passages,
    Grains,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let compiled = match subject::compile(&arguments.scene) {
        Ok(compiled) => compiled,
        Err(outcome) => return outcome,
    };
    let subject = match Subject::new(&compiled, "stability") {
        Ok(subject) => subject,
        Err(outcome) => return outcome,
    };
    let answer = match mapped(arguments, &subject) {
        Ok(answer) => answer,
        Err(outcome) => return outcome,
    };
    if let Err(outcome) = subject::write(arguments.out.as_deref(), &answer.files(&subject.scenario.title)) {
        return outcome;
    }
    let outcome = match arguments.format {
        Format::Human => {
            answer.stability.iter().for_each(|map| terminal::out(&text(map)));
            answer.exchange.iter().for_each(|map| terminal::out(&told(map)));
            answer.grains.iter().for_each(|map| terminal::out(&stability_grains::told(map)));
            Outcome::Fine
        }
        Format::Json => subject::json(&answer),
    };
    if answer.stability.is_some_and(|map| map.wrong() > 0) { Outcome::Failed } else { outcome }
}

/// The maps that were asked for, as far as the scene has them.
#[derive(Serialize)]
struct Answer {
    #[serde(flatten)]
    stability: Option<Stability>,
    exchange: Option<ExchangeMap>,
    grains: Option<GrainMap>,
}

impl Answer {
    fn files(&self, title: &str) -> Vec<(&'static str, String)> {
        let mut files = Vec::new();
        if let Some(map) = &self.stability {
            files.extend([("stability.csv", stability_csv(map)), ("stability.svg", report::stability_svg(map))]);
        }
        if let Some(map) = &self.exchange {
            let picture = report::exchange_map_svg(map, title);
            files.extend([("exchange.csv", exchange_csv(map)), ("exchange.svg", picture)]);
        }
        if let Some(map) = &self.grains {
            files.extend([
                ("grain_steps.csv", grain_steps_csv(map)),
                ("grain_speeds.csv", grain_speeds_csv(map)),
                ("grains.svg", report::grain_map_svg(map, title)),
            ]);
        }
        files
    }
}

fn mapped(arguments: &Arguments, subject: &Subject<'_>) -> Result<Answer, Outcome> {
    let has_grains = subject.planned.graph.has_grains_under_track();
    if arguments.of == Maps::Grains && !has_grains {
        terminal::error("this scene has no grains under its track: leave out `--of grains`");
        return Err(Outcome::Usage);
    }
    let (stability, exchange) = match arguments.of {
        Maps::Grains => (None, None),
        Maps::All | Maps::Passages => (Some(of_passages(subject)?), exchanged(subject)?),
    };
    let grains = match arguments.of {
        Maps::All | Maps::Grains if has_grains => {
            stability_grains::mapped(&arguments.scene, arguments.cache.as_deref())?
        }
        _ => None,
    };
    Ok(Answer { stability, exchange, grains })
}

fn of_passages(subject: &Subject<'_>) -> Result<Stability, Outcome> {
    let bar = progress::share();
    bar.set_message("passages");
    let mapped = stability(subject.scenario, &subject.planned, &mut |done, all| {
        progress::set(&bar, done, all);
    });
    bar.finish_and_clear();
    mapped.map_err(|cause| subject.failed(cause, 0))
}

fn exchanged(subject: &Subject<'_>) -> Result<Option<ExchangeMap>, Outcome> {
    let bar = progress::share();
    bar.set_message("blocks");
    let mut done = 0;
    let mapped = exchange_map(&subject.planned, &mut || {
        done += 1;
        progress::set(&bar, done, most_cells() as u64);
    });
    bar.finish_and_clear();
    mapped.map_err(|error| subject.stopped(&error))
}

/// What the map of the exchange says.
fn told(map: &ExchangeMap) -> String {
    let mut out = format!(
        "\nexchange of forces and settlement: {} lengths and counts, growth of a sawtooth over {BLOCKS} blocks\n",
        map.cells.len()
    );
    let mut counts: Vec<u64> = map.cells.iter().map(|cell| cell.axles).collect();
    counts.dedup();
    for axles in counts {
        out += &match map.limit(axles) {
            Some(limit) => {
                format!("  after {axles} axles it grows in blocks of more than {} axles\n", number(limit.round()))
            }
            None => format!("  after {axles} axles it grows in no block of up to {} axles\n", map.longest(axles)),
        };
    }
    out += &format!("  {} of them grow or decay against theory\n", map.against_theory());
    out += &match (map.adaptive, map.margin()) {
        (false, Some(([before, axles], margin))) => format!(
            "  the blocks of the scene: the nearest to its limit has {axles} axles after {before} axles, the limit is {}{} \
             times as long\n",
            if map.limit(before).is_some() { "" } else { "more than " },
            number((10.0 * margin).round() / 10.0)
        ),
        _ => format!(
            "  the blocks of the scene are adaptive, and their forces follow the settlement: a sawtooth is multiplied by \
             at most {} per block\n",
            number((100.0 * map.largest_following()).round() / 100.0)
        ),
    };
    out
}

fn text(stability: &Stability) -> String {
    let cells = &stability.map.cells;
    let mut out = format!("{}: {} passages of the map\n", stability.title, cells.len());
    for name in ["stable", "coarse", "unstable", "refused", "wrong"] {
        let count = cells.iter().filter(|c| c.verdict.name() == name).count();
        let meaning = match name {
            "stable" => "within 10 % of the reference",
            "coarse" => "further off, and a rule has warned",
            "unstable" => "ran away, and the run says so",
            "refused" => "with a diagnostic",
            _ => "neither right nor diagnosed",
        };
        out += &format!("  {name:<10}{count:>5}  {meaning}\n");
    }
    for cell in cells.iter().filter(|c| c.verdict.is_wrong()) {
        out += &format!(
            "  wrong: {}, {:e} s, contact x {}, void {} m under {}: {}\n",
            cell.method,
            cell.time_step,
            cell.contact,
            cell.void.depth,
            cell.void.sleepers.map_or("all".to_owned(), |n| n.to_string()),
            cell.verdict.why()
        );
    }
    out += "\nhard scenes\n";
    for row in &stability.stresses {
        let force = row.wheel_force.map_or(String::new(), |f| format!("{f:.2}"));
        out += &format!("  {:<9} {:<58}{force:>8}  {}", row.verdict.name(), row.name, row.told());
        if !row.warnings.is_empty() {
            out += &format!("; {}", row.warnings.join(" "));
        }
        out.push('\n');
    }
    out += "  columns: largest wheel force over the static one, distance from a quarter of the step, rules that warn\n";
    out
}
