//! `trackbed stability`: where a passage fails, and whether it says so.

use super::scene::SceneArguments;
use super::subject::{self, Subject};
use super::{Format, Outcome, progress, terminal};
use crate::report;
use crate::trials::stability::stability;
use crate::trials::{Stability, stability_csv};
use std::path::PathBuf;

/// Map where a passage is stable, and try the scene under stress
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed stability scenarios/transition.track --out stability")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Where `stability.csv` and `stability.svg` go.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
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
    let bar = progress::share();
    bar.set_message("passages");
    let mapped = stability(subject.scenario, &subject.planned, &mut |done, all| {
        progress::set(&bar, done, all);
    });
    bar.finish_and_clear();
    let stability = match mapped {
        Ok(stability) => stability,
        Err(cause) => return subject.failed(cause, 0),
    };
    let files = [("stability.csv", stability_csv(&stability)), ("stability.svg", report::stability_svg(&stability))];
    if let Err(outcome) = subject::write(arguments.out.as_deref(), &files) {
        return outcome;
    }
    let outcome = match arguments.format {
        Format::Human => {
            terminal::out(&text(&stability));
            Outcome::Fine
        }
        Format::Json => subject::json(&stability),
    };
    if stability.wrong() > 0 { Outcome::Failed } else { outcome }
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
