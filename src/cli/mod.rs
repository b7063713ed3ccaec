//! The command line: one file a command. The only place that prints, reads the environment or exits.
//!
//! Exit codes: 0 all is well, 1 the scene or its run has errors, 2 the command was used wrongly.

mod bench;
mod calibrate;
mod calibrate_grains;
mod chart;
mod chart_runs;
mod check;
mod cluster;
mod compare;
mod compare_summary;
mod completions;
mod docs;
mod draw;
mod explain;
mod fmt;
mod interrupt;
mod lsp;
mod man;
mod memory;
mod new;
mod pack;
mod pack_track;
mod parts;
mod plan;
mod progress;
mod report;
mod resolve;
mod run;
mod run_elsewhere;
mod run_packings;
mod run_progress;
mod running;
mod scene;
mod stability;
mod stability_grains;
mod stored;
mod study;
mod study_elsewhere;
mod study_local;
mod study_summary;
mod subject;
mod task;
mod terminal;
mod work;

use clap::{Parser, Subcommand, ValueEnum};
use std::process::ExitCode;

/// Railway transition zones: from a scene in a text file to a settlement picture.
#[derive(Parser)]
#[command(name = "trackbed", version, max_term_width = 100)]
#[command(after_help = "Examples:
  trackbed new zone.track
  trackbed check zone.track
  trackbed run zone.track --out out

`trackbed COMMAND --help` has examples of each command.")]
struct Cli {
    #[command(flatten)]
    manner: terminal::Manner,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::Arguments),
    Draw(draw::Arguments),
    Plan(plan::Arguments),
    Resolve(resolve::Arguments),
    Pack(pack::Arguments),
    Run(run::Arguments),
    Study(study::Arguments),
    Work(work::Arguments),
    Calibrate(calibrate::Arguments),
    Report(report::Arguments),
    Compare(compare::Arguments),
    Chart(chart::Arguments),
    Stability(stability::Arguments),
    Bench(bench::Arguments),
    Fmt(fmt::Arguments),
    Explain(explain::Arguments),
    Docs(docs::Arguments),
    New(new::Arguments),
    Lsp(lsp::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// For whom the answer is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Human,
    Json,
}

/// How a command ended.
enum Outcome {
    Fine,
    /// The scene or its run has errors, which have been shown.
    Failed,
    /// The command was used wrongly, which has been said.
    Usage,
}

impl Outcome {
    /// What the shell gets.
    fn code(&self) -> u8 {
        match self {
            Outcome::Fine => 0,
            Outcome::Failed => 1,
            Outcome::Usage => 2,
        }
    }
}

/// Whether the command line understands these arguments, without the program's name in front; else what it would say.
pub fn understands<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Result<(), String> {
    let line = std::iter::once("trackbed").chain(arguments);
    Cli::try_parse_from(line).map(|_| ()).map_err(|error| error.to_string())
}

/// Reads the arguments, runs the command and tells the shell.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // help and version are no mistakes
            let code = if error.use_stderr() { 2 } else { 0 };
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    terminal::speak(cli.manner);
    let outcome = match cli.command {
        Command::Check(arguments) => check::run(&arguments),
        Command::Draw(arguments) => draw::run(&arguments),
        Command::Plan(arguments) => plan::run(&arguments),
        Command::Resolve(arguments) => resolve::run(&arguments),
        Command::Pack(arguments) => pack::run(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Study(arguments) => study::run(&arguments),
        Command::Work(arguments) => work::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Chart(arguments) => chart::run(&arguments),
        Command::Stability(arguments) => stability::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Fmt(arguments) => fmt::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Docs(arguments) => docs::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Lsp(arguments) => lsp::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Man(arguments) => man::run(&arguments),
    };
    let lost = terminal::lost();
    if let Some(cause) = lost {
        terminal::error(&format!("standard output is incomplete: {cause}"));
    }
    ExitCode::from(match outcome {
        Outcome::Fine if lost.is_some() => Outcome::Failed.code(),
        outcome => outcome.code(),
    })
}
