//! The scene as one file: every object of the scene, with every default and library value written out and its origin.
//! The text is a legal file and gives the same scene, to the bit.
//!
//! Objects are written as they are after extension and overrides; an object is written before the objects that name it.
//! A named object inside a field becomes a declaration, so that sections, vehicles, layers and laws keep their names.
//! Studies are left out, because they edit lines of their own file.

mod inline;
pub(super) mod literal;
mod text;

use super::{Modules, Override, with_evaluator};
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::records::header;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::text::overrides::EDIT;
use crate::check::text::scope::ItemId;
use crate::diag::{self, Span};
use crate::scenario::Origin;
use crate::schema::{self, Field, Form, KINDS, Kind, Role};
use crate::syntax;
use crate::syntax::tree::Item;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// The text of [`super::check`] as one file with everything written out; `None` if it has errors or no track. Data
/// files must lie at the same place as for the original.
pub fn resolve(name: &str, text: &str, modules: &dyn Modules, overrides: &[Override]) -> Option<String> {
    let (_, resolved) = with_evaluator(name, text, modules, overrides, |eval| {
        if diag::has_errors(&eval.findings.diagnostics) || !eval.declares("track") {
            return None;
        }
        Some(Resolver::new(eval).file(name))
    });
    resolved.map(|text| syntax::format(&text).unwrap_or(text))
}

/// Writes objects, each once.
struct Resolver<'c, 'm> {
    eval: &'c mut Evaluator<'m>,
    /// Declarations by the place of their header.
    headers: HashMap<Span, ItemId>,
    /// Names that are used, or that would have another meaning.
    taken: BTreeSet<String>,
    /// Objects with a name, and that name.
    named: Vec<(Rc<Record>, String)>,
    /// Declarations so far; each before the declarations that name it.
    written: Vec<(&'static Kind, String)>,
}

impl<'c, 'm> Resolver<'c, 'm> {
    fn new(eval: &'c mut Evaluator<'m>) -> Self {
        let mut headers = HashMap::new();
        let mut taken = BTreeSet::new();
        for (scope, here) in eval.scopes.iter().enumerate() {
            for (item, declared) in here.tree.items.iter().enumerate() {
                let Item::Declaration(d) = declared else { continue };
                headers.insert(header(d), ItemId { scope, item });
                if scope == eval.main {
                    taken.insert(d.name.as_ref().unwrap_or(&d.kind).text.clone());
                }
            }
        }
        Resolver { eval, headers, taken, named: Vec::new(), written: Vec::new() }
    }

    /// The whole file, unformatted.
    fn file(mut self, name: &str) -> String {
        self.roots();
        // in the order of the vocabulary; objects of a kind keep their order
        self.written.sort_by_key(|(kind, _)| KINDS.iter().position(|k| k.name == kind.name));
        let head = format!("// {name}, with everything written out that it uses or leaves to a default\n");
        let left_out = self.eval.declares("study");
        let studies = if left_out { "// its studies stay there: they edit its lines\n" } else { "" };
        let written: Vec<String> = self.written.into_iter().map(|(_, text)| text).collect();
        format!("{head}{studies}\n{}", written.join("\n"))
    }

    /// Declarations that act by themselves, and all objects that they name.
    fn roots(&mut self) {
        let tree = self.eval.scopes[self.eval.main].tree.clone();
        for (item, declared) in tree.items.iter().enumerate() {
            let Item::Declaration(d) = declared else { continue };
            let acts = matches!(schema::kind(&d.kind.text).map(|k| k.role), Some(Role::Scene { .. }));
            if !acts || d.kind.text == "study" {
                continue;
            }
            if let Some(record) = self.eval.record(ItemId { scope: self.eval.main, item }, d.span) {
                let name = record.name.clone();
                self.declare(&record, &name);
            }
        }
        // both act in every scene, even if not given
        for kind in ["scenario", "solve"].into_iter().filter_map(schema::kind) {
            if !self.eval.declares(kind.name) {
                let span = Span::new(diag::FileId(0), 0, 0);
                self.declare(&Rc::new(Record::empty(kind, kind.name, span)), kind.name);
            }
        }
    }

