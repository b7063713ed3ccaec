//! Formatting: the one layout of a file, as the smallest edit of whole lines.

use super::positions::Lines;
use crate::syntax;
use lsp_types::TextEdit;

/// The edits that format a text; empty if it is already formatted or cannot be parsed.
pub fn layout(text: &str, lines: &Lines) -> Vec<TextEdit> {
    match syntax::format(text) {
        Ok(laid_out) if laid_out != text => vec![difference(text, &laid_out, lines)],
        _ => Vec::new(),
    }
}

/// One edit from a text to another, without the equal lines at the beginning and at the end.
fn difference(old: &str, new: &str, lines: &Lines) -> TextEdit {
    let same = |a: &mut dyn Iterator<Item = &str>, b: &mut dyn Iterator<Item = &str>| {
        a.zip(b).take_while(|(a, b)| a == b).map(|(a, _)| a.len()).sum::<usize>()
    };
    let (old_lines, new_lines) = (|| old.split_inclusive('\n'), || new.split_inclusive('\n'));
    let head = same(&mut old_lines(), &mut new_lines());
    let (old_rest, new_rest) = (&old[head..], &new[head..]);
    let tail = same(&mut old_rest.split_inclusive('\n').rev(), &mut new_rest.split_inclusive('\n').rev());
    let range = lines.range(old, head, old.len() - tail);
    TextEdit::new(range, new_rest[..new_rest.len() - tail].to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_lines_that_change_are_edited() {
        let text = "use std\npad a {\nstiffness=40 MN/m\n}\nlet x = 1\n";
        let edits = layout(text, &Lines::new(text));
        assert_eq!(edits.len(), 1);
        assert_eq!((edits[0].range.start.line, edits[0].range.end.line), (2, 3));
        assert_eq!(edits[0].new_text, "  stiffness = 40 MN/m\n");
        assert!(layout("pad a {", &Lines::new("pad a {")).is_empty());
    }
}
