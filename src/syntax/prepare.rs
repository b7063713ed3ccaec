//! Prepares a text for the grammar: checks bounds, replaces foreign signs and balances brackets, each with a
//! diagnostic. The prepared text keeps every offset, except for inserted closing brackets. [`Prepared`] removes these
//! when it converts a place to the original.

use std::collections::BTreeSet;

use super::draft::Draft;
use super::token::tokens;
use super::{balance, declared, foreign, header, indented, limits, quotes, unfit, uses};
use crate::diag::{Code, Diagnostic, FileId, Span};

/// A text that the grammar can read whole.
pub(super) struct Prepared<'a> {
    pub file: FileId,
    source: &'a str,
    pub text: String,
    /// Offsets in `text` of inserted brackets, ascending.
    inserted: Vec<usize>,
    poisoned: BTreeSet<usize>,
}

impl Prepared<'_> {
    /// The place in the original of an offset in `text`.
    pub fn original(&self, offset: usize) -> usize {
        (offset - self.inserted.partition_point(|i| *i < offset)).min(self.source.len())
    }

    /// The span in the original of a part of `text`: whole characters, also if shorter characters have replaced them.
    pub fn span(&self, start: usize, end: usize) -> Span {
        let (mut start, mut end) = (self.original(start), self.original(end));
        while !self.source.is_char_boundary(start) {
            start -= 1;
        }
        while !self.source.is_char_boundary(end) {
            end += 1;
        }
        Span::new(self.file, start, end.max(start))
    }

    /// Whether the bracket at this offset of `text` was inserted.
    pub fn is_inserted(&self, offset: usize) -> bool {
        self.inserted.binary_search(&offset).is_ok()
    }

    /// Whether a mistake between these offsets of `text` is already reported.
    pub fn is_poisoned(&self, start: usize, end: usize) -> bool {
        self.poisoned.range(self.original(start)..self.original(end).max(self.original(start) + 1)).next().is_some()
    }
}

/// A text ready for the grammar, or nothing if it is beyond the bounds; and its mistakes.
pub(super) fn prepare(file: FileId, original: &str) -> (Option<Prepared<'_>>, Vec<Diagnostic>) {
    if original.len() > limits::BYTES {
        let size = original.len() as f64 / f64::from(1 << 20);
        let mistake = Diagnostic::new(Code::E0103, format!("the file has {size:.1} MiB, more than the limit of 8 MiB"))
            .label(Span::new(file, 0, 0), "")
            .help("move declarations to a module, or tables to a `file(\"...\")`");
        return (None, vec![mistake]);
    }
    let mut tokens = tokens(original);
    let mut draft = Draft {
        file,
        original,
        bytes: original.as_bytes().to_vec(),
        insertions: Vec::new(),
        poisoned: BTreeSet::new(),
        diagnostics: Vec::new(),
    };
    unfit::tell(&mut draft);
    uses::mend(&mut draft, &mut tokens);
    quotes::mend(&mut draft, &mut tokens);
    declared::mend(&mut draft, &mut tokens);
    indented::mend(&mut draft, &mut tokens);
    header::mend(&mut draft, &mut tokens);
    let balanced = balance::is_balanced(original, &tokens);
    foreign::replace(&mut draft, &tokens, balanced);
    if let Err(beyond) = balance::balance(&mut draft, &tokens, balanced) {
        return (None, vec![beyond]);
    }
    let Draft { bytes, mut insertions, poisoned, diagnostics, .. } = draft;
    // at one place, what was open is closed before something new opens
    insertions.sort_by_key(|(offset, bracket)| (*offset, matches!(bracket, '(' | '[' | '{')));
    // Only whole characters were replaced; if this ever fails, the original text still gives the mistakes.
    let replaced = String::from_utf8(bytes).unwrap_or_else(|_| original.to_owned());
    let mut text = String::with_capacity(replaced.len() + insertions.len());
    let mut inserted = Vec::with_capacity(insertions.len());
    let mut from = 0;
    for (offset, bracket) in insertions {
        text.push_str(&replaced[from..offset]);
        inserted.push(text.len());
        text.push(bracket);
        from = offset;
    }
    text.push_str(&replaced[from..]);
    (Some(Prepared { file, source: original, text, inserted, poisoned }), diagnostics)
}
