//! `trackbed check`: every diagnostic of a scene, and of the points of its studies.

use super::scene::{SceneArguments, failed, show};
use super::{Format, Outcome, study, terminal};
use crate::diag::render;

/// Show every mistake of a scene, without running it
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let modules = arguments.scene.remembered();
    let Some(mut compiled) = arguments.scene.compile_with(&modules) else { return Outcome::Usage };
    if !failed(&compiled) {
        // every point of a study is a scene too
        let found = study::diagnostics(&arguments.scene, &modules, &compiled);
        compiled.diagnostics.extend(found);
    }
    match arguments.format {
        Format::Human => show(&compiled),
        Format::Json => terminal::out(&format!("{:#}\n", render::json(&compiled.diagnostics, &compiled.sources))),
    }
    if failed(&compiled) {
        return Outcome::Failed;
    }
    if arguments.format == Format::Human {
        terminal::out(&format!("{}: no errors\n", arguments.scene.file.display()));
    }
    Outcome::Fine
}
