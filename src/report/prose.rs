//! Text of a page: safe, with what stands between backticks set as code.

use super::svg::escape;

/// A text as HTML. What stands between two backticks becomes code; a backtick without its second is left out.
pub(super) fn prose(text: &str) -> String {
    let pieces: Vec<String> = text.split('`').map(escape).collect();
    let closed = |index: usize| index % 2 == 1 && index + 1 < pieces.len();
    let set = |(index, piece): (usize, &String)| match closed(index) {
        true => format!("<code>{piece}</code>"),
        false => piece.clone(),
    };
    pieces.iter().enumerate().map(set).collect()
}
