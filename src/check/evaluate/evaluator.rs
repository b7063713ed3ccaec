//! The state of evaluation: the scopes, the values evaluated so far, and the current depth.

use super::number::Raw;
use super::value::Record;
use crate::check::findings::Findings;
use crate::check::text::files::Files;
use crate::check::text::loader::Loaded;
use crate::check::text::scope::{ItemId, Scope, ScopeId};
use crate::diag::{Code, Diagnostic, Span, and_list};
use crate::scenario::Origin;
use crate::schema::Kind;
use crate::syntax::tree::{Item, Name, Value};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// Turns the text of declarations into records, each once.
pub struct Evaluator<'m> {
    pub files: Files<'m>,
    pub findings: Findings,
    pub scopes: Vec<Scope>,
    /// The main file.
    pub main: ScopeId,
    /// The scope of defaults: every module of the standard library is known there.
    pub standard: ScopeId,
    /// Unreadable parts of the text.
    pub(super) unreadable: Vec<Span>,
    /// Signs of other languages in the text; each has been reported.
    pub(super) foreign: Vec<Span>,
    /// Number of names that were compared with unknown names so far, limited by [`COMPARED`].
    pub(super) compared: usize,
    /// Objects evaluated so far.
    pub(super) records: HashMap<ItemId, Option<Rc<Record>>>,
    /// Values of lets that are numbers.
    pub(super) numbers: HashMap<ItemId, Option<Raw>>,
    /// Defaults of the schema, parsed.
    pub(super) defaults: HashMap<&'static str, Rc<Value>>,
    /// Items being evaluated, with the place that needs them.
    stack: Vec<(ItemId, Span)>,
    /// Current depth of values inside values, limited by [`DEEPEST`].
    depth: usize,
    /// Circles of names reported so far.
    circles: BTreeSet<Vec<ItemId>>,
    /// Used items.
    pub(super) used: BTreeSet<ItemId>,
    /// Entries of the standard library that are named outside the library, with the place; a default has no place.
    pub(super) library_uses: BTreeMap<ItemId, Option<Span>>,
    /// Files that name modules of the standard library without bringing it in.
    pub(super) without_library: BTreeSet<ScopeId>,
    /// The field whose value is being read.
    pub(super) asked: Option<(&'static Kind, &'static str)>,
    /// Values of a wrong form; reports on foreign signs inside them are dropped.
    pub(super) superseded: Vec<Span>,
}

/// Largest depth of values inside values: deeper than people write, but safe for any stack.
const DEEPEST: usize = 1_200;
/// Largest number of names that are compared with unknown names to find those that were meant. It takes half a second;
/// thousands of unknown names among thousands of known ones would take minutes.
pub(super) const COMPARED: usize = 1_000_000;
/// Depth that is counted for following a name.
const NAME: usize = 20;

