//! `trackbed fmt`: the one layout of a file.

use super::{Outcome, terminal};
use crate::check;
use crate::diag::Sources;
use crate::store::rewrite_atomically;
use crate::syntax;
use std::path::PathBuf;

/// Lay files out in the one way
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed fmt zone.track
  trackbed fmt --check scenarios/transition.track scenarios/wedge.track")]
pub(super) struct Arguments {
    /// Files to rewrite in place.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Change nothing; fail where a file is not laid out so.
    #[arg(long)]
    check: bool,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let mut outcome = Outcome::Fine;
    for file in &arguments.files {
        let name = file.display().to_string();
        let text = match check::read_bounded(file).map_err(|e| e.to_string()) {
            Ok(bytes) => match syntax::decode(&name, &bytes) {
                Ok(text) => text,
                Err(mistake) => {
                    terminal::diagnostics(&[mistake], &Sources::default());
                    outcome = Outcome::Failed;
                    continue;
                }
            },
            Err(error) => {
                terminal::error(&format!("cannot read `{name}`: {error}"));
                return Outcome::Usage;
            }
        };
        match syntax::format(&text) {
            Ok(laid_out) if laid_out == text => {}
            Ok(_) if arguments.check => {
                terminal::error(&format!("`{name}` is not in the standard layout; run `trackbed fmt {name}`"));
                outcome = Outcome::Failed;
            }
            Ok(laid_out) => {
                if let Err(error) = rewrite_atomically(file, laid_out.as_bytes()) {
                    terminal::error(&format!("cannot write `{name}`: {error}"));
                    return Outcome::Usage;
                }
            }
            Err(mistakes) => {
                let mut sources = Sources::default();
                sources.add(name, text, false);
                terminal::diagnostics(&mistakes, &sources);
                outcome = Outcome::Failed;
            }
        }
    }
    outcome
}
