//! The meaning of each word of a file: a kind, a field, a name with its item, a unit. Hover, definitions, references
//! and colours use this list.

use super::forms::{argument, follow, has, item_form, object_kind, pair_forms, word_of};
use super::names::kind_of;
use crate::check::{Files, ItemId, ScopeId};
use crate::diag::{Code, Span};
use crate::scenario::response::Response;
use crate::schema::{self, Field, Form, Kind, Role, Word};
use crate::syntax::tree::{self, Argument, Declaration, Entry, Item, Name, Path, UnitText, Value, ValueKind};

/// A word of the text and its meaning.
#[derive(Debug, Clone)]
pub struct Mark {
    pub span: Span,
    pub what: What,
}

/// The meaning of a word of a text.
#[derive(Debug, Clone)]
pub enum What {
    /// The kind of a declaration.
    Kind(&'static Kind),
    /// The name of an item in its declaration.
    Declared(ItemId),
    /// A name that refers to an item.
    Reference(ItemId),
    Module(ScopeId),
    /// A field, and its place if it has a path in an item.
    Field(&'static Kind, &'static Field, Option<Place>),
    Argument(&'static Word, &'static Field),
    Word(&'static Word),
    /// A word with arguments that belongs to no field: `max`, `ramp`.
    Function,
    Response(Response),
    Rule(Code),
    /// A name of a transition, and whether it is defined here.
    Transition(bool),
    Number(Option<&'static Field>),
    Unit,
    Basis,
    Text,
    Hole,
}

/// A field of an item, by its path.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    pub id: ItemId,
    pub path: Vec<&'static str>,
}

/// The words of one file, in the order of the text.
#[derive(Debug, Default)]
pub struct Marks(pub Vec<Mark>);

impl Marks {
    /// Reads the words of one of the files.
    pub fn new(files: &Files, scope: ScopeId) -> Marks {
        let mut reader = Reader { files, scope, marks: Vec::new() };
        for (item, thing) in files.scopes[scope].tree.items.iter().enumerate() {
            reader.item(ItemId { scope, item }, thing);
        }
        reader.marks.sort_by_key(|mark| (mark.span.start, mark.span.end));
        Marks(reader.marks)
    }

    /// The word at an offset, or the word that ends there.
    pub fn find(&self, offset: usize) -> Option<&Mark> {
        let touches = |mark: &&Mark| mark.span.start as usize <= offset && offset <= mark.span.end as usize;
        let until = self.0.partition_point(|mark| mark.span.start as usize <= offset);
        let from = until.saturating_sub(4);
        let near = &self.0[from..until];
        // of two adjacent words, the word that begins here
        near.iter().rev().find(touches)
    }
}

/// The form and the field of a value, from its surroundings.
#[derive(Clone, Copy, Default)]
struct Asked {
    form: Option<&'static Form>,
    field: Option<&'static Field>,
}

impl Asked {
    fn with(self, form: Option<&'static Form>) -> Asked {
        Asked { form, ..self }
    }
}

struct Reader<'f> {
    files: &'f Files,
    scope: ScopeId,
    marks: Vec<Mark>,
}

impl Reader<'_> {
    fn mark(&mut self, span: Span, what: What) {
        self.marks.push(Mark { span, what });
    }

    fn item(&mut self, id: ItemId, item: &Item) {
        match item {
            Item::Use(used) => {
                let name = used.alias.as_ref().or(used.path.names.last());
                let module = name.and_then(|name| self.files.scopes[self.scope].modules.get(&name.text)).copied();
                if let Some(module) = module {
                    self.mark(used.path.span, What::Module(module));
                    used.alias.iter().for_each(|alias| self.mark(alias.span, What::Module(module)));
                }
            }
            Item::Let(binding) => {
                self.mark(binding.name.span, What::Declared(id));
                self.value(&binding.value, Asked::default());
            }
            Item::Declaration(declaration) => self.declaration(id, declaration),
        }
    }

    fn declaration(&mut self, id: ItemId, declaration: &Declaration) {
        let kind = kind_of(declaration);
        let stands = kind.filter(|kind| kind.role != Role::Nested);
        stands.iter().for_each(|kind| self.mark(declaration.kind.span, What::Kind(kind)));
        declaration.name.iter().for_each(|name| self.mark(name.span, What::Declared(id)));
        declaration.base.iter().for_each(|base| self.reference(base));
        let place = Place { id, path: Vec::new() };
        self.fields(&declaration.fields, kind, Some(&place));
    }