impl<'m> Evaluator<'m> {
    /// Begins with the loaded files; nothing is evaluated yet.
    pub fn new(loaded: Loaded<'m>) -> Evaluator<'m> {
        let Loaded { files, scopes, main, standard, diagnostics } = loaded;
        let lost = |d: &&Diagnostic| matches!(d.code, Code::E0101 | Code::E0104 | Code::E0106);
        let unreadable = diagnostics.iter().filter(lost).filter_map(|d| Some(d.labels.first()?.span)).collect();
        let of_other_languages = diagnostics.iter().filter(|d| d.code == Code::E0105);
        let foreign = of_other_languages.filter_map(|d| Some(d.labels.first()?.span)).collect();
        Evaluator {
            files,
            findings: Findings::new(diagnostics),
            scopes,
            main,
            standard,
            unreadable,
            foreign,
            compared: 0,
            records: HashMap::new(),
            numbers: HashMap::new(),
            defaults: HashMap::new(),
            stack: Vec::new(),
            depth: 0,
            circles: BTreeSet::new(),
            used: BTreeSet::new(),
            library_uses: BTreeMap::new(),
            without_library: BTreeSet::new(),
            asked: None,
            superseded: Vec::new(),
        }
    }

    /// Drops reports on foreign signs in values that have a wrong form as a whole.
    pub fn drop_superseded(&mut self) {
        let within = |d: &Diagnostic, outer: &Span| {
            d.labels
                .first()
                .is_some_and(|l| l.span.file == outer.file && l.span.start >= outer.start && l.span.start < outer.end)
        };
        let superseded = &self.superseded;
        self.findings.diagnostics.retain(|d| d.code != Code::E0105 || !superseded.iter().any(|span| within(d, span)));
    }

    /// Goes one level deeper, unless this is too deep for the machine.
    pub fn deeper<T>(&mut self, steps: usize, span: Span, f: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.depth + steps > DEEPEST {
            self.findings.report(
                Diagnostic::new(Code::E0103, "values refer to other values in a chain that is too long")
                    .label(span, "the chain is too long here")
                    .help("write the value itself"),
            );
            return None;
        }
        self.depth += steps;
        let result = f(self);
        self.depth -= steps;
        result
    }

    /// Runs `f` inside an item, so that a circle of names is found and uses are noted. Mistakes found inside a `let`
    /// get the place of use as their second label.
    pub fn within<T>(&mut self, id: ItemId, place: Span, f: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        self.used.insert(id);
        if let Some(start) = self.stack.iter().position(|(item, _)| *item == id) {
            // a circle is reported once, from any of its names
            let mut members: Vec<ItemId> = self.stack[start..].iter().map(|(item, _)| *item).collect();
            members.sort_unstable();
            if !self.circles.insert(members) {
                return None;
            }
            let names: Vec<String> =
                self.stack[start..].iter().map(|(item, _)| *item).chain([id]).map(|i| self.item_name(i)).collect();
            let mut mistake = Diagnostic::new(
                Code::E0203,
                format!("{} depend on each other", quoted_list(&names[..names.len() - 1])),
            )
            .label(place, "closes the circle")
            .help(format!("the circle is {}", names.join(" -> ")));
            if names.len() == 2 {
                mistake.message = format!("`{}` depends on itself", names[0]);
            }
            self.findings.report(mistake);
            return None;
        }
        self.stack.push((id, place));
        let before = self.findings.diagnostics.len();
        let result = self.deeper(NAME, place, f);
        self.stack.pop();
        if matches!(self.scopes[id.scope].tree.items[id.item], Item::Let(_)) {
            for diagnostic in &mut self.findings.diagnostics[before..] {
                if diagnostic.labels.iter().all(|l| l.span != place) {
                    diagnostic.labels.push(crate::diag::Label { span: place, text: "used here".into() });
                }
            }
        }
        result
    }

    fn item_name(&self, id: ItemId) -> String {
        match &self.scopes[id.scope].tree.items[id.item] {
            Item::Let(l) => l.name.text.clone(),
            Item::Declaration(d) => d.name.as_ref().unwrap_or(&d.kind).text.clone(),
            Item::Use(u) => u.path.text(),
        }
    }

    /// The object of a declaration, if it has been evaluated and understood.
    pub fn known(&self, id: ItemId) -> Option<&Rc<Record>> {
        self.records.get(&id)?.as_ref()
    }

    /// Every object that has been understood so far.
    pub fn known_objects(&self) -> Vec<(ItemId, Rc<Record>)> {
        let mut known: Vec<_> = self.records.iter().filter_map(|(id, record)| Some((*id, record.clone()?))).collect();
        known.sort_by_key(|(id, _)| *id);
        known
    }

    /// Whether an item is being evaluated.
    pub(super) fn follows(&self, id: ItemId) -> bool {
        self.stack.iter().any(|(item, _)| *item == id)
    }

    /// Whether something inside a span could not be read as text.
    pub fn unread(&self, span: Span) -> bool {
        self.unreadable.iter().any(|s| s.file == span.file && s.start >= span.start && s.end <= span.end)
    }

    /// Whether a name may have been declared in an unreadable part of the text.
    pub fn unread_word(&self, name: &Name) -> bool {
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        self.unreadable.iter().any(|s| {
            s.file == name.span.file && self.files.sources.text(*s).split(|c| !word(c)).any(|w| w == name.text)
        })
    }

    /// The origin of a value in a scope.
    pub fn origin(&self, span: Span, scope: ScopeId) -> Origin {
        if scope == self.standard {
            Origin::Default
        } else if self.scopes[scope].library {
            Origin::Library(span)
        } else {
            Origin::Written(span)
        }
    }
}

/// `a`, `b` and `c`
fn quoted_list(names: &[String]) -> String {
    and_list(&names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>())
}
