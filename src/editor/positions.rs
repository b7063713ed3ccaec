//! Places in a text: byte offsets here, lines and UTF-16 columns in the protocol.

use lsp_types::{Position, Range};

/// Offsets of the lines of a text.
#[derive(Debug, Clone)]
pub struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    /// Reads a text once. A line ends with `\n`, `\r\n` or `\r`, as editors count them.
    pub fn new(text: &str) -> Lines {
        let bytes = text.as_bytes();
        let ends = |i: &usize| bytes[*i] == b'\n' || bytes[*i] == b'\r' && bytes.get(i + 1) != Some(&b'\n');
        Lines { starts: std::iter::once(0).chain((0..bytes.len()).filter(ends).map(|i| i + 1)).collect() }
    }

    /// The offset of a position, which may lie beyond its line or the text.
    pub fn offset(&self, text: &str, position: Position) -> usize {
        let line = position.line as usize;
        let Some(start) = self.starts.get(line) else { return text.len() };
        let end = self.starts.get(line + 1).copied().unwrap_or(text.len());
        let content = text[*start..end].trim_end_matches(['\n', '\r']);
        let mut left = position.character as usize;
        for (i, c) in content.char_indices() {
            if left < c.len_utf16() {
                return start + i;
            }
            left -= c.len_utf16();
        }
        start + content.len()
    }

    /// The position of an offset; an offset inside a character gives the beginning of the character.
    pub fn position(&self, text: &str, offset: usize) -> Position {
        let mut offset = offset.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.starts.partition_point(|start| *start <= offset) - 1;
        let before = &text[self.starts[line]..offset];
        let character = if before.is_ascii() { before.len() } else { before.encode_utf16().count() };
        Position::new(line as u32, character as u32)
    }

    /// The range of a part of the text.
    pub fn range(&self, text: &str, start: usize, end: usize) -> Range {
        Range::new(self.position(text, start), self.position(text, end.max(start)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn columns_count_utf16_units() {
        let text = "µ = 1\r\n😀x\rlast";
        let lines = Lines::new(text);
        assert_eq!(lines.position(text, text.find('x').unwrap()), Position::new(1, 2));
        assert_eq!(lines.position(text, text.find("last").unwrap()), Position::new(2, 0));
        assert_eq!(lines.offset(text, Position::new(0, 99)), text.find('\r').unwrap());
        assert_eq!(lines.offset(text, Position::new(1, 1)), text.find('😀').unwrap());
        assert_eq!(lines.offset(text, Position::new(9, 0)), text.len());
    }

    proptest! {
        #[test]
        fn a_place_comes_back(text in "[a-c µ😀\n]{0,40}", at in 0usize..60) {
            let lines = Lines::new(&text);
            let at = (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap();
            prop_assert_eq!(lines.offset(&text, lines.position(&text, at)), at);
        }
    }
}
