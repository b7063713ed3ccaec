//! What a person sees: plain text where it is piped, colour on a terminal that wants it.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::OnceLock;

/// Why standard output has not taken all that was written, once it has not.
static LOST: OnceLock<String> = OnceLock::new();

/// Writes to standard output; a reader that has gone away is no mistake. What else goes wrong is told by [`lost`].
pub(super) fn out(text: &str) {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            LOST.get_or_init(|| error.to_string());
        }
        _ => {}
    }
}

/// Why something that was written to standard output is lost; `None` where all has arrived.
pub(super) fn lost() -> Option<&'static str> {
    LOST.get().map(String::as_str)
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

/// Columns as wide as their widest cell: text to the left, numbers begin there too.
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