    /// Writes a declaration, after the declarations that it names.
    fn declare(&mut self, record: &Rc<Record>, name: &str) {
        let docs: String = self.docs(record).iter().map(|line| format!("/// {}\n", line.trim())).collect();
        let after = self.after(record);
        let lines = self.fields(record);
        let kind = record.kind.name;
        let header = if name == kind { kind.to_string() } else { format!("{kind} {name}") };
        self.written.push((record.kind, format!("{docs}{header} {{{after}\n{lines}}}\n")));
    }

    /// An object as a value: its name, or the object itself if it has no name.
    fn object(&mut self, record: &Rc<Record>) -> String {
        if let Some((_, name)) = self.named.iter().find(|(known, _)| Rc::ptr_eq(known, record)) {
            return name.clone();
        }
        let declared = self.declaration(record);
        if declared.is_none() && (record.name == record.kind.name || record.kind.role == Role::Nested) {
            let after = self.after(record);
            let lines = self.fields(record);
            return if lines.is_empty() { "{}".into() } else { format!("{{{after}\n{lines}}}") };
        }
        let mine = declared.is_some_and(|id| id.scope == self.eval.main);
        let name = if mine { record.name.clone() } else { self.free_name(record) };
        self.taken.insert(name.clone());
        self.named.push((record.clone(), name.clone()));
        self.declare(record, &name);
        name
    }

    /// The declaration that an object is, unless something in it was replaced on the way.
    fn declaration(&self, record: &Rc<Record>) -> Option<ItemId> {
        let id = *self.headers.get(&record.span)?;
        let same = self.eval.known(id).is_some_and(|known| Rc::ptr_eq(known, record));
        same.then_some(id)
    }

    /// The name of an object from another file; another name if this one has a meaning here.
    fn free_name(&self, record: &Record) -> String {
        let free = |name: &String| !self.taken.contains(name) && !is_word(name);
        let kind = record.kind.name;
        let own = record.name.clone();
        let of_kind = format!("{kind}_{own}");
        let numbered = (2..).map(|n| format!("{of_kind}_{n}"));
        [own, of_kind.clone()].into_iter().chain(numbered).find(free).unwrap_or(of_kind)
    }

    /// The lines of an object's fields, each with its origin.
    fn fields(&mut self, record: &Record) -> String {
        let full = self.eval.complete(record);
        let mut out = String::new();
        for field in record.kind.fields {
            if let Some(slot) = record.get(field.name).or_else(|| full.get(field.name)) {
                let line = self.line(field.name, &field.form, slot);
                out.push_str(&line);
            } else if record.kind.name == "scenario" && field.name == "title" {
                out.push_str(&self.title());
            }
        }
        if record.kind.changes().is_some() {
            self.changes(record, &mut out);
        }
        // the origin of data is given in its own fields
        for field in schema::COMMON {
            if let Some(slot) = record.get(field.name) {
                let value = self.value(&field.form, slot);
                out.push_str(&format!("{} = {value}\n", field.name));
            }
        }
        out
    }

    /// The title; without one the name of the file.
    fn title(&self) -> String {
        let name = &self.eval.files.sources.get(diag::FileId(0)).name;
        let stem = name.rsplit(['/', '\\']).next().unwrap_or(name).trim_end_matches(".track");
        format!("title = {}  // the file's name\n", text::quoted(stem))
    }

    /// The changes of a stretch: whole fields, or parts of fields by their paths.
    fn changes(&mut self, record: &Record, out: &mut String) {
        let fields: &'static [Field] = record.kind.changes().map_or(&[], |kind| kind.fields);
        for field in fields {
            match record.get(field.name).map(|slot| (slot, &slot.value)) {
                Some((_, Val::Record(inner))) if inner.partial => self.paths(field.name, inner, out),
                Some((slot, _)) => {
                    let line = self.line(field.name, &field.form, slot);
                    out.push_str(&line);
                }
                None => self.replaced_parts(record, field, out),
            }
        }
    }

