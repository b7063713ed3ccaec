//! Diagnostics of a check: each once, and diagnostics that wait until every object is known.

use crate::diag::{Code, Diagnostic, Span};
use std::collections::HashSet;

/// The diagnostics of a check, in the order in which they were found.
#[derive(Default)]
pub struct Findings {
    pub diagnostics: Vec<Diagnostic>,
    /// Reported diagnostics, by code, message and place.
    reported: HashSet<(Code, String, Option<Span>)>,
    missing: Vec<Gap>,
}

/// A missing part of an object.
struct Gap {
    object: Span,
    /// Places of the objects that it extends.
    bases: Vec<Span>,
    what: String,
    diagnostic: Diagnostic,
}

impl Findings {
    /// Begins with the diagnostics of reading the texts.
    pub fn new(diagnostics: Vec<Diagnostic>) -> Findings {
        Findings { diagnostics, ..Findings::default() }
    }

    /// Adds a mistake once, even if several paths lead to its place.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        let place = diagnostic.labels.first().map(|l| l.span);
        if self.reported.insert((diagnostic.code, diagnostic.message.clone(), place)) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// Notes that the object at a place lacks a part. A part that one of its bases also lacks is reported for the base
    /// only, see [`Self::say_missing`].
    pub fn lacks(&mut self, object: Span, bases: &[Span], what: &str, diagnostic: Diagnostic) {
        self.missing.push(Gap { object, bases: bases.to_vec(), what: what.to_string(), diagnostic });
    }

    /// Reports missing parts, once if several objects inherit the gap.
    pub fn say_missing(&mut self) {
        let missing = std::mem::take(&mut self.missing);
        let gaps: HashSet<(Span, &str)> = missing.iter().map(|gap| (gap.object, gap.what.as_str())).collect();
        for gap in &missing {
            if !gap.bases.iter().any(|base| gaps.contains(&(*base, gap.what.as_str()))) {
                self.report(gap.diagnostic.clone());
            }
        }
    }

    /// The number of errors so far.
    pub fn errors(&self) -> usize {
        self.diagnostics.iter().filter(|d| d.is_error()).count()
    }
}
