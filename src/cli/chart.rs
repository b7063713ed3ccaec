//! `trackbed chart`: what a passage costs and how exact it is, over integrators, steps, meshes and beam theories; or
//! the same for whole runs by every tier.

use super::scene::SceneArguments;
use super::subject::{self, Subject};
use super::{Format, Outcome, chart_runs, progress, terminal};
use crate::report;
use crate::trials::chart::{Request, chart};
use crate::trials::{Chart, Outcome as Ended, Sweep, Variant, chart_csv};
use crate::units::number;
use std::path::{Path, PathBuf};

/// Chart error against time: of a passage, or of whole runs
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed chart scenarios/transition.track --out chart
  trackbed chart scenarios/transition.track --after 0 --halvings 3 --out chart
  trackbed chart scenarios/transition_short.track --of run --minutes 120 --out runs")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// What is computed: one passage with many numerics, or the whole scene by every tier, with other exchanges,
    /// windows and packings. Runs that are there already are not run again.
    #[arg(long, value_enum, default_value = "passage")]
    of: Of,
    /// Where `chart.csv` and `chart.svg` go, and the runs of `--of run`, which needs it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Let so many axles settle the track first; the whole traffic where absent.
    #[arg(long, value_name = "AXLES")]
    after: Option<u64>,
    /// How often the scene's time step is halved.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=8))]
    halvings: u32,
    /// With `--of run`: axles of each run; 20 on grains and the whole traffic by a law where absent.
    #[arg(long, value_name = "AXLES", value_parser = clap::value_parser!(u64).range(1..))]
    axles: Option<u64>,
    /// With `--of run`: time for all runs, as estimated; 60 minutes where absent. The scene is shortened until its
    /// reference takes half of it, on grains by the window and by a law by axles. Runs that would exceed it are left
    /// out.
    #[arg(long, value_name = "MINUTES")]
    minutes: Option<f64>,
    /// With `--of run`: number of packings of the scene's own bed, 2 where absent. A difference between two methods
    /// means little if it is smaller than the difference between two packings.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100))]
    packings: Option<u64>,
    /// With `--of run`: show what would run and how long, and run nothing.
    #[arg(long)]
    dry_run: bool,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

/// What a chart computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Of {
    Passage,
    Run,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let of_runs =
        [arguments.axles.is_some(), arguments.minutes.is_some(), arguments.packings.is_some(), arguments.dry_run];
    match arguments.of {
        Of::Passage if of_runs.contains(&true) => {
            terminal::error("`--axles`, `--minutes`, `--packings` and `--dry-run` need `--of run`");
            Outcome::Usage
        }
        Of::Passage => of_passage(arguments),
        Of::Run if arguments.after.is_some() => {
            terminal::error("`--after` is for a chart of a passage: leave it out, or leave out `--of run`");
            Outcome::Usage
        }
        Of::Run => of_run(arguments),
    }
}

fn of_run(arguments: &Arguments) -> Outcome {
    let out = match arguments.out.as_deref() {
        Some(out) => out,
        None if arguments.dry_run => Path::new(""),
        None => {
            terminal::error("`chart --of run` keeps its runs: say where with `--out DIR`");
            return Outcome::Usage;
        }
    };
    let minutes = arguments.minutes.unwrap_or(60.0);
    if !(minutes > 0.0 && minutes.is_finite()) {
        terminal::error("`--minutes` must be a number above 0");
        return Outcome::Usage;
    }
    chart_runs::run(&chart_runs::Asked {
        scene: &arguments.scene,
        out,
        axles: arguments.axles,
        budget: 60.0 * minutes,
        packings: arguments.packings.unwrap_or(2),
        dry_run: arguments.dry_run,
        format: arguments.format,
    })
}

