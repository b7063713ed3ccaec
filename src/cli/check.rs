//! `trackbed check`: every diagnostic of scenes, and of the points of their studies.

use super::scene::{SceneArguments, failed, show};
use super::{Format, Outcome, study, terminal};
use crate::check::Override;
use crate::compile::Compiled;
use crate::diag::{Severity, render};
use clap::ValueEnum;
use serde_json::json;
use std::path::PathBuf;

/// Show every mistake of a scene, without running it
///
/// Exit codes: 0 no errors, 1 errors, 2 a file cannot be read.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed check scenarios/transition.track
  trackbed check --deny warnings scenarios/transition.track scenarios/wedge.track
  trackbed check --set 'open.spacing=0.65 m' scenarios/transition.track
  trackbed check --format json - < scenarios/transition.track")]
pub(super) struct Arguments {
    /// The scenes: `.track` files; `-` reads a scene from standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Edit a line of every scene for this command, e.g. `--set open.spacing='0.65 m'`
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = Override::parse)]
    set: Vec<Override>,
    /// Count these diagnostics as errors too
    #[arg(long, value_name = "WHAT", value_enum)]
    deny: Option<Deny>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

/// Diagnostics that are not errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Deny {
    Warnings,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let (mut outcome, mut found) = (Outcome::Fine, Vec::new());
    for file in &arguments.files {
        let scene = SceneArguments { file: file.clone(), set: arguments.set.clone() };
        let Some(mut compiled) = checked(&scene) else {
            outcome = Outcome::Usage;
            continue;
        };
        if arguments.deny == Some(Deny::Warnings) {
            deny_warnings(&mut compiled);
        }
        match arguments.format {
            Format::Human => show(&compiled),
            Format::Json => found.extend(render::entries(&compiled.diagnostics, &compiled.sources)),
        }
        match (failed(&compiled), arguments.format) {
            (true, _) if matches!(outcome, Outcome::Fine) => outcome = Outcome::Failed,
            (false, Format::Human) => terminal::summary(&format!("{}: no errors\n", file.display())),
            _ => {}
        }
    }
    if arguments.format == Format::Json {
        terminal::out(&format!("{:#}\n", json!({ "diagnostics": found })));
    }
    outcome
}

/// A scene with the diagnostics of the points of its studies; `None` if it cannot be read (an error was printed).
fn checked(scene: &SceneArguments) -> Option<Compiled> {
    let modules = scene.remembered();
    let mut compiled = scene.compile_with(&modules)?;
    if !failed(&compiled) {
        // every point of a study is a scene too
        let found = study::diagnostics(scene, &modules, &compiled);
        compiled.diagnostics.extend(found);
    }
    Some(compiled)
}

fn deny_warnings(compiled: &mut Compiled) {
    for diagnostic in &mut compiled.diagnostics {
        if diagnostic.severity == Severity::Warning {
            diagnostic.severity = Severity::Error;
        }
    }
}
