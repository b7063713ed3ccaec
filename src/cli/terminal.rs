//! Output to the terminal: plain text in pipes and files, colour on terminals.

use crate::diag::{Diagnostic, Sources, render};
use clap::ValueEnum;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::OnceLock;

/// When messages have colour.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Colour {
    /// On a terminal, unless the environment variable `NO_COLOR` is set.
    #[default]
    Auto,
    Always,
    Never,
}

/// Colour and amount of output: options of every command.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
pub(super) struct Manner {
    /// When messages have colour
    #[arg(long = "color", alias = "colour", value_name = "WHEN", value_enum, default_value = "auto", global = true)]
    colour: Colour,
    /// Print errors and the requested output only: no warnings, no progress, no summary
    #[arg(short, long, global = true)]
    quiet: bool,
}

/// The options of the command line.
static MANNER: OnceLock<Manner> = OnceLock::new();

/// Sets colour and amount of output, once, before anything is printed.
pub(super) fn speak(manner: Manner) {
    let _ = MANNER.set(manner);
}

fn manner() -> Manner {
    MANNER.get().copied().unwrap_or_default()
}

/// Whether only errors and the requested output are printed.
pub(super) fn is_quiet() -> bool {
    manner().quiet
}

/// The first error of standard output.
static LOST: OnceLock<String> = OnceLock::new();

/// Writes to standard output. A closed pipe is not an error; [`lost`] gives every other error.
pub(super) fn out(text: &str) {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            LOST.get_or_init(|| error.to_string());
        }
        _ => {}
    }
}

/// Writes a summary to standard output, unless the command is quiet.
pub(super) fn summary(text: &str) {
    if !is_quiet() {
        out(text);
    }
}

/// The error that lost a part of standard output; `None` if everything was written.
pub(super) fn lost() -> Option<&'static str> {
    LOST.get().map(String::as_str)
}

/// Writes to standard error.
fn say(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// Writes to standard error, unless the command is quiet.
pub(super) fn note(text: &str) {
    if !is_quiet() {
        say(text);
    }
}

/// `error: ...` on standard error, for mistakes that are not in a file.
pub(super) fn error(text: &str) {
    say(&format!("error: {text}\n"));
}

/// Draws diagnostics over their sources on standard error; a quiet command shows errors only.
pub(super) fn diagnostics(diagnostics: &[Diagnostic], sources: &Sources) {
    let shown: Vec<Diagnostic> = diagnostics.iter().filter(|d| d.is_error() || !is_quiet()).cloned().collect();
    if !shown.is_empty() {
        say(&render::human(&shown, sources, has_colour(), width()));
    }
}

/// Whether messages have colour.
fn has_colour() -> bool {
    match manner().colour {
        Colour::Always => true,
        Colour::Never => false,
        Colour::Auto => std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
    }
}

/// Columns of the terminal, for wrapping.
fn width() -> usize {
    std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok()).filter(|w| *w >= 40).unwrap_or(110).min(140)
}

/// A table with columns as wide as their widest cell, aligned to the left.
pub(super) fn aligned(table: &[Vec<String>]) -> String {
    let columns = table.first().map_or(0, Vec::len);
    let width = |column: usize| table.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells: String = row.iter().zip(&widths).map(|(cell, width)| format!("  {cell:<width$}")).collect();
        format!("{}\n", cells.trim_end())
    };
    table.iter().map(line).collect()
}
