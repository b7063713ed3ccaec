//! One version of a text with its names and values: the input of every request.

use super::files::Places;
use super::marks::{Mark, Marks};
use super::positions::Lines;
use crate::check::{ItemId, Modules, Survey, survey};
use crate::diag::{FileId, Source};
use crate::syntax::tree::{Declaration, Item, Tree};
use lsp_types::Range;
use std::sync::Arc;

/// A text with its places, names and values.
pub struct View {
    pub text: Arc<str>,
    pub lines: Lines,
    pub survey: Survey,
    /// The words of the text.
    pub marks: Marks,
    pub places: Places,
}

impl View {
    /// Reads a text with the name `name` in messages.
    pub fn new(name: &str, text: Arc<str>, modules: &dyn Modules, places: Places) -> View {
        let survey = survey(name, &text, modules);
        let marks = Marks::new(&survey.files, survey.files.main);
        View { lines: Lines::new(&text), text, survey, marks, places }
    }

    /// The tree of the text.
    pub fn tree(&self) -> &Tree {
        &self.survey.files.scopes[self.survey.files.main].tree
    }

    /// The declarations of the text.
    pub fn declarations(&self) -> impl Iterator<Item = (ItemId, &Declaration)> {
        let scope = self.survey.files.main;
        self.tree().items.iter().enumerate().filter_map(move |(item, thing)| match thing {
            Item::Declaration(declaration) => Some((ItemId { scope, item }, declaration)),
            _ => None,
        })
    }

    /// The word at an offset.
    pub fn mark(&self, offset: usize) -> Option<&Mark> {
        self.marks.find(offset)
    }

    /// A source of the scene.
    pub fn source(&self, file: FileId) -> &Source {
        self.survey.checked.sources.get(file)
    }

    /// The range of a part of the text.
    pub fn range(&self, start: u32, end: u32) -> Range {
        self.lines.range(&self.text, start as usize, end as usize)
    }

    /// The range of a mark.
    pub fn range_of(&self, mark: &Mark) -> Range {
        self.range(mark.span.start, mark.span.end)
    }
}
