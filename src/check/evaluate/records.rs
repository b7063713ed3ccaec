//! Objects: declarations and their bases. `=` replaces a whole value, a path replaces inside a value; nothing merges.

use super::evaluator::Evaluator;
use super::value::{Change, Record, Slot, Val};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::scenario::Origin;
use crate::schema::{self, Form, Kind, PLANNED_KINDS};
use crate::syntax::tree::{Declaration, Field, Item, Name, Path, ValueKind};
use std::rc::Rc;

impl Evaluator<'_> {
    /// The object of a declaration, evaluated once.
    pub fn record(&mut self, id: ItemId, place: Span) -> Option<Rc<Record>> {
        if let Some(done) = self.records.get(&id).filter(|_| !self.follows(id)) {
            self.used.insert(id);
            return done.clone();
        }
        let circles = self.follows(id);
        let tree = self.scopes[id.scope].tree.clone();
        let Item::Declaration(declaration) = &tree.items[id.item] else { return None };
        let record = self.within(id, place, |c| c.declaration(declaration, id.scope)).map(Rc::new);
        if !circles {
            self.records.insert(id, record.clone());
        }
        record
    }

    fn declaration(&mut self, declaration: &Declaration, scope: ScopeId) -> Option<Record> {
        let kind = self.kind_of(&declaration.kind)?;
        let header = header(declaration);
        let name = declaration.name.as_ref().unwrap_or(&declaration.kind).text.clone();
        let mut record = self.extended(declaration.base.as_ref(), kind, &name, header, scope);
        record.partial |= self.unread(declaration.span);
        self.apply(&mut record, &declaration.fields, scope);
        Some(record)
    }

    fn kind_of(&mut self, name: &Name) -> Option<&'static Kind> {
        let stands = |k: &&Kind| k.role != schema::Role::Nested;
        let found = schema::kind(&name.text).filter(stands);
        if found.is_some() {
            return found;
        }
        if PLANNED_KINDS.contains(&name.text.as_str()) {
            self.findings.report(
                Diagnostic::new(Code::E0411, format!("this version does not read `{}` yet", name.text))
                    .label(name.span, "planned"),
            );
            return None;
        }
        // `const x = 1`: the sign has been reported, with help
        let text = self.files.sources.get(name.span.file).text.as_bytes();
        let between = |s: &Span| text.get(name.span.end as usize..s.end as usize);
        let on_line = |s: &Span| s.file == name.span.file && between(s).is_some_and(|text| !text.contains(&b'\n'));
        if self.foreign.iter().any(on_line) {
            return None;
        }
        // a misspelt kind is read as the kind that was probably meant
        let near = schema::meant_kind(&name.text);
        let help = near.map_or_else(|| Help::say("`trackbed docs` lists the kinds"), |k| Help::meant(k.name));
        self.findings.report(
            Diagnostic::new(Code::E0401, format!("unknown kind `{}`", name.text))
                .label(name.span, "not a kind")
                .advise(name.span, help),
        );
        near
    }

    /// The object of the same kind that `: base` or an object's path names.
    fn base(&mut self, path: &Path, kind: &'static Kind, scope: ScopeId) -> Option<Rc<Record>> {
        let target = self.resolve(path, scope, &[])?;
        let found = if target.is_let { None } else { Some(self.slot_at(&target, path)?) };
        match found.map(|slot| slot.value) {
            Some(Val::Record(record)) if record.kind.name == kind.name => Some(record),
            Some(Val::Error | Val::Hole) => None,
            Some(Val::Record(record)) => {
                self.findings.report(
                    Diagnostic::new(
                        Code::E0205,
                        format!("a {} cannot extend `{}`, which is a {}", kind.name, path.text(), record.kind.name),
                    )
                    .label(path.span, format!("expected a {}, found a {}", kind.name, record.kind.name))
                    .label(record.span, "declared here"),
                );
                None
            }
            _ => {
                self.findings.report(
                    Diagnostic::new(Code::E0205, format!("a {} cannot extend `{}`", kind.name, path.text()))
                        .label(path.span, "not an object"),
                );
                None
            }
        }
    }

    /// An object before its own fields: empty, or with the fields of its base.
    fn extended(&mut self, base: Option<&Path>, kind: &'static Kind, name: &str, span: Span, scope: ScopeId) -> Record {
        let empty = Record::empty(kind, name, span);
        let Some(path) = base else { return empty };
        match self.base(path, kind, scope) {
            Some(base) => {
                let bases = std::iter::once(base.span).chain(base.bases.iter().copied()).collect();
                let (fields, changes) = (base.fields.clone(), base.changes.clone());
                Record { bases, fields, partial: base.partial, changes, ..empty }
            }
            None => Record { partial: true, ..empty },
        }
    }

    /// An object written in place.
    pub fn object(
        &mut self,
        base: Option<&Path>,
        fields: &[Field],
        kind: &'static Kind,
        span: Span,
        scope: ScopeId,
    ) -> Record {
        let name = base.and_then(|p| p.names.last()).map_or(kind.name, |n| n.text.as_str());
        let mut record = self.extended(base, kind, name, span, scope);
        record.partial |= self.unread(span);
        self.apply(&mut record, fields, scope);
        record
    }

    /// Puts the fields of a block into a record.
    fn apply(&mut self, record: &mut Record, fields: &[Field], scope: ScopeId) {
        self.duplicates(fields);
        self.drop_rivals(record, fields);
        for field in fields {
            if record.kind.changed_field(&field.path.names[0].text).is_some() {
                record.changes.push(Change { field: field.clone(), scope });
            }
            self.put(record, &field.path.names, field, scope);
        }
    }

    /// Puts one field into a record, as a block of its own would.
    pub fn change(&mut self, record: &mut Record, change: &Change) {
        self.drop_rivals(record, std::slice::from_ref(&change.field));
        self.put(record, &change.field.path.names, &change.field, change.scope);
    }

    /// Reports a path that is given twice in one block, or a path and a longer path inside it.
    fn duplicates(&mut self, fields: &[Field]) {
        for (i, later) in fields.iter().enumerate() {
            let names = |f: &Field| f.path.names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
            let later_names = names(later);
            let clash = fields[..i].iter().find(|f| {
                let names = names(f);
                names.starts_with(&later_names) || later_names.starts_with(&names)
            });
            if let Some(first) = clash {
                let message = if first.path.text() == later.path.text() {
                    format!("`{}` is given twice", later.path.text())
                } else {
                    format!("`{}` and `{}` overlap", first.path.text(), later.path.text())
                };
                self.findings.report(
                    Diagnostic::new(Code::E0404, message)
                        .label(later.path.span, "again here")
                        .label(first.path.span, "first given here")
                        .help("keep one of the two"),
                );
            }
        }
    }

    /// A field drops inherited fields that give the same quantity in another way.
    fn drop_rivals(&self, record: &mut Record, fields: &[Field]) {
        let sets = |path: &str| fields.iter().any(|f| !is_none(f) && sets_path(f, path));
        for alternative in record.kind.alternatives {
            let given: Vec<bool> = alternative.ways.iter().map(|way| way.iter().any(|p| sets(p))).collect();
            if !given.contains(&true) {
                continue;
            }
            for (way, _) in alternative.ways.iter().zip(&given).filter(|(_, given)| !**given) {
                for path in way.iter() {
                    remove(record, path);
                }
            }
        }
    }

    /// An unknown field may be a misspelt known field: the known field is then not reported as missing.
    fn excuse(&self, record: &mut Record, name: &Name, field: &Field) {
        // the other fields of a stretch are unknown
        record.partial |= record.kind.plans(&name.text) || record.kind.changes().is_some();
        if record.kind.plans(&name.text) {
            return;
        }
        if let Some(near) = record.kind.meant(&name.text)
            && let Some(known) = record.kind.field(near)
        {
            let origin = Origin::Written(field.span);
            record.fields.entry(known.name).or_insert(Slot { value: Val::Error, span: field.span, origin });
        }
    }

    /// Follows a path into a record and replaces the value there.
    fn put(&mut self, record: &mut Record, path: &[Name], field: &Field, scope: ScopeId) {
        let name = &path[0];
        // a line that could not be read may not begin with a name of a field at all
        if matches!(field.value.kind, ValueKind::Error) && record.kind.field(&name.text).is_none() {
            self.excuse(record, name, field);
            return;
        }
        let Some(known) = self.field_of(record.kind, name) else {
            self.excuse(record, name, field);
            return;
        };
        let [_, rest @ ..] = path else { return };
        if rest.is_empty() {
            let around = self.asked.replace((record.kind, known.name));
            let slot = self.fit(&known.form, &field.value, scope);
            self.asked = around;
            record.fields.insert(known.name, slot);
            return;
        }
        if let Some(kind) = object_kind(&known.form) {
            let inner = match record.fields.get(known.name).map(|s| &s.value) {
                Some(Val::Record(inner)) => (**inner).clone(),
                Some(Val::Error | Val::Hole) => return,
                _ => Record {
                    partial: record.partial || record.kind.changes().is_some(),
                    ..Record::empty(kind, kind.name, field.path.span)
                },
            };
            let mut inner = inner;
            let tail = Field { path: Path { names: rest.to_vec(), span: field.path.span }, ..field.clone() };
            self.drop_rivals(&mut inner, std::slice::from_ref(&tail));
            self.put(&mut inner, rest, field, scope);
            let origin = Origin::Written(field.span);
            record.fields.insert(known.name, Slot { value: Val::Record(Rc::new(inner)), span: field.span, origin });
            return;
        }
        self.put_inside(record, known, rest, field, scope);
    }

    /// A named argument of a word, or a pair by the last name of its key.
    fn put_inside(
        &mut self,
        record: &mut Record,
        known: &'static schema::Field,
        rest: &[Name],
        field: &Field,
        scope: ScopeId,
    ) {
        let name = &rest[0];
        match record.fields.get_mut(known.name).map(|s| &mut s.value) {
            Some(Val::Word { word, arguments }) if rest.len() == 1 => {
                if let Some(argument) = word.arguments.iter().find(|a| a.name == name.text) {
                    let slot = self.fit(&argument.form, &field.value, scope);
                    arguments.insert(argument.name, slot);
                    return;
                }
            }
            Some(Val::Pairs(pairs)) if rest.len() == 1 => {
                if let Form::Pairs { value, .. } = &known.form {
                    let found =
                        pairs.iter_mut().find(|(key, _)| matches!(&key.value, Val::Record(r) if r.name == name.text));
                    if let Some((_, slot)) = found {
                        *slot = self.fit(value, &field.value, scope);
                        return;
                    }
                }
            }
            Some(Val::Error | Val::Hole) => return,
            // its basis is not known here
            _ if record.partial || record.kind.changes().is_some() => return,
            _ => {}
        }
        self.findings.report(
            Diagnostic::new(Code::E0402, format!("there is no `{}` inside `{}` to replace", name.text, known.name))
                .label(name.span, "not found")
                .help(format!("give the whole value: `{} = ...`", known.name)),
        );
    }

    /// The field of that name; a diagnostic if the kind has none.
    pub fn field_of(&mut self, kind: &'static Kind, name: &Name) -> Option<&'static schema::Field> {
        if let Some(field) = kind.field(&name.text) {
            return Some(field);
        }
        if kind.plans(&name.text) {
            self.findings.report(
                Diagnostic::new(
                    Code::E0411,
                    format!("this version does not read `{}` of `{}` yet", name.text, kind.name),
                )
                .label(name.span, "planned"),
            );
            return None;
        }
        let argument = || {
            let (field, word) = kind.argument(&name.text)?;
            // a law has one form, given by its base
            Some(match kind.name {
                "law" => Help::write(format!("{}.{}", field.name, name.text)).after("it is an argument of its form: "),
                _ => {
                    let written = format!("`{} = {}({} = ...)`", field.name, word.name, name.text);
                    Help::say(format!("it is an argument of `{}`: {written}", word.name))
                }
            })
        };
        let near = || kind.meant(&name.text).map(Help::meant);
        let docs = || Help::say(format!("`trackbed docs {}` lists its fields", kind.name));
        let help = argument().or_else(near).unwrap_or_else(docs);
        self.findings.report(
            Diagnostic::new(Code::E0402, format!("`{}` has no field `{}`", kind.name, name.text))
                .label(name.span, "unknown field")
                .advise(name.span, help),
        );
        None
    }
}