    fn fields(&mut self, fields: &[tree::Field], kind: Option<&'static Kind>, place: Option<&Place>) {
        for field in fields {
            let (known, place) = self.path(&field.path, kind, place);
            let form = known.map(|known| &known.form);
            match &field.value.kind {
                ValueKind::Object { base, fields } => {
                    base.iter().for_each(|base| self.reference(base));
                    self.fields(fields, form.and_then(object_kind), place.as_ref());
                }
                _ => self.value(&field.value, Asked { form, field: known }),
            }
        }
    }

    /// Marks the names of a path on the left of `=`; returns the field of the path and its place.
    fn path(
        &mut self,
        path: &Path,
        kind: Option<&'static Kind>,
        place: Option<&Place>,
    ) -> (Option<&'static Field>, Option<Place>) {
        let (mut kind, mut place, mut last) = (kind, place.cloned(), None::<&'static Field>);
        for name in &path.names {
            if let Some((here, field)) = kind.and_then(|kind| Some((kind, kind.field(&name.text)?))) {
                if let Some(place) = &mut place {
                    place.path.push(field.name);
                }
                self.mark(name.span, What::Field(here, field, place.clone()));
                (kind, last) = (object_kind(&field.form), Some(field));
                continue;
            }
            let inside = last.filter(|_| kind.is_none());
            (kind, place) = (None, None);
            last = inside.and_then(|outer| self.inside(outer, name));
        }
        (last, place)
    }

    /// `form.gamma`: an argument of a word; `sections.open`: a pair by the last name of its key.
    fn inside(&mut self, outer: &'static Field, name: &Name) -> Option<&'static Field> {
        if let Some((word, field)) = argument(&outer.form, &name.text) {
            self.mark(name.span, What::Argument(word, field));
            return Some(field);
        }
        if let Some((Form::Name, _)) = pair_forms(&outer.form) {
            self.mark(name.span, What::Transition(false));
        } else if let Some(id) = self.files.named(self.scope, &name.text) {
            self.mark(name.span, What::Reference(id));
        }
        None
    }

    /// Marks a path in a value: a module, a name, fields inside it.
    fn reference(&mut self, path: &Path) {
        let Some(target) = self.files.target(path, self.scope) else {
            let module = self.files.scopes[self.scope].modules.get(&path.names[0].text).copied();
            module.iter().for_each(|module| self.mark(path.names[0].span, What::Module(*module)));
            return;
        };
        if target.taken == 2
            && let Some(module) = self.files.scopes[self.scope].modules.get(&path.names[0].text)
        {
            self.mark(path.names[0].span, What::Module(*module));
        }
        self.mark(path.names[target.taken - 1].span, What::Reference(target.id));
        let rest =
            Path { names: path.names[target.taken..].to_vec(), span: path.names[target.taken - 1].span.to(path.span) };
        let place = Place { id: target.id, path: Vec::new() };
        self.path(&rest, self.files.kind(target.id), Some(&place));
    }

    fn value(&mut self, value: &Value, asked: Asked) {
        match &value.kind {
            ValueKind::Number { unit, .. } => self.number(value.span, unit.as_ref(), asked.field),
            ValueKind::Text(_) => self.mark(value.span, What::Text),
            ValueKind::Hole => self.mark(value.span, What::Hole),
            ValueKind::List { entries, unit } => {
                entries.iter().for_each(|entry| self.entry(entry, asked));
                unit.iter().for_each(|unit| self.mark(unit.span, What::Unit));
            }
            ValueKind::Call { word, arguments } => self.call(word, arguments, asked),
            ValueKind::Object { base, fields } => {
                base.iter().for_each(|base| self.reference(base));
                self.fields(fields, asked.form.and_then(object_kind), None);
            }
            ValueKind::Path(path) => self.name(path, asked),
            ValueKind::Range(a, b) | ValueKind::Binary(a, _, b) => [a, b].iter().for_each(|v| self.value(v, asked)),
            ValueKind::Per(inner, basis) => {
                self.value(inner, asked);
                self.mark(basis.span, What::Basis);
            }
            ValueKind::Negate(inner) => self.value(inner, asked),
            ValueKind::Compare { operands, .. } => operands.iter().for_each(|operand| self.value(operand, asked)),
            ValueKind::Error => {}
        }
    }

    fn number(&mut self, span: Span, unit: Option<&UnitText>, field: Option<&'static Field>) {
        let end = unit.map_or(span.end, |unit| unit.span.start.min(span.end));
        self.mark(Span { end, ..span }, What::Number(field));
        unit.iter().for_each(|unit| self.mark(unit.span, What::Unit));
    }

    fn entry(&mut self, entry: &Entry, asked: Asked) {
        let Some(key) = &entry.key else {
            let form = asked.form.map(item_form);
            let form =
                form.and_then(|form| pair_forms(form).filter(|_| !has(form, is_number)).map(|(k, _)| k)).or(form);
            return self.value(&entry.value, asked.with(form));
        };
        if asked.form.is_some_and(|form| matches!(form, Form::Axes | Form::Settings)) {
            let field = self.scene_path(key);
            return self.value(&entry.value, Asked { form: field.map(|field| &field.form), field });
        }
        let forms = asked.form.and_then(pair_forms);
        let key_form = forms.map(|(key, _)| key);
        match (&key.kind, key_form) {
            (ValueKind::Path(path), Some(Form::Name)) => self.mark(path.span, What::Transition(true)),
            _ => self.value(key, asked.with(key_form)),
        }
        self.value(&entry.value, asked.with(forms.map(|(_, value)| value)));
    }

    /// A path of the scene that a study edits.
    fn scene_path(&mut self, key: &Value) -> Option<&'static Field> {
        let ValueKind::Path(path) = &key.kind else { return None };
        self.reference(path);
        let target = self.files.target(path, self.scope);
        let (kind, taken) = match target {
            Some(target) => (self.files.kind(target.id)?, target.taken),
            // `solve` exists even if it is not declared
            None => (schema::kind(&path.names[0].text)?, 1),
        };
        let rest: Vec<&str> = path.names[taken..].iter().map(|name| name.text.as_str()).collect();
        Some(follow(kind, &rest)?.1)
    }

    fn call(&mut self, word: &Name, arguments: &[Argument], asked: Asked) {
        let known = word_of(asked.form, &word.text);
        self.mark(word.span, known.map_or(What::Function, What::Word));
        for (place, argument) in arguments.iter().enumerate() {
            let field = known.and_then(|word| match &argument.name {
                Some(name) => word.arguments.iter().find(|a| a.name == name.text),
                None => word.arguments.get(place),
            });
            if let (Some(name), Some(word), Some(field)) = (&argument.name, known, field) {
                self.mark(name.span, What::Argument(word, field));
            }
            // the mean of a random value has the form of the field itself
            let inner = field.map(|field| Asked { form: Some(&field.form), field: Some(field) });
            let mean = argument.name.is_none() && word.text == "random";
            self.value(&argument.value, inner.filter(|_| !mean).unwrap_or(asked));
        }
    }

    /// A bare name is a word of the field; otherwise a response, a rule or a transition if the field takes these;
    /// otherwise a name.
    fn name(&mut self, path: &Path, asked: Asked) {
        if let [name] = path.names.as_slice() {
            let reads = |wanted: fn(&Form) -> bool| asked.form.is_some_and(|form| has(form, wanted));
            if let Some(word) = asked.form.and_then(|form| form.word(&name.text)) {
                return self.mark(name.span, What::Word(word));
            }
            if reads(is_asking)
                && let Some(response) = Response::of_name(&name.text)
            {
                return self.mark(name.span, What::Response(response));
            }
            if let Some(rule) = Code::of_rule(&name.text).filter(|_| reads(|form| matches!(form, Form::Rule))) {
                return self.mark(name.span, What::Rule(rule));
            }
            if reads(|form| matches!(form, Form::Name)) {
                return self.mark(name.span, What::Transition(false));
            }
        }
        self.reference(path);
    }
}

fn is_number(form: &Form) -> bool {
    matches!(form, Form::Number(_))
}

/// Whether a form takes responses.
pub fn is_asking(form: &Form) -> bool {
    matches!(form, Form::Response | Form::Comparison | Form::Expression)
}
