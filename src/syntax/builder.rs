//! The builder of the tree: the prepared text, and the mistakes found so far.

use pest::iterators::Pair;

use super::grammar::Rule;
use super::limits;
use super::prepare::Prepared;
use crate::diag::{Diagnostic, Span};

pub(super) struct Builder<'p> {
    pub prepared: &'p Prepared<'p>,
    pub diagnostics: &'p mut Vec<Diagnostic>,
    /// Operations around the current place: the tree is as deep as they nest.
    pub operations: usize,
}

impl<'p> Builder<'p> {
    pub fn new(prepared: &'p Prepared<'p>, diagnostics: &'p mut Vec<Diagnostic>) -> Self {
        Builder { prepared, diagnostics, operations: 0 }
    }

    pub fn report(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < limits::DIAGNOSTICS {
            self.diagnostics.push(diagnostic);
        }
    }

    pub fn is_full(&self) -> bool {
        self.diagnostics.len() >= limits::DIAGNOSTICS
    }

    pub fn text(&self, start: usize, end: usize) -> &'p str {
        &self.prepared.text[start..end]
    }

    pub fn span(&self, start: usize, end: usize) -> Span {
        self.prepared.span(start, end)
    }

    pub fn span_of(&self, pair: &Pair<Rule>) -> Span {
        self.span(pair.as_span().start(), pair.as_span().end())
    }
}

pub(super) fn first_line(text: &str) -> &str {
    let line = text.lines().next().unwrap_or("");
    line.split("//").next().unwrap_or("").trim_end().trim_end_matches(',')
}
