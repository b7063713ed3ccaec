//! `trackbed compare`: results side by side, and what differs in their scenes.

use super::{Format, Outcome, compare_summary, stored, subject, terminal};
use crate::compare::Comparison;
use crate::report::comparison_page;
use crate::store::{Directory, Finished, Mode, StoreError, Work, sha256};
use std::path::{Path, PathBuf};

/// Compare runs, tests of rigs or studies, from their directories
///
/// The first directory is what the others are compared with. Differences over several packings have a 95 % interval.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed compare as_it_is with_pads
  trackbed compare as_it_is with_pads --out comparison")]
pub(super) struct Arguments {
    /// Directories that `trackbed run` or `trackbed study` wrote with `--out`: two or more of one kind.
    #[arg(required = true, num_args = 2.., value_name = "DIR")]
    directories: Vec<PathBuf>,
    /// Where `compare.html` and its tables go.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let comparison = match Comparison::read(&arguments.directories) {
        Ok(comparison) => comparison,
        Err(error) => {
            terminal::error(&error.to_string());
            return Outcome::Usage;
        }
    };
    let page = match arguments.out.as_deref().map(|out| write(out, &comparison)).transpose() {
        Ok(page) => page,
        Err(error) => {
            let diagnostic = stored::diagnostic(&error);
            terminal::diagnostics(&[diagnostic], &Default::default());
            return Outcome::Failed;
        }
    };
    match arguments.format {
        Format::Human => terminal::out(&compare_summary::text(&comparison)),
        Format::Json => return subject::json(&comparison.json()),
    }
    if let Some(page) = page {
        terminal::summary(&format!("{}\n", page.display()));
    }
    Outcome::Fine
}

/// What stands in the manifest of a comparison.
const WORK: &str = "comparison";

/// Puts page and tables in place; an earlier comparison there is replaced, other files are not touched.
fn write(out: &Path, comparison: &Comparison) -> Result<PathBuf, StoreError> {
    let unwritable = |cause: &dyn std::fmt::Display| StoreError::unwritable(out, cause);
    let json = serde_json::to_string_pretty(&comparison.json()).map_err(|cause| unwritable(&cause))?;
    let earlier = Finished::open(out)?.is_some_and(|finished| finished.manifest().work.name == WORK);
    let work = Work { name: WORK.to_owned(), scene_sha256: sha256(json.as_bytes()) };
    let mut directory = Directory::open(out, work, if earlier { Mode::Force } else { Mode::New })?;
    for (name, bytes) in comparison.tables().map_err(|cause| unwritable(&cause))? {
        directory.stage(&name, &bytes)?;
    }
    directory.stage("compare.json", format!("{json}\n").as_bytes())?;
    directory.stage(PAGE, comparison_page(comparison).as_bytes())?;
    directory.commit()?;
    Ok(out.join(PAGE))
}

const PAGE: &str = "compare.html";
