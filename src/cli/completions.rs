//! `trackbed completions`: completion scripts for shells.

use super::{Cli, Outcome, terminal};
use clap::CommandFactory;
use clap_complete::Shell;

/// Write the completion script of a shell
///
/// The script goes to standard output. Save it where the shell looks for completions.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  trackbed completions bash > ~/.local/share/bash-completion/completions/trackbed
  trackbed completions zsh > ~/.zfunc/_trackbed
  trackbed completions fish > ~/.config/fish/completions/trackbed.fish")]
pub(super) struct Arguments {
    #[arg(value_enum)]
    shell: Shell,
}

pub(super) fn run(arguments: &Arguments) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "trackbed", &mut script);
    terminal::out(&String::from_utf8_lossy(&script));
    Outcome::Fine
}