/// The place that identifies a declaration.
pub fn header(declaration: &Declaration) -> Span {
    declaration.name.as_ref().map_or(declaration.kind.span, |name| declaration.kind.span.to(name.span))
}

/// The kind of object that a field holds.
pub fn object_kind(form: &Form) -> Option<&'static Kind> {
    match form {
        Form::Object(kind) => schema::kind(kind),
        Form::OneOf(forms) => forms.iter().find_map(object_kind),
        _ => None,
    }
}

/// Whether a field is `none`; such a field drops no other field.
fn is_none(field: &Field) -> bool {
    matches!(&field.value.kind, ValueKind::Path(path) if path.names.len() == 1 && path.names[0].text == "none")
}

/// Whether a field sets `path`: itself, or inside the object that it gives.
fn sets_path(field: &Field, path: &str) -> bool {
    let own = field.path.text();
    if own == path {
        return true;
    }
    match (path.strip_prefix(&format!("{own}.")), &field.value.kind) {
        (Some(rest), ValueKind::Object { fields, .. }) => fields.iter().any(|f| sets_path(f, rest)),
        _ => false,
    }
}

/// Removes the slot at a path. If a mass is removed, its pitch inertia is kept as a radius of gyration, so that the
/// inertia scales with the new mass.
fn remove(record: &mut Record, path: &str) {
    let Some((first, rest)) = path.split_once('.') else {
        if path == "mass" && record.kind.name == "car_body" {
            keep_radius_of_gyration(record);
        }
        record.fields.remove(path);
        return;
    };
    if let Some(Slot { value: Val::Record(inner), .. }) = record.fields.get_mut(first) {
        remove(Rc::make_mut(inner), rest);
    }
}

fn keep_radius_of_gyration(body: &mut Record) {
    let (Some(mass), Some(inertia)) = (body.number("mass"), body.number("pitch_inertia")) else { return };
    let radius = (inertia.of_rail() / mass.of_rail()).sqrt();
    let dimension = crate::units::Dimension::LENGTH;
    if let Some(slot) = body.fields.remove("pitch_inertia") {
        let value = Val::Number(super::number::Number { value: radius, dimension, basis: None, factor: 1.0 });
        body.fields.insert("radius_of_gyration", Slot { value, span: slot.span, origin: Origin::Derived });
    }
}
