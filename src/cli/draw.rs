//! `trackbed draw`: the scene to scale, before anything runs.

use super::scene::{SceneArguments, failed, show};
use super::{Outcome, terminal};
use crate::report::drawing_svg;
use std::path::PathBuf;

/// Draw the scene to scale: long section, layers, cross-sections, gradings
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed draw scenarios/wedge.track
  trackbed draw scenarios/wedge.track --out wedge.svg")]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Where the picture goes; beside the scene's name, as SVG, where it is not given
    #[arg(long, value_name = "FILE.svg")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let Some(compiled) = arguments.scene.compile() else { return Outcome::Usage };
    show(&compiled);
    let Some(scenario) = compiled.scenario.as_ref().filter(|_| !failed(&compiled)) else {
        if !failed(&compiled) {
            terminal::error("there is nothing to draw: the scene is not complete, or the file has no `track`");
        }
        return Outcome::Failed;
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let stem = arguments.scene.file.file_stem().unwrap_or_default();
        PathBuf::from(stem).with_extension("svg")
    });
    match arguments.scene.write_beside(&out, drawing_svg(scenario).as_bytes()) {
        Ok(()) => {
            terminal::summary(&format!("drew {}\n", out.display()));
            Outcome::Fine
        }
        Err(why) => {
            terminal::error(&why);
            Outcome::Failed
        }
    }
}
