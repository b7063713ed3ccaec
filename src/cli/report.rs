//! `trackbed report`: the page of a run, made again from its directory.

use super::{Outcome, terminal};
use crate::report::{self, BedTestsPage, Figure};
use crate::results::{self, BedTestsView, NamedBytes, ResultsError};
use std::path::PathBuf;

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
    let pages = match results::read_tests(directory) {
        Ok(Some(view)) => test_pages(&view, figures),
        Ok(None) => match results::read(directory) {
            Ok(run) => run_pages(&run, figures),
            Err(error) => return unread(&error),
        },
        Err(error) => return unread(&error),
    };
    match results::write_files(&pages, directory) {
        Ok(()) => {
            terminal::out(&format!("wrote {}\n", directory.join(PAGE).display()));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&error.to_string());
            Outcome::Failed
        }
    }
}

fn unread(error: &ResultsError) -> Outcome {
    terminal::error(&error.to_string());
    Outcome::Usage
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
