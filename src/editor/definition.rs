//! The definition of a name: in this file, in a module, or in the standard library.

use super::marks::{Mark, Place, What};
use super::view::View;
use crate::check::ItemId;
use crate::diag::Span;
use lsp_types::Location;

/// The definition of the word at an offset.
pub fn definition(view: &View, offset: usize) -> Option<Location> {
    if let Some(file) = data_file(view, offset) {
        return Some(file);
    }
    let mark = view.mark(offset)?;
    let span = match &mark.what {
        What::Declared(id) | What::Reference(id) => view.survey.files.name(*id).1,
        What::Module(scope) => Span::new(view.survey.files.scopes[*scope].tree.file, 0, 0),
        What::Field(_, _, Some(place)) => given(view, mark, place)?,
        What::Transition(_) => transition(view, mark)?,
        _ => return None,
    };
    let sources = &view.survey.checked.sources;
    view.places.location(sources, span.file, span.start as usize, span.end as usize)
}

/// The place that gives a field of a path: for `open.pad` the field of `open`; on the left of `=` the field of the
/// extended item.
fn given(view: &View, mark: &Mark, place: &Place) -> Option<Span> {
    let files = &view.survey.files;
    let found = files.given(place.id, &place.path)?;
    if found.file != mark.span.file || !found.covers(mark.span) {
        return Some(found);
    }
    let base = files.declaration(place.id)?.base.as_ref()?;
    let target = files.target(base, place.id.scope)?;
    files.given(target.id, &place.path)
}

/// The place at which a track names the transition.
fn transition(view: &View, mark: &Mark) -> Option<Span> {
    let text = |span: Span| view.text.get(span.start as usize..span.end as usize);
    let named = view
        .marks
        .0
        .iter()
        .find(|other| matches!(other.what, What::Transition(true)) && text(other.span) == text(mark.span))?;
    Some(named.span)
}

/// The data file in `file("level.csv")`.
fn data_file(view: &View, offset: usize) -> Option<Location> {
    let mark = view.marks.find(offset).filter(|mark| matches!(mark.what, What::Text))?;
    let before = view.text.get(..mark.span.start as usize)?.trim_end().strip_suffix('(')?;
    if !before.trim_end().ends_with("file") {
        return None;
    }
    let name = view.text.get(mark.span.start as usize + 1..(mark.span.end as usize).checked_sub(1)?)?;
    let (file, _) = view.survey.checked.sources.iter().find(|(_, source)| source.name == name && !source.library)?;
    view.places.location(&view.survey.checked.sources, file, 0, 0)
}

/// The item that the word at an offset refers to.
pub fn item(view: &View, offset: usize) -> Option<ItemId> {
    match view.mark(offset)?.what {
        What::Declared(id) | What::Reference(id) => Some(id),
        _ => None,
    }
}
