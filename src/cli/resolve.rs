//! `trackbed resolve`: the scene as one file, with every default and library value and where it comes from.

use super::scene::{SceneArguments, failed, show};
use super::{Outcome, terminal};
use std::path::PathBuf;

/// Write the scene out with every default and library value, and where each comes from
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed resolve scenarios/transition.track
  trackbed resolve scenarios/transition.track --set 'open.pad=pads.soft' --out soft.track")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The file to write; standard output where it is left out.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(compiled) = arguments.scene.compile() else { return Outcome::Usage };
    show(&compiled);
    if failed(&compiled) {
        return Outcome::Failed;
    }
    let Some(text) = arguments.scene.resolve() else {
        terminal::error("there is no scene to write out: a file without a `track` is a library");
        return Outcome::Failed;
    };
    match &arguments.out {
        None => terminal::out(&text),
        Some(file) => {
            if let Err(why) = arguments.scene.write_beside(file, text.as_bytes()) {
                terminal::error(&why);
                return Outcome::Usage;
            }
        }
    }
    Outcome::Fine
}
