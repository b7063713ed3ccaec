//! Evaluates the declarations of files, completes the objects of a kind, and finds unused declarations.

use super::evaluator::Evaluator;
use super::records::header;
use super::value::Record;
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::{Code, Diagnostic, FileId, Fix, Span};
use crate::scenario::{Evidence, LibraryEntry};
use crate::schema::{self, Role};
use crate::syntax::tree::{Item, Let, Name, Value, ValueKind};
use std::collections::HashSet;
use std::rc::Rc;

/// Kinds that ask about the scene; objects of modules are evaluated only if the main file names them.
const ASKING: [&str; 2] = ["expect", "study"];

impl Evaluator<'_> {
    /// Evaluates declarations, the main file's last, and returns those that act by themselves. Questions about the
    /// scene are evaluated later.
    pub fn evaluate_all(&mut self) -> Vec<ItemId> {
        let mut roots = Vec::new();
        let mine: Vec<ScopeId> = (0..self.scopes.len()).filter(|s| !self.scopes[*s].library).collect();
        for scope in mine {
            let tree = self.scopes[scope].tree.clone();
            for (item, declaration) in tree.items.iter().enumerate() {
                let Item::Declaration(d) = declaration else { continue };
                let id = ItemId { scope, item };
                let acts = matches!(schema::kind(&d.kind.text).map(|k| k.role), Some(Role::Scene { .. }));
                if acts && scope == self.main {
                    roots.push(id);
                }
                if !ASKING.contains(&d.kind.text.as_str()) {
                    let used = self.used.contains(&id);
                    self.record(id, d.span);
                    if !used && !acts {
                        self.used.remove(&id);
                    }
                }
            }
        }
        roots
    }

    /// Objects of the main file that ask about the scene, in its order.
    pub fn asking(&mut self) -> Vec<Rc<Record>> {
        let tree = self.scopes[self.main].tree.clone();
        let mut found = Vec::new();
        for (item, declaration) in tree.items.iter().enumerate() {
            if let Item::Declaration(d) = declaration
                && ASKING.contains(&d.kind.text.as_str())
            {
                found.extend(self.record(ItemId { scope: self.main, item }, d.span));
            }
        }
        found
    }

    /// The declaration of an object in the main file.
    pub fn item_of(&self, record: &Record) -> Option<ItemId> {
        let items = &self.scopes[self.main].tree.items;
        let item = items.iter().position(|item| matches!(item, Item::Declaration(d) if header(d) == record.span))?;
        Some(ItemId { scope: self.main, item })
    }

    /// Evaluates bindings that nothing uses, because they may have unknown units or depend on each other.
    pub fn idle_lets(&mut self) {
        let (used, mut seen) = (self.used.clone(), HashSet::new());
        for scope in (0..self.scopes.len()).filter(|s| !self.scopes[*s].library).collect::<Vec<_>>() {
            let tree = self.scopes[scope].tree.clone();
            for (item, thing) in tree.items.iter().enumerate() {
                if let Item::Let(binding) = thing
                    && !self.used.contains(&ItemId { scope, item })
                {
                    self.units_in(&binding.value);
                    self.follow(ItemId { scope, item }, binding, binding.name.span, &mut seen);
                }
            }
        }
        // this check does not count as a use
        self.used = used;
    }

    /// Follows a binding to the bindings that it names, each once, to find circles.
    fn follow(&mut self, id: ItemId, binding: &Let, place: Span, seen: &mut HashSet<ItemId>) {
        if !seen.insert(id) && !self.follows(id) {
            return;
        }
        self.within(id, place, |eval| {
            let tree = eval.scopes[id.scope].tree.clone();
            let mut names = Vec::new();
            names_in(&binding.value, &mut names);
            for name in names {
                let Some(&item) = eval.scopes[id.scope].names.get(&name.text) else { continue };
                if let Some(Item::Let(next)) = tree.items.get(item) {
                    eval.follow(ItemId { item, ..id }, next, name.span, seen);
                }
            }
            Some(())
        });
    }

    /// Whether the main file declares an object of a kind.
    pub fn declares(&self, kind: &str) -> bool {
        let items = &self.scopes[self.main].tree.items;
        items.iter().any(|item| matches!(item, Item::Declaration(d) if d.kind.text == kind))
    }

    /// Every object of a kind in the main file, complete.
    pub fn all(&mut self, kind: &str) -> Vec<Record> {
        let tree = self.scopes[self.main].tree.clone();
        let mut found = Vec::new();
        for (item, declaration) in tree.items.iter().enumerate() {
            let Item::Declaration(d) = declaration else { continue };
            if d.kind.text != kind {
                continue;
            }
            if let Some(record) = self.record(ItemId { scope: self.main, item }, d.span) {
                found.push(self.complete(&record));
            }
        }
        found
    }

    /// The only object of a kind in the main file, complete.
    pub fn only(&mut self, kind: &str) -> Option<Record> {
        self.all(kind).into_iter().next()
    }

    /// The default `solve` of a scene without one.
    pub fn default_solve(&mut self) -> Record {
        let Some(kind) = schema::kind("solve") else { unreachable!("the vocabulary has `solve`") };
        let span = Span::new(FileId(0), 0, 0);
        self.complete(&Record::empty(kind, "solve", span))
    }

    /// Entries of the standard library that the scene names or leaves to a default, with their evidence.
    pub fn library_entries(&self) -> Vec<LibraryEntry> {
        let entry = |(id, span): (&ItemId, &Option<Span>)| {
            let record = self.records.get(id)?.as_ref()?;
            let evidence = match record.word("evidence")? {
                "read" => Evidence::Read,
                "derived" => Evidence::Derived,
                _ => Evidence::Unchecked,
            };
            let file = &self.files.sources.get(record.span.file).name;
            let module = file.trim_start_matches("std/").trim_end_matches(".track");
            let source = record.text("source").unwrap_or_default().to_string();
            Some(LibraryEntry { name: format!("{module}.{}", record.name), source, evidence, span: *span })
        };
        self.library_uses.iter().filter_map(entry).collect()
    }

    /// An item of the main file with the `///` lines above it and the line break behind it.
    fn with_docs(&self, item: &Item) -> Span {
        let (span, docs) = (item.span(), item.docs().len());
        let text = &self.files.sources.get(span.file).text;
        let begin = |end: usize| text[..end].rfind('\n').map_or(0, |i| i + 1);
        let line = begin(span.start as usize);
        let alone = text[line..span.start as usize].trim().is_empty();
        let start =
            if alone { (0..docs).fold(line, |line, _| begin(line.saturating_sub(1))) } else { span.start as usize };
        let behind = &text[span.end as usize..];
        let blanks = behind.len() - behind.trim_start_matches([' ', '\t', ',', '\r']).len();
        let end = span.end as usize + if alone && behind[blanks..].starts_with('\n') { blanks + 1 } else { 0 };
        Span::new(span.file, start, end)
    }

    /// Warns of unused declarations of the main file. A declaration that waits for another missing part is not
    /// reported, because the missing part is reported.
    pub fn unused(&mut self, roots: &[ItemId], waiting: &[&str]) {
        let tree = self.scopes[self.main].tree.clone();
        for (item, thing) in tree.items.iter().enumerate() {
            let id = ItemId { scope: self.main, item };
            let (name, span) = match thing {
                Item::Declaration(d) if waiting.contains(&d.kind.text.as_str()) => continue,
                Item::Declaration(d) => match &d.name {
                    Some(name) => (name.text.clone(), name.span),
                    None => (d.kind.text.clone(), d.kind.span),
                },
                Item::Let(l) => (l.name.text.clone(), l.name.span),
                Item::Use(_) => continue,
            };
            let declared = self.scopes[self.main].names.get(&name) == Some(&item);
            if declared
                && !roots.contains(&id)
                && !self.used.contains(&id)
                && !matches!(self.records.get(&id), Some(None))
            {
                self.findings.report(
                    Diagnostic::new(Code::E0412, format!("nothing uses `{name}`"))
                        .label(span, "declared here")
                        .help("take it out, or use it")
                        .fix(Fix::replace(self.with_docs(thing), "").titled(format!("take `{name}` out"))),
                );
            }
        }
    }
}

/// The single names in a value, without dots.
fn names_in<'v>(value: &'v Value, names: &mut Vec<&'v Name>) {
    match &value.kind {
        ValueKind::Path(path) => {
            if let [name] = path.names.as_slice() {
                names.push(name);
            }
        }
        ValueKind::Negate(inner) | ValueKind::Per(inner, _) => names_in(inner, names),
        ValueKind::Binary(left, _, right) | ValueKind::Range(left, right) => {
            names_in(left, names);
            names_in(right, names);
        }
        ValueKind::List { entries, .. } => entries.iter().for_each(|entry| names_in(&entry.value, names)),
        _ => {}
    }
}
