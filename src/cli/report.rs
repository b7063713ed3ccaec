//! `trackbed report`: the page of a run, made again from its directory.

use super::{Outcome, terminal};
use crate::report::{self, BedTestsPage, Figure};
use crate::results::{self, BedTestsView, NamedBytes, ResultsError};
use crate::store::Directory;
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
    match write(&arguments.directory, arguments.figures) {
        Ok(page) => {
            terminal::out(&format!("wrote {}\n", page.display()));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&error.to_string());
            Outcome::Usage
        }
    }
}

/// Reads the results of a directory, each file checked, and puts their page in place.
fn write(directory: &Path, figures: bool) -> Result<PathBuf, ResultsError> {
    let mut opened = Directory::amend(directory)?;
    if let Some(finished) = opened.finished() {
        // what is made again need not be there
        let made = |name: &str| name == PAGE || name.ends_with(".svg");
        let mut read = finished.manifest().files.iter().filter(|file| !made(&file.name));
        read.try_for_each(|file| finished.read(&file.name).map(drop))?;
    }
    let pages = match results::read_tests(directory)? {
        Some(view) => test_pages(&view, figures),
        None => run_pages(&results::read(directory)?, figures),
    };
    for (name, bytes) in &pages {
        opened.stage(name, bytes)?;
    }
    opened.commit()?;
    Ok(directory.join(PAGE))
}

/// `report.html` of a run, and the figures where they are wanted.
pub(super) fn run_pages(run: &results::Run, figures: bool) -> Vec<NamedBytes> {
    pages(report::page(run), &if figures { report::figures(run) } else { Vec::new() })
}

/// The same of tests.
pub(super) fn test_pages(view: &BedTestsView, figures: bool) -> Vec<NamedBytes> {
    let page = BedTestsPage::new(view);
    pages(page.html(), &if figures { page.figures() } else { Vec::new() })
}

pub(super) const PAGE: &str = "report.html";

fn pages(html: String, figures: &[Figure]) -> Vec<NamedBytes> {
    let page = (PAGE.to_owned(), html.into_bytes());
    let figures = figures.iter().map(|figure| (format!("{}.svg", figure.id), figure.svg.clone().into_bytes()));
    std::iter::once(page).chain(figures).collect()
}
