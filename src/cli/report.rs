//! `trackbed report`: the page of a run, made again from its directory.

use super::{Outcome, terminal};
use crate::report::{self, BedTestsPage, Figure};
use crate::results::{self, BedTestsView, NamedBytes, ResultsError, SoFar};
use crate::store::{Directory, Finished, StoreError, Unfinished};
use crate::study;
use std::path::{Path, PathBuf};

/// Write the report page of a run, from its directory
///
/// A run that goes on now, or was interrupted, gets the page `so_far.html`: what it has recorded so far.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed report out
  trackbed report out --figures")]
pub(super) struct Arguments {
    /// The directory that `trackbed run --out` wrote.
    directory: PathBuf,
    /// Write every figure as an SVG file beside the page too.
    #[arg(long)]
    figures: bool,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    match found(&arguments.directory, arguments.figures) {
        Ok(told) => {
            terminal::summary(&format!("{told}\n"));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&error.to_string());
            Outcome::Usage
        }
    }
}

/// Writes the page of what is there, and says what has been written.
fn found(directory: &Path, figures: bool) -> Result<String, ResultsError> {
    // a commit that was killed is finished first
    let finished = Finished::open(directory)?;
    if let Some(study) =
        finished.as_ref().map(|finished| &finished.manifest().work).filter(|work| work.name.starts_with("study "))
    {
        let (page, name) = (directory.join(study::PAGE), &study.name);
        return Ok(format!(
            "`{}` holds a finished {name}. Its page is `{}`.\nTo write the page again, run the same `trackbed study` \
             command with `--resume`: no point is computed again.",
            directory.display(),
            page.display()
        ));
    }
    match Unfinished::open(directory)? {
        Some(unfinished) => write_so_far(&unfinished, figures),
        None if finished.is_none() => Err(StoreError::Empty { path: directory.to_owned() }.into()),
        None => write(directory, figures).map(|page| format!("wrote {}", page.display())),
    }
}

/// Shows what unfinished work has so far, without disturbing who is at work on it.
fn write_so_far(unfinished: &Unfinished, figures: bool) -> Result<String, ResultsError> {
    let (path, work) = (unfinished.path().display(), &unfinished.work().name);
    let Some(so_far) = SoFar::read(unfinished)? else {
        return Ok(format!("`{path}` holds a {work} that is not finished and has nothing to show yet"));
    };
    let page = unfinished.show(report::page_so_far(&so_far).as_bytes())?;
    let pictures = if figures { "; `--figures` acts when it is finished" } else { "" };
    Ok(format!("wrote {}: {}{pictures}", page.display(), report::standing(&so_far)))
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
