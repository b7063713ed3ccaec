//! `trackbed new`: a scene to begin with.

use super::{Outcome, terminal};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;

/// The scene that a new file holds: small, complete, and runs in seconds.
const TEMPLATE: &str = include_str!("template.track");

/// Write a scene to begin with
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed new zone.track")]
pub(super) struct Arguments {
    /// The file to write; it must not exist yet.
    file: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let mut path = arguments.file.clone();
    if path.extension().is_none() {
        path.set_extension("track");
    }
    let name = path.display().to_string();
    let written =
        OpenOptions::new().write(true).create_new(true).open(&path).and_then(|mut f| f.write_all(TEMPLATE.as_bytes()));
    match written {
        Ok(()) => {
            terminal::summary(&format!(
                "wrote {name}\nnext: trackbed check {name}\n      trackbed run {name} --out out\n"
            ));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&format!("cannot write `{name}`: {error}"));
            Outcome::Usage
        }
    }
}
