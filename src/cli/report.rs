//! `trackbed report`: the page of a run, made again from its directory.

use super::{Outcome, terminal};
use crate::report::{self, Figure, RigPage};
use crate::results::{self, ResultsError, RigView};
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
    let (directory, figures) = (&arguments.directory, arguments.figures);
    let written = match results::read_rig(directory) {
        Ok(Some(view)) => write_rig(&view, directory, figures),
        Ok(None) => match results::read(directory) {
            Ok(run) => write(&run, directory, figures),
            Err(error) => return unread(&error),
        },
        Err(error) => return unread(&error),
    };
    match written {
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

fn unread(error: &ResultsError) -> Outcome {
    terminal::error(&error.to_string());
    Outcome::Usage
}

/// Writes `report.html`, and the figures where they are wanted.
pub(super) fn write(run: &results::Run, directory: &Path, figures: bool) -> Result<PathBuf, String> {
    pages(directory, &report::page(run), &if figures { report::figures(run) } else { Vec::new() })
}

/// The same of a test rig.
pub(super) fn write_rig(view: &RigView, directory: &Path, figures: bool) -> Result<PathBuf, String> {
    let page = RigPage::of(view);
    pages(directory, &page.html(), &if figures { page.figures() } else { Vec::new() })
}

fn pages(directory: &Path, html: &str, figures: &[Figure]) -> Result<PathBuf, String> {
    let page = directory.join("report.html");
    results::write_atomically(&page, html.as_bytes()).map_err(|e| e.to_string())?;
    for figure in figures {
        let path = directory.join(format!("{}.svg", figure.id));
        results::write_atomically(&path, figure.svg.as_bytes()).map_err(|e| e.to_string())?;
    }
    Ok(page)
}
