//! A text that is being prepared for the grammar.

use std::collections::BTreeSet;

use super::limits;
use super::token::Token;
use crate::diag::{Diagnostic, FileId, Span};

/// A text during preparation, with the replacements and insertions so far.
pub(super) struct Draft<'a> {
    pub file: FileId,
    pub original: &'a str,
    pub bytes: Vec<u8>,
    /// Brackets to put in, each before the byte at its offset.
    pub insertions: Vec<(usize, char)>,
    /// Places of values that are already reported.
    pub poisoned: BTreeSet<usize>,
    pub diagnostics: Vec<Diagnostic>,
}

impl Draft<'_> {
    pub fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    pub fn is_full(&self) -> bool {
        self.diagnostics.len() >= limits::DIAGNOSTICS
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        if !self.is_full() {
            self.diagnostics.push(diagnostic);
        }
    }

    /// A part of the text as it is now, with single blanks.
    pub fn written(&self, start: usize, end: usize) -> String {
        let part = String::from_utf8_lossy(&self.bytes[start..end]);
        if part == self.original[start..end] {
            return part.trim().to_owned();
        }
        part.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Writes `new` over a token and replaces the rest of the token by blanks, except line breaks.
    pub fn overwrite(&mut self, token: &Token, new: &str) {
        for (i, byte) in self.bytes[token.start..token.end].iter_mut().enumerate() {
            match new.as_bytes().get(i) {
                Some(replacement) => *byte = *replacement,
                None if *byte == b'\n' => {}
                None => *byte = b' ',
            }
        }
    }
}
