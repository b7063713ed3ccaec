//! `trackbed man`: manual pages, made from the same text as `--help`.

use super::{Cli, Outcome, terminal};
use clap::CommandFactory;
use std::io;
use std::path::{Path, PathBuf};

/// Write the manual pages, one for each command
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed man --out ~/.local/share/man/man1
  trackbed man --out man && man man/trackbed-run.1")]
pub(super) struct Arguments {
    /// The directory for the pages; it is made if it does not exist
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let out = arguments.out.display();
    match write(&arguments.out) {
        Ok(()) => {
            terminal::summary(&format!("wrote {out}/trackbed.1 and a page for each command\n"));
            Outcome::Fine
        }
        Err(error) => {
            terminal::error(&format!("cannot write manual pages into `{out}`: {error}"));
            Outcome::Usage
        }
    }
}

fn write(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    clap_mangen::generate_to(Cli::command(), folder)
}
