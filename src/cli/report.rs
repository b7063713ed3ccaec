//! `trackbed report`: the page of a run, made again from its directory.

use super::{Outcome, terminal};
use crate::{report, results};
use std::path::{Path, PathBuf};

/// Write the report page of a run, from its directory
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The directory that `trackbed run --out` wrote.
    directory: PathBuf,
    /// Write every figure as an SVG file beside the page too.
    #[arg(long)]
    figures: bool,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let run = match results::read(&arguments.directory) {
        Ok(run) => run,
        Err(error) => {
            terminal::error(&error.to_string());
            return Outcome::Usage;
        }
    };
    match write(&run, &arguments.directory, arguments.figures) {
        Ok(page) => {
            terminal::out(&format!("wrote {}\n", page.display()));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&error);
            Outcome::Failed
        }
    }
}

/// Writes `report.html`, and the figures where they are wanted.
pub(super) fn write(run: &results::Run, directory: &Path, figures: bool) -> Result<PathBuf, String> {
    let page = directory.join("report.html");
    results::write_atomically(&page, report::page(run).as_bytes()).map_err(|e| e.to_string())?;
    if figures {
        for figure in report::figures(run) {
            let path = directory.join(format!("{}.svg", figure.id));
            results::write_atomically(&path, figure.svg.as_bytes()).map_err(|e| e.to_string())?;
        }
    }
    Ok(page)
}