fn of_passage(arguments: &Arguments) -> Outcome {
    let compiled = match subject::compile(&arguments.scene) {
        Ok(compiled) => compiled,
        Err(outcome) => return outcome,
    };
    let subject = match Subject::new(&compiled, "chart") {
        Ok(subject) => subject,
        Err(outcome) => return outcome,
    };
    let bar = progress::share();
    let settled = {
        bar.set_message("the scene's own run");
        let settled = subject.settled(arguments.after, &mut |done, all| progress::set(&bar, done, all));
        match settled {
            Ok(settled) => settled,
            Err(outcome) => {
                bar.finish_and_clear();
                return outcome;
            }
        }
    };
    bar.reset();
    bar.set_message("passages");
    let request = Request { halvings: arguments.halvings };
    let charted = chart(&subject.planned, &settled, &subject.scenario.title, request, &mut |done, all| {
        progress::set(&bar, done, all);
    });
    bar.finish_and_clear();
    let chart = match charted {
        Ok(chart) => chart,
        Err(cause) => return subject.failed(cause, settled.axles),
    };
    let files = [("chart.csv", chart_csv(&chart)), ("chart.svg", report::chart_svg(&chart))];
    if let Err(outcome) = subject::write(arguments.out.as_deref(), &files) {
        return outcome;
    }
    match arguments.format {
        Format::Human => terminal::out(&text(&chart)),
        Format::Json => return subject::json(&chart),
    }
    Outcome::Fine
}

fn text(chart: &Chart) -> String {
    let mut out = format!(
        "{}: one passage after {} axles, {} seats lose contact\n\n",
        chart.title, chart.axles, chart.losing_contact
    );
    out += &format!(
        "  {:<24}{:>9} {:>4}  {:<11}{:>9}{:>10}{:>10}{:>10}{:>10}\n",
        "integrator", "step ms", "el.", "beam", "time s", "wheel", "seat", "loss", "moment"
    );
    let settled = chart.points.iter().filter(|p| p.level == crate::trials::Level::Settled);
    for point in settled {
        let v = &point.variant;
        let mark = match (point.default, point.efficient) {
            (true, _) => "*",
            (_, true) => "+",
            _ if point.sweep == Sweep::Reference => "=",
            _ => " ",
        };
        out += &format!(
            "{mark} {:<24}{:>9} {:>4}  {:<11}{:>9}",
            v.method.to_string(),
            v.tolerance.map_or_else(|| number(v.time_step * 1e3), |tolerance| format!("~{tolerance:e}")),
            v.elements_per_bay,
            v.beam.to_string(),
            format!("{:.4}", point.outcome.seconds())
        );
        match &point.outcome {
            Ended::Done { errors, .. } => {
                let loss = errors.contact_loss.unwrap_or(errors.contact_loss_s);
                for error in [errors.wheel_force, errors.seat_load, loss, errors.rail_moment] {
                    out += &format!("{:>10}", share(error));
                }
            }
            Ended::Unstable { reason, .. } => out += &format!("  unstable: {reason}"),
            Ended::Failed { reason, .. } => out += &format!("  failed: {reason}"),
        }
        out.push('\n');
    }
    out += "  * the scene's own, + nothing cheaper has a smaller error of the wheel force, = reference, ~ steps vary within this tolerance\n\n";
    out += "order in the time step                    springs back   as built   settled\n";
    for order in &chart.orders {
        let shown = |order: Option<f64>| order.map_or("-".to_owned(), |o| format!("{o:.2}"));
        out += &format!(
            "  {:<42}{:>12}{:>11}{:>10}\n",
            order.method.to_string(),
            shown(order.released),
            shown(order.as_built),
            shown(order.settled)
        );
    }
    out += "  springs back: the rail let go from a small force; as built, settled: wheel forces of the finest three steps\n";
    if let Some(model) = &chart.model_error {
        out += &format!(
            "\nEuler against Timoshenko: wheel force {}, seat load {}, rail moment {}\n",
            share(model.wheel_force),
            share(model.seat_load),
            share(model.rail_moment)
        );
    }
    out += "\ncheapest with an error below\n";
    for row in &chart.cheapest {
        let what = match (&row.variant, row.seconds) {
            (Some(v), Some(seconds)) => format!("{} ({seconds:.4} s)", spelled(v)),
            _ => "none of these".to_owned(),
        };
        out += &format!("  {:<18}{:>7}  {what}\n", row.quantity, share(row.tolerance));
    }
    out
}

/// How `solve` spells it.
fn spelled(v: &Variant) -> String {
    format!(
        "integrator = {}, time_step = {}, elements_per_bay = {}",
        v.method,
        v.tolerance
            .map_or_else(|| format!("{} s", number(v.time_step)), |tolerance| format!("adaptive({tolerance:e})")),
        v.elements_per_bay
    )
}

fn share(error: f64) -> String {
    let percent = 100.0 * error;
    if percent == 0.0 {
        "0 %".into()
    } else if percent < 0.01 {
        format!("{percent:.1e} %")
    } else {
        format!("{percent:.2} %")
    }
}
