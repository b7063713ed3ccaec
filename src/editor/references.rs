//! All references to the same item or transition, and renaming of all references.

use super::definition::item;
use super::files::Places;
use super::marks::{Mark, Marks, What};
use super::view::View;
use crate::check::{Files, ItemId};
use crate::diag::{FileId, Sources, Span};
use lsp_types::{Location, Range, TextEdit, Url, WorkspaceEdit};
use std::collections::HashMap;

/// Another scene of the workspace, with its own names; it may use the file of a declaration.
pub struct Neighbour {
    pub sources: Sources,
    pub files: Files,
    pub places: Places,
}

/// The target of a search: an item of a file, or a transition of this scene.
enum Wanted {
    /// The address of the file, and the place of the name in it.
    Item(Url, Span),
    Transition(String),
}

/// All references to the item at an offset, including its declaration.
pub fn references(view: &View, neighbours: &[Neighbour], offset: usize) -> Vec<Location> {
    let Some(wanted) = wanted(view, offset) else { return Vec::new() };
    let sources = &view.survey.checked.sources;
    let mut found = in_scene(&wanted, sources, &view.survey.files, &view.places);
    for neighbour in neighbours {
        let more = in_scene(&wanted, &neighbour.sources, &neighbour.files, &neighbour.places);
        found.extend(more);
    }
    found.sort_by(|a, b| (a.uri.as_str(), a.range.start).cmp(&(b.uri.as_str(), b.range.start)));
    found.dedup();
    found
}

fn wanted(view: &View, offset: usize) -> Option<Wanted> {
    let mark = view.mark(offset)?;
    let text = view.text.get(mark.span.start as usize..mark.span.end as usize)?;
    if let What::Transition(_) = mark.what {
        return Some(Wanted::Transition(text.to_owned()));
    }
    let (_, span) = view.survey.files.name(item(view, offset)?);
    Some(Wanted::Item(view.places.address(&view.survey.checked.sources, span.file)?, span))
}

fn in_scene(wanted: &Wanted, sources: &Sources, files: &Files, places: &Places) -> Vec<Location> {
    let mut found = Vec::new();
    for (scope, here) in files.scopes.iter().enumerate().filter(|(_, here)| !here.library) {
        let file = here.tree.file;
        for mark in Marks::new(files, scope).0.iter().filter(|mark| names(mark, wanted, sources, files, places)) {
            found.extend(places.location(sources, file, mark.span.start as usize, mark.span.end as usize));
        }
    }
    found
}

/// Whether a mark refers to the target.
fn names(mark: &Mark, wanted: &Wanted, sources: &Sources, files: &Files, places: &Places) -> bool {
    match (wanted, &mark.what) {
        (Wanted::Transition(name), What::Transition(_)) => {
            mark.span.file == FileId(0) && sources.text(mark.span) == name
        }
        (Wanted::Item(address, span), What::Declared(id) | What::Reference(id)) => {
            let (_, named) = files.name(*id);
            (named.start, named.end) == (span.start, span.end)
                && places.address(sources, named.file).as_ref() == Some(address)
        }
        _ => false,
    }
}

/// The range of a name that can be changed, or the reason why it cannot be changed.
pub fn renamable(view: &View, offset: usize) -> Result<Range, String> {
    let mark = view.mark(offset).ok_or("there is no name here")?;
    match mark.what {
        What::Transition(_) => return Ok(view.range_of(mark)),
        What::Declared(id) | What::Reference(id) => own_name(view, id)?,
        _ => return Err("only the names of declarations, `let`s and transitions can be changed".into()),
    }
    Ok(view.range_of(mark))
}

fn own_name(view: &View, id: ItemId) -> Result<(), String> {
    let files = &view.survey.files;
    if files.scopes[id.scope].library {
        return Err("the standard library cannot be changed: declare your own name that extends the entry".into());
    }
    match files.declaration(id) {
        Some(declaration) if declaration.name.is_none() => Err("this declaration has no name except its kind".into()),
        _ => Ok(()),
    }
}

/// The edits that rename the item at an offset, or the reason why it cannot have the name.
pub fn rename(view: &View, neighbours: &[Neighbour], offset: usize, name: &str) -> Result<WorkspaceEdit, String> {
    renamable(view, offset)?;
    legal(name)?;
    if let Some(id) = item(view, offset)
        && view.survey.files.named(id.scope, name).is_some_and(|other| other != id)
    {
        return Err(format!("`{name}` is already declared"));
    }
    let mut changes: HashMap<Url, Vec<TextEdit>> = HashMap::new();
    for place in references(view, neighbours, offset) {
        changes.entry(place.uri).or_default().push(TextEdit::new(place.range, name.to_owned()));
    }
    Ok(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

/// Reserved words of the language.
const TAKEN: [&str; 10] = ["use", "let", "as", "per", "none", "auto", "yes", "no", "rest", "all"];

fn legal(name: &str) -> Result<(), String> {
    let letters = name.starts_with(|c: char| c.is_ascii_alphabetic());
    if !letters || !name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') {
        return Err(format!("`{name}` is not a valid name: write a letter first, then letters, digits and `_`"));
    }
    if TAKEN.contains(&name) {
        return Err(format!("`{name}` is a word of the language and cannot be a name"));
    }
    Ok(())
}