    /// `pad.stiffness = ...` of an object whose other fields are unknown.
    fn paths(&mut self, path: &str, record: &Record, out: &mut String) {
        for field in record.kind.fields {
            let Some(slot) = record.get(field.name) else { continue };
            let path = format!("{path}.{}", field.name);
            match &slot.value {
                Val::Record(inner) if inner.partial => self.paths(&path, inner, out),
                _ => {
                    let line = self.line(&path, &field.form, slot);
                    out.push_str(&line);
                }
            }
        }
    }

    /// `layers.ballast = ...`: a pair of a list in the trackform under the stretch. The last one counts.
    fn replaced_parts(&mut self, record: &Record, field: &'static Field, out: &mut String) {
        let Form::Pairs { value: form, .. } = &field.form else { return };
        let inside = |path: &[syntax::tree::Name]| path.len() == 2 && path[0].text == field.name;
        let changes: Vec<_> = record.changes.iter().filter(|c| inside(&c.field.path.names)).cloned().collect();
        for (i, change) in changes.iter().enumerate() {
            let path = change.field.path.text();
            if changes[i + 1..].iter().all(|later| later.field.path.text() != path) {
                let slot = self.eval.fit(form, &change.field.value, change.scope);
                let line = self.line(&path, form, &slot);
                out.push_str(&line);
            }
        }
    }

    /// `path = value  // origin`
    fn line(&mut self, path: &str, form: &'static Form, slot: &Slot) -> String {
        let value = self.value(form, slot);
        // an object gives the origin of each field
        if value.starts_with('{') {
            return format!("{path} = {value}\n");
        }
        let origin = self.origin(slot.origin);
        format!("{path} = {value}  // {origin}\n")
    }

    fn origin(&self, origin: Origin) -> String {
        literal::origin(origin, |span| self.place(span))
    }

    /// `line 12` of the main file, `std/pads.track:14` of others.
    fn place(&self, span: Span) -> String {
        let sources = &self.eval.files.sources;
        let (name, line) = (&sources.get(span.file).name, sources.position(span.file, span.start).line);
        if span.file == diag::FileId(0) {
            format!("line {line}")
        } else if name == EDIT {
            name.clone()
        } else {
            format!("{name}:{line}")
        }
    }

    /// The base of an object, as a comment behind its bracket.
    fn after(&self, record: &Record) -> String {
        let replaced_in = self.headers.contains_key(&record.span) && {
            let known = self.headers.get(&record.span).and_then(|id| self.eval.known(*id));
            known.is_some_and(|known| !std::ptr::eq(&**known, record))
        };
        let base = if replaced_in { Some(&record.span) } else { record.bases.first() };
        let Some(id) = base.and_then(|span| self.headers.get(span)) else { return String::new() };
        let scope = &self.eval.scopes[id.scope];
        let Item::Declaration(d) = &scope.tree.items[id.item] else { return String::new() };
        let name = &d.name.as_ref().unwrap_or(&d.kind).text;
        let file = &self.eval.files.sources.get(scope.tree.file).name;
        match id.scope == self.eval.main {
            true => format!("  // extends {name}"),
            false => format!("  // extends {}.{name}", file.trim_start_matches("std/").trim_end_matches(".track")),
        }
    }

    /// The `///` lines above the declaration of an object.
    fn docs(&self, record: &Record) -> Vec<String> {
        let Some(id) = self.headers.get(&record.span) else { return Vec::new() };
        match &self.eval.scopes[id.scope].tree.items[id.item] {
            Item::Declaration(d) => d.docs.clone(),
            _ => Vec::new(),
        }
    }
}

/// Whether a field reads a bare name as a word.
fn is_word(name: &str) -> bool {
    let reserved = ["use", "let", "as", "per", "yes", "no", "all", "rest"];
    reserved.contains(&name) || schema::word(name).is_some() || schema::kind(name).is_some()
}
