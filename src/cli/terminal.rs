//! What a person sees: plain text where it is piped, colour on a terminal that wants it.

use std::io::{IsTerminal, Write};

/// Writes to standard output; a reader that has gone away is no mistake.
pub(super) fn out(text: &str) {
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}

/// Writes to standard error.
pub(super) fn note(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

/// `error: ...` on standard error, for mistakes that stand in no file.
pub(super) fn error(text: &str) {
    note(&format!("error: {text}\n"));
}

/// Whether standard error is a terminal that shows colour.
pub(super) fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

/// Columns of the terminal, for wrapping.
pub(super) fn width() -> usize {
    std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok()).filter(|w| *w >= 40).unwrap_or(110).min(140)
}
