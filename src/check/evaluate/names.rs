//! Looks names up: the meaning of a path in its file.

use super::evaluator::{COMPARED, Evaluator};
use super::value::{Slot, Val};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Fix, Help, Span};
use crate::schema::{Names, called};
use crate::syntax::tree::{Item, Name, Path};

/// The item that a path names, and the number of names left to follow inside it.
pub struct Resolved {
    pub id: ItemId,
    pub is_let: bool,
    pub taken: usize,
}

/// Largest number of names in the help of a diagnostic.
const LISTED: usize = 30;

/// The first of some names, with the number of the others.
fn some_of<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let others = names.len().saturating_sub(LISTED);
    let first = names.take(LISTED).collect::<Vec<_>>().join(", ");
    if others > 0 { format!("{first} and {others} more") } else { first }
}

impl Evaluator<'_> {
    /// The declaration or let that a path starts with; a diagnostic if there is none. `words` are also allowed there.
    pub fn resolve(&mut self, path: &Path, scope: ScopeId, words: &[&str]) -> Option<Resolved> {
        let first = &path.names[0];
        // if a name is also the name of a module, which has been reported, the longer path decides
        if let (Some(&module), Some(second)) = (self.scopes[scope].modules.get(&first.text), path.names.get(1))
            && let Some(target) = self.lookup(module, second, 2)
        {
            self.note_library(target.id, path.span, scope);
            return Some(target);
        }
        if let Some(target) = self.lookup(scope, first, 1) {
            return Some(target);
        }
        if self.scopes[scope].broken.contains(&first.text) {
            return None;
        }
        if let Some(&module) = self.scopes[scope].modules.get(&first.text) {
            let Some(second) = path.names.get(1) else {
                self.findings.report(
                    Diagnostic::new(Code::E0201, format!("`{}` is a module, not a value", first.text))
                        .label(path.span, "name an entry of the module")
                        .maybe_help(
                            self.scopes[module].names.keys().next().map(|n| format!("such as `{}.{n}`", first.text)),
                        ),
                );
                return None;
            };
            let may_compare = self.may_compare(self.scopes[module].names.len());
            let names = self.scopes[module].names.keys().map(String::as_str);
            let near = may_compare.then(|| nearest(&second.text, names.clone())).flatten();
            let help = match near {
                Some(near) => {
                    Help { said: format!("did you mean `{}.{near}`?", first.text), writes: vec![near.to_owned()] }
                }
                None => Help::say(format!("it has {}", some_of(names))),
            };
            self.findings.report(
                Diagnostic::new(Code::E0201, format!("module `{}` has no `{}`", first.text, second.text))
                    .label(second.span, "not found")
                    .advise(second.span, help),
            );
            return None;
        }
        self.unknown_name(path, scope, words);
        None
    }

    /// Notes each place in the user's files, or in a default, that names an entry of the standard library.
    fn note_library(&mut self, id: ItemId, span: Span, scope: ScopeId) {
        let of_library = |scope: ScopeId| self.scopes[scope].library;
        if scope == self.standard {
            self.library_uses.entry(id).or_insert(None);
        } else if of_library(id.scope) && !of_library(scope) {
            self.library_uses.entry(id).or_insert(Some(span)).get_or_insert(span);
        }
    }

    fn lookup(&self, scope: ScopeId, name: &Name, taken: usize) -> Option<Resolved> {
        let item = *self.scopes[scope].names.get(&name.text)?;
        let is_let = matches!(self.scopes[scope].tree.items.get(item), Some(Item::Let(_)));
        Some(Resolved { id: ItemId { scope, item }, is_let, taken })
    }

    fn unknown_name(&mut self, path: &Path, scope: ScopeId, words: &[&str]) {
        let (name, behind) = (&path.names[0], &path.text()[path.names[0].text.len()..]);
        if self.unread_word(name) {
            return;
        }
        let may_compare = self.may_compare(self.scopes[scope].names.len());
        let here = &self.scopes[scope];
        let candidates = here.names.keys().chain(here.modules.keys()).map(String::as_str).chain(words.iter().copied());
        let known = called(Names::Words, &name.text, words.iter().copied());
        let modules = here.modules.clone();
        let near = known.or_else(|| may_compare.then(|| nearest(&name.text, candidates)).flatten());
        let near = near.map(|near| match modules.contains_key(near) {
            true => Help { said: format!("did you mean `{near}{behind}`?"), writes: vec![near.to_owned()] },
            false => Help::meant(near),
        });
        let mut place = name.span;
        let mut line = None;
        let library = crate::check::text::library::MODULES.iter().any(|(m, _)| *m == name.text);
        let help = if name.text == "std" && path.names.len() > 1 {
            place = path.span;
            Some(
                Help::write(behind.trim_start_matches('.')).and(": `use std` brings its modules in by their own names"),
            )
        } else if library && !here.modules.contains_key(&name.text) {
            // one missing line is reported once, for all its modules
            if !self.without_library.insert(scope) || self.wanted_library(name.span) {
                return;
            }
            line = Some(self.first_line(name.span));
            Some(Help::say("it is a module of the standard library: begin the file with `use std`"))
        } else if let Some(entry) = self.entry_called(&name.text).filter(|_| near.is_none()) {
            Some(Help { said: format!("did you mean `{entry}` of the standard library?"), writes: vec![entry] })
        } else if near.is_none() && crate::units::parse_unit(&name.text).is_ok() {
            let unit = "is a unit, write it without blanks around `/` and `*`: `km/h`, `kN s/m`";
            Some(Help::say(format!("if `{}` {unit}", name.text)))
        } else if near.is_none() && !words.is_empty() {
            let words: Vec<String> = words.iter().map(|w| format!("`{w}`")).collect();
            Some(Help::say(format!("expected {}", crate::diag::or_list(&words))))
        } else {
            near
        };
        self.findings.report(
            Diagnostic::new(Code::E0201, format!("nothing is called `{}`", name.text))
                .label(name.span, "unknown name")
                .maybe_advise(place, help)
                .maybe_fix(line.map(|line| Fix::replace(line, "use std\n"))),
        );
    }

    /// Whether an unknown name is compared with so many known ones, see [`COMPARED`].
    fn may_compare(&mut self, known: usize) -> bool {
        self.compared += known;
        self.compared <= COMPARED
    }

    /// The place for a new first line of a file: before its first item and the comments above it.
    fn first_line(&self, place: Span) -> Span {
        let tree = self.scopes.iter().find(|scope| scope.tree.file == place.file).map(|scope| scope.tree.clone());
        let first = tree.and_then(|tree| tree.items.first().map(|item| (item.span(), item.docs().len())));
        let text = &self.files.sources.get(place.file).text;
        let (start, docs) = first.map_or((0, 0), |(span, docs)| (span.start as usize, docs));
        let begin = |end: usize| text[..end].rfind('\n').map_or(0, |i| i + 1);
        let start = (0..docs).fold(begin(start), |line, _| begin(line.saturating_sub(1)));
        Span::new(place.file, start, start)
    }

    /// Whether a reported line of that file should have brought in the standard library: `import std`.
    fn wanted_library(&self, place: Span) -> bool {
        let lost =
            self.findings.diagnostics.iter().filter(|d| matches!(d.code, Code::E0101 | Code::E0105 | Code::E0204));
        let mut labels = lost.filter_map(|d| d.labels.first()).filter(|label| label.span.file == place.file);
        let text = &self.files.sources.get(place.file).text;
        labels.any(|label| {
            let start = text[..label.span.start as usize].rfind('\n').map_or(0, |i| i + 1);
            let line = text[start..].lines().next().unwrap_or_default();
            line.contains("std") && !line.contains('=')
        })
    }

    /// The entry of the standard library with that name, else the entry with a similar name, with its module.
    pub(super) fn entry_called(&self, name: &str) -> Option<String> {
        let modules = &self.scopes[self.standard].modules;
        let entries = modules.iter().flat_map(|(module, scope)| {
            let names = self.scopes[*scope].names.keys();
            names.map(move |entry| (module, entry))
        });
        let exact = entries.clone().find(|(_, entry)| *entry == name);
        let found = exact.or_else(|| {
            let near = nearest(name, entries.clone().map(|(_, entry)| entry.as_str())).filter(|_| name.len() > 3)?;
            entries.clone().find(|(_, entry)| *entry == near)
        });
        found.map(|(module, entry)| format!("{module}.{entry}"))
    }

    /// The slot that the rest of a path names inside a declaration.
    pub fn slot_at(&mut self, target: &Resolved, path: &Path) -> Option<Slot> {
        let record = self.record(target.id, path.span)?;
        let mut slot = Slot { value: Val::Record(record), span: path.span, origin: crate::scenario::Origin::Derived };
        for name in &path.names[target.taken..] {
            let Val::Record(record) = &slot.value else {
                self.findings.report(
                    Diagnostic::new(Code::E0201, format!("a value has no part called `{}`", name.text))
                        .label(name.span, "not an object"),
                );
                return None;
            };
            let record = record.clone();
            match record.get(&name.text) {
                Some(inner) => slot = inner.clone(),
                None => {
                    if self.field_of(record.kind, name).is_some() && !record.partial {
                        self.findings.report(
                            Diagnostic::new(Code::E0403, format!("`{}` does not give `{}`", record.name, name.text))
                                .label(name.span, "not given there")
                                .label(record.span, "declared here"),
                        );
                    }
                    return None;
                }
            }
        }
        Some(slot)
    }
}
