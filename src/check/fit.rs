//! Holds a value against the form of its field.

use super::Checker;
use super::arithmetic::{Raw, shape};
use super::modules::ScopeId;
use super::value::{Number, Slot, Val};
use crate::diag::{Code, Diagnostic, Span, nearest::nearest, or_list};
use crate::scenario::Origin;
use crate::scenario::response::Response;
use crate::schema::{self, Form, Measure, Word};
use crate::syntax::tree::{Argument, Entry, Item, Name, UnitText, Value, ValueKind};
use crate::units::{Dimension, Quantity, number, parse_unit};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Words of profiles along the track, which this version does not read.
const PROFILES: [&str; 4] = ["ramp", "smooth", "random", "file"];

/// What kind of thing a value turns out to be, behind names.
#[derive(PartialEq)]
enum Shape {
    Number,
    Object,
    Other,
}

impl Checker<'_> {
    /// The value of a field; [`Val::Error`] where a diagnostic has been given.
    pub fn fit(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Slot {
        let span = value.span;
        let origin = self.origin(span, scope);
        if let ValueKind::Error = value.kind {
            return Slot { value: Val::Error, span, origin };
        }
        if let ValueKind::Hole = value.kind {
            self.report(
                Diagnostic::new(Code::E0410, format!("`?` stands for {}{}", form.describe(), range_of(form)))
                    .at(span, "to be given before a run")
                    .help("write a value here, or give one with `--set`"),
            );
            return Slot { value: Val::Hole, span, origin };
        }
        if let Some(slot) = self.through_name(form, value, scope) {
            return slot;
        }
        let fitted = self.fit_form(form, value, scope).unwrap_or(Val::Error);
        Slot { value: fitted, span, origin }
    }

    fn origin(&self, span: Span, scope: ScopeId) -> Origin {
        if scope == self.standard {
            Origin::Default
        } else if self.scopes[scope].library {
            Origin::Library(span)
        } else {
            Origin::Written(span)
        }
    }

    /// A value that is a name: a word, a `let`, or something in a declaration. `None` for everything else, and for
    /// numbers, which arithmetic follows by itself.
    fn through_name(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Slot> {
        let ValueKind::Path(path) = &value.kind else { return None };
        let error = Slot { value: Val::Error, span: value.span, origin: Origin::Written(value.span) };
        if reads_names(form) {
            return None;
        }
        let bound = |c: &Self, name: &Name| match c.scopes[scope].names.get(&name.text) {
            Some(item) => matches!(c.scopes[scope].tree.items.get(*item), Some(Item::Let(_))),
            None => false,
        };
        let words = form.words();
        if let [name] = path.names.as_slice()
            && let Some(word) = words.iter().find(|w| w.name == name.text)
        {
            return Some(match self.word(word, &[], name, scope) {
                Some(value) => {
                    let value =
                        if let Form::List(_) = form { Val::List(vec![Slot { value, ..error.clone() }]) } else { value };
                    Slot { value, span: path.span, origin: self.origin(path.span, scope) }
                }
                None => error,
            });
        }
        if matches!(form, Form::Words(_)) && !bound(self, &path.names[0]) {
            self.unknown_word(&path.names[0], &words);
            return Some(error);
        }
        let names: Vec<&str> = words.iter().filter(|w| !w.planned).map(|w| w.name).collect();
        let Some(target) = self.resolve(path, scope, &names) else { return Some(error) };
        if target.is_let {
            let tree = self.scopes[target.id.scope].tree.clone();
            let Item::Let(binding) = &tree.items[target.id.item] else { return Some(error) };
            let slot = self.within(target.id, path.span, |c| Some(c.fit(form, &binding.value, target.id.scope)));
            return Some(slot.unwrap_or(error));
        }
        if let Form::List(_) | Form::Pairs { .. } = form {
            return None;
        }
        let slot = self.slot_at(&target, path);
        let Some(slot) = slot else { return Some(error) };
        match &slot.value {
            Val::Number(_) if form_has_numbers(form) => None,
            Val::Record(record) if form_has_object(form, record.kind.name) => {
                Some(Slot { value: slot.value, span: path.span, origin: self.origin(path.span, scope) })
            }
            Val::Error | Val::Hole => Some(Slot { value: Val::Error, ..slot }),
            Val::Record(record) => {
                let found = record.kind.name;
                self.report(
                    Diagnostic::new(Code::E0406, format!("expected {}, found a {found}", form.describe()))
                        .at(path.span, format!("a {found}")),
                );
                Some(error)
            }
            Val::Text(_) if matches!(form, Form::Text) => Some(slot),
            Val::Word { word, .. } if words.iter().any(|w| w.name == word.name) => Some(slot),
            _ => {
                self.report(
                    Diagnostic::new(Code::E0406, format!("expected {}", form.describe()))
                        .at(path.span, "of another form"),
                );
                Some(error)
            }
        }
    }

    fn fit_form(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Val> {
        match (form, &value.kind) {
            (Form::Text, ValueKind::Text(text)) => Some(Val::Text(text.clone())),
            (Form::Name, ValueKind::Path(path)) if path.names.len() == 1 => Some(Val::Text(path.text())),
            (Form::Response, ValueKind::Path(path)) => self.response(&path.names[0]).map(Val::Response),
            (Form::Rule, ValueKind::Path(path)) => self.rule(&path.names[0]),
            (Form::Comparison, ValueKind::Compare { .. } | ValueKind::Path(_)) => {
                self.comparison(value, scope).map(Val::Comparison)
            }
            (Form::Number(measure), _) => self.number(measure, value, scope).map(Val::Number),
            (Form::Integer { min, max }, _) => self.integer(*min, *max, value, scope).map(Val::Number),
            (Form::Interval(measure), _) => self.interval(measure, value, scope),
            (Form::Place, _) => self.place(value, scope).map(Val::Number),
            (Form::Span, ValueKind::Range(from, to)) => self.span(from, to, scope),
            (Form::Object(kind), ValueKind::Object { base, fields }) => {
                let kind = schema::kind(kind)?;
                Some(Val::Record(Rc::new(self.object(base.as_ref(), fields, kind, value.span, scope))))
            }
            (Form::Words(_) | Form::OneOf(_), ValueKind::Call { word, arguments })
                if form.word(&word.text).is_some() =>
            {
                self.word(form.word(&word.text)?, arguments, word, scope)
            }
            (Form::Words(words), ValueKind::Call { word, .. }) => {
                self.unknown_word(word, &words.iter().collect::<Vec<_>>());
                None
            }
            (Form::OneOf(forms), _) => self.one_of(form, forms, value, scope),
            (Form::List(item), ValueKind::List { entries, unit }) => self.list(item, entries, unit.as_ref(), scope),
            (Form::List(item), _) => Some(Val::List(vec![self.fit(item, value, scope)])),
            (Form::Pairs { .. }, _) => self.pairs(form, value, scope),
            (_, other) => {
                self.wrong_form(form, shape(other), value.span);
                None
            }
        }
    }

    fn wrong_form(&mut self, form: &Form, found: &str, span: Span) {
        self.report(
            Diagnostic::new(Code::E0406, format!("expected {}, found {found}", form.describe()))
                .at(span, found.to_string()),
        );
    }

    fn shape_of(&mut self, value: &Value, scope: ScopeId, depth: u32) -> Shape {
        match &value.kind {
            ValueKind::Number { .. } | ValueKind::Binary(..) | ValueKind::Negate(_) | ValueKind::Per(..) => {
                Shape::Number
            }
            ValueKind::Call { word, .. } if matches!(word.text.as_str(), "sqrt" | "abs" | "min" | "max") => {
                Shape::Number
            }
            ValueKind::Object { .. } => Shape::Object,
            ValueKind::Path(path) if depth < 64 => {
                let Some(target) = self.resolve(path, scope, &[]) else { return Shape::Other };
                if target.is_let {
                    let tree = self.scopes[target.id.scope].tree.clone();
                    match &tree.items[target.id.item] {
                        Item::Let(l) => self.shape_of(&l.value, target.id.scope, depth + 1),
                        _ => Shape::Other,
                    }
                } else {
                    match self.slot_at(&target, path).map(|s| s.value) {
                        Some(Val::Number(_)) => Shape::Number,
                        Some(Val::Record(_)) => Shape::Object,
                        _ => Shape::Other,
                    }
                }
            }
            _ => Shape::Other,
        }
    }

    /// Picks the form that the value has: an object, or a number by its dimension.
    fn one_of(&mut self, form: &'static Form, forms: &'static [Form], value: &Value, scope: ScopeId) -> Option<Val> {
        match self.shape_of(value, scope, 0) {
            Shape::Object => {
                if let Some(object) = forms.iter().find(|f| matches!(f, Form::Object(_))) {
                    return self.fit_form(object, value, scope);
                }
            }
            Shape::Number => {
                if let Some(place) = forms.iter().find(|f| matches!(f, Form::Place)) {
                    return self.fit_form(place, value, scope);
                }
                let measures: Vec<&'static Measure> =
                    forms.iter().filter_map(|f| if let Form::Number(m) = f { Some(m) } else { None }).collect();
                if let Some(first) = measures.first() {
                    let raw = self.raw(value, scope)?;
                    let chosen = measures.iter().find(|m| Dimension::of(m.unit) == raw.dimension).unwrap_or(first);
                    if measures.len() > 1 && Dimension::of(chosen.unit) != raw.dimension {
                        let units: Vec<String> = measures.iter().map(|m| format!("`{}`", m.unit)).collect();
                        self.wrong_dimension(&raw, first, &format!("expected {}", or_list(&units)));
                        return None;
                    }
                    return self.hold(chosen, raw).map(Val::Number);
                }
            }
            Shape::Other => {}
        }
        if let ValueKind::Call { word, .. } = &value.kind {
            self.unknown_word(word, &form.words());
        } else {
            self.wrong_form(form, shape(&value.kind), value.span);
        }
        None
    }

    fn number(&mut self, measure: &'static Measure, value: &Value, scope: ScopeId) -> Option<Number> {
        let profile = match &value.kind {
            ValueKind::Call { word, .. } => PROFILES.contains(&word.text.as_str()),
            ValueKind::List { entries, .. } => entries.iter().any(|e| e.key.is_some()),
            _ => false,
        };
        if profile {
            let mistake = if measure.varies {
                Diagnostic::new(Code::E0411, "this version does not read profiles along the track yet")
                    .at(value.span, "planned")
            } else {
                Diagnostic::new(Code::E0406, "this value is one number; it cannot vary along the track")
                    .at(value.span, "a profile")
            };
            self.report(mistake);
            return None;
        }
        let raw = self.raw(value, scope)?;
        self.hold(measure, raw)
    }

    /// Checks dimension, basis and range.
    fn hold(&mut self, measure: &'static Measure, raw: Raw) -> Option<Number> {
        let expected = Dimension::of(measure.unit);
        if raw.dimension != expected {
            self.wrong_dimension(&raw, measure, &format!("expected {}", Form::Number(*measure).describe()));
            return None;
        }
        let (basis, factor) = self.basis(measure, &raw)?;
        let unit = parse_unit(measure.unit).map_or(1.0, |u| u.factor);
        let range_factor = measure.basis.map_or(1.0, |b| b.names[0].1);
        let shown = raw.value * factor / range_factor / unit;
        let slack = 1e-9 * shown.abs();
        if shown < measure.min - slack || shown > measure.max + slack {
            let per = measure.basis.map_or(String::new(), |b| format!(" per {}", b.names[0].0));
            let unit = if measure.unit.is_empty() { String::new() } else { format!(" {}", measure.unit) };
            self.report(
                Diagnostic::new(
                    Code::E0405,
                    format!(
                        "expected {} .. {}{unit}{per}, found {}{unit}{per}",
                        number(measure.min),
                        number(measure.max),
                        number(shown)
                    ),
                )
                .at(raw.span, "out of range"),
            );
            return None;
        }
        Some(Number { value: raw.value, dimension: raw.dimension, basis, factor })
    }

    fn basis(&mut self, measure: &'static Measure, raw: &Raw) -> Option<(Option<&'static str>, f64)> {
        match (measure.basis, &raw.basis) {
            (None, None) => Some((None, 1.0)),
            (None, Some((name, span))) => {
                self.report(
                    Diagnostic::new(
                        Code::E0304,
                        format!("`per {name}` says nothing here: the value is of one thing only"),
                    )
                    .at(*span, "leave it out"),
                );
                None
            }
            (Some(basis), Some((name, span))) => match basis.names.iter().find(|(n, _)| n == name) {
                Some((known, factor)) => Some((Some(known), *factor)),
                None => {
                    self.report(
                        Diagnostic::new(Code::E0304, format!("expected {}, found `per {name}`", basis.list()))
                            .at(*span, "not of this"),
                    );
                    None
                }
            },
            (Some(basis), None) => match basis.assumed {
                Some(name) => Some((Some(name), basis.factor(name)?)),
                None => {
                    let text = self.loader.sources.text(raw.span).to_string();
                    self.report(
                        Diagnostic::new(Code::E0304, format!("of what is this? say {}", basis.list()))
                            .at(raw.span, "could be of a half or of the whole")
                            .help(format!("write `{text} per {}`, if that is what it is", basis.names[0].0)),
                    );
                    None
                }
            },
        }
    }

    fn wrong_dimension(&mut self, raw: &Raw, measure: &Measure, expected: &str) {
        let dimension = Dimension::of(measure.unit);
        let text = self.loader.sources.text(raw.span).to_string();
        if raw.bare && raw.dimension.is_none() {
            self.report(
                Diagnostic::new(Code::E0301, format!("{expected}, found a number without a unit"))
                    .at(raw.span, "its unit is missing")
                    .help(format!("write `{text} {}`, if that is the unit you meant", measure.unit)),
            );
            return;
        }
        self.report(
            Diagnostic::new(Code::E0302, format!("{expected}, found {}", raw.dimension.describe()))
                .at(raw.span, Quantity::new(raw.value, raw.dimension).show(&raw.dimension.usual_unit()))
                .help(crate::units::compare(dimension, raw.dimension)),
        );
    }

    fn integer(&mut self, min: u32, max: u32, value: &Value, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        if !raw.dimension.is_none() {
            self.report(
                Diagnostic::new(Code::E0302, format!("expected a whole number, found {}", raw.dimension.describe()))
                    .at(raw.span, "has a unit"),
            );
            return None;
        }
        if raw.value.fract() != 0.0 || raw.value < f64::from(min) || raw.value > f64::from(max) {
            self.report(
                Diagnostic::new(
                    Code::E0405,
                    format!("expected a whole number from {min} to {max}, found {}", number(raw.value)),
                )
                .at(raw.span, "out of range"),
            );
            return None;
        }
        Some(raw.into())
    }

    /// `from .. to`; a bare first end takes the unit of the second, `per` holds for both.
    fn ends(&mut self, from: &Value, to: &Value, scope: ScopeId) -> Option<(Raw, Raw)> {
        let (mut a, b) = (self.raw(from, scope), self.raw(to, scope)?);
        if let (Some(raw), ValueKind::Number { unit: Some(unit), .. }) = (&mut a, unsigned(to))
            && raw.bare
        {
            raw.value *= parse_unit(&unit.text).map_or(1.0, |u| u.factor);
            raw.dimension = b.dimension;
            raw.bare = false;
        }
        Some((a?, b))
    }

    fn interval(&mut self, measure: &'static Measure, value: &Value, scope: ScopeId) -> Option<Val> {
        let (range, basis) = match &value.kind {
            ValueKind::Per(inner, basis) => (&**inner, Some((basis.text.clone(), basis.span))),
            _ => (value, None),
        };
        let ValueKind::Range(from, to) = &range.kind else {
            self.wrong_form(&Form::Interval(*measure), shape(&value.kind), value.span);
            return None;
        };
        let (a, b) = self.ends(from, to, scope)?;
        let a = self.hold(measure, Raw { basis: basis.clone().or(a.basis.clone()), ..a });
        let b = self.hold(measure, Raw { basis: basis.or(b.basis.clone()), ..b });
        self.ascending(a?, b?, value.span)
    }

    fn ascending(&mut self, a: Number, b: Number, span: Span) -> Option<Val> {
        if a.of_rail() <= b.of_rail() {
            return Some(Val::Range(a, b));
        }
        let text = self.loader.sources.text(span).to_string();
        let swapped =
            text.split_once("..").map(|(x, y)| format!("write the smaller end first: `{} .. {}`", y.trim(), x.trim()));
        self.report(
            Diagnostic::new(Code::E0505, "a span must ascend")
                .at(span, "its first end is the greater one")
                .maybe_help(swapped),
        );
        None
    }

    fn place(&mut self, value: &Value, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        self.hold_place(raw)
    }

    fn hold_place(&mut self, raw: Raw) -> Option<Number> {
        if raw.dimension == Dimension::LENGTH || raw.dimension == Dimension::SLEEPERS {
            return Some(raw.into());
        }
        let text = self.loader.sources.text(raw.span).to_string();
        let mistake = if raw.bare {
            Diagnostic::new(Code::E0301, "expected a place in `m` or `sleepers`, found a number without a unit")
                .at(raw.span, "its unit is missing")
                .help(format!("write `{text} sleepers` or `{text} m`"))
        } else {
            Diagnostic::new(
                Code::E0302,
                format!("expected a place in `m` or `sleepers`, found {}", raw.dimension.describe()),
            )
            .at(raw.span, "not a place")
        };
        self.report(mistake);
        None
    }

    pub fn span(&mut self, from: &Value, to: &Value, scope: ScopeId) -> Option<Val> {
        let (a, b) = self.ends(from, to, scope)?;
        let whole = from.span.to(to.span);
        let (a, b) = (self.hold_place(a), self.hold_place(b));
        let (a, b) = (a?, b?);
        if a.dimension != b.dimension {
            self.report(
                Diagnostic::new(Code::E0305, "both ends of a span are in `m`, or both in `sleepers`")
                    .at(whole, "mixed"),
            );
            return None;
        }
        self.ascending(a, b, whole)
    }

    pub fn response(&mut self, name: &Name) -> Option<Response> {
        let found = Response::of_name(&name.text);
        if found.is_none() {
            let near = nearest(&name.text, Response::ALL.iter().map(|r| r.name()));
            let help = near.map_or_else(
                || {
                    format!(
                        "the responses are {}",
                        Response::ALL.iter().map(|r| r.name()).collect::<Vec<_>>().join(", ")
                    )
                },
                |n| format!("did you mean `{n}`?"),
            );
            self.report(
                Diagnostic::new(Code::E0408, format!("no response is called `{}`", name.text))
                    .at(name.span, "unknown")
                    .help(help),
            );
        }
        found
    }

    fn rule(&mut self, name: &Name) -> Option<Val> {
        if Code::of_rule(&name.text).is_some() {
            return Some(Val::Text(name.text.clone()));
        }
        let rules: Vec<&str> = Code::ALL.iter().filter_map(|c| c.rule()).collect();
        let help = nearest(&name.text, rules.iter().copied())
            .map_or_else(|| format!("the rules are {}", rules.join(", ")), |n| format!("did you mean `{n}`?"));
        self.report(
            Diagnostic::new(Code::E0408, format!("no rule is called `{}`", name.text))
                .at(name.span, "unknown")
                .help(help),
        );
        None
    }

    fn unknown_word(&mut self, name: &Name, words: &[&'static Word]) {
        let known: Vec<&str> = words.iter().filter(|w| !w.planned).map(|w| w.name).collect();
        let help = nearest(&name.text, known.iter().copied()).map(|n| format!("did you mean `{n}`?"));
        let quoted: Vec<String> = known.iter().map(|w| format!("`{w}`")).collect();
        self.report(
            Diagnostic::new(Code::E0408, format!("expected {}, found `{}`", or_list(&quoted), name.text))
                .at(name.span, "unknown word")
                .maybe_help(help),
        );
    }

    /// A word with its arguments, by place or by name.
    fn word(&mut self, word: &'static Word, arguments: &[Argument], name: &Name, scope: ScopeId) -> Option<Val> {
        if word.planned {
            self.report(
                Diagnostic::new(Code::E0411, format!("this version does not know `{}` yet", word.name))
                    .at(name.span, "planned"),
            );
            return None;
        }
        let mut slots = BTreeMap::new();
        let mut unknown = false;
        for (i, argument) in arguments.iter().enumerate() {
            let field = match &argument.name {
                Some(name) => word.arguments.iter().find(|a| a.name == name.text),
                None => word.arguments.get(i),
            };
            let Some(field) = field else {
                let names: Vec<String> = word.arguments.iter().map(|a| format!("`{}`", a.name)).collect();
                let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
                let help =
                    if names.is_empty() { "it takes none".into() } else { format!("it takes {}", or_list(&names)) };
                self.report(
                    Diagnostic::new(Code::E0402, format!("`{}` has no such argument", word.name))
                        .at(place, "unknown argument")
                        .help(help),
                );
                unknown = true;
                continue;
            };
            let slot = self.fit(&field.form, &argument.value, scope);
            if slots.insert(field.name, slot).is_some() {
                self.report(
                    Diagnostic::new(Code::E0404, format!("`{}` of `{}` is given twice", field.name, word.name))
                        .at(argument.value.span, "again here"),
                );
            }
        }
        if unknown {
            // it may stand for one that seems to be missing
            let origin = self.origin(name.span, scope);
            for argument in word.arguments {
                slots.entry(argument.name).or_insert(Slot { value: Val::Error, span: name.span, origin });
            }
        }
        Some(Val::Word { word, arguments: slots })
    }

    fn list(&mut self, item: &'static Form, entries: &[Entry], unit: Option<&UnitText>, scope: ScopeId) -> Option<Val> {
        let mut slots = Vec::with_capacity(entries.len());
        for entry in entries {
            if let Some(key) = &entry.key {
                self.report(
                    Diagnostic::new(Code::E0406, "expected a value, found a pair")
                        .at(key.span, "a key where none belongs"),
                );
                continue;
            }
            slots.push(self.fit(item, &with_unit(&entry.value, unit), scope));
        }
        Some(Val::List(slots))
    }

    fn pairs(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Val> {
        let Form::Pairs { key, value: content, implied } = form else { return None };
        let alone;
        let (entries, unit) = match &value.kind {
            ValueKind::List { entries, unit } => (entries.as_slice(), unit.as_ref()),
            _ => {
                alone = [Entry { key: None, value: value.clone() }];
                (alone.as_slice(), None)
            }
        };
        let mut pairs = Vec::with_capacity(entries.len());
        for entry in entries {
            let pair = match (&entry.key, implied) {
                (Some(k), _) => (self.fit(key, k, scope), self.fit(content, &with_unit(&entry.value, unit), scope)),
                (None, Some(text)) => (self.fit(key, &entry.value, scope), self.default_value(content, text)),
                (None, None) => {
                    self.report(
                        Diagnostic::new(Code::E0406, format!("expected {}", form.describe()))
                            .at(entry.value.span, "a pair is needed here")
                            .help("write `[key: value]`"),
                    );
                    continue;
                }
            };
            pairs.push(pair);
        }
        Some(Val::Pairs(pairs))
    }
}

/// Gives the unit after a list to a bare number in it.
fn with_unit(value: &Value, unit: Option<&UnitText>) -> Value {
    let Some(unit_text) = unit else { return value.clone() };
    let kind = match &value.kind {
        ValueKind::Number { value: number, unit: None } => {
            ValueKind::Number { value: *number, unit: Some(unit_text.clone()) }
        }
        ValueKind::Negate(inner) => ValueKind::Negate(Box::new(with_unit(inner, unit))),
        ValueKind::Range(a, b) => ValueKind::Range(Box::new(with_unit(a, unit)), Box::new(with_unit(b, unit))),
        other => other.clone(),
    };
    Value { kind, span: value.span }
}

fn unsigned(value: &Value) -> &ValueKind {
    match &value.kind {
        ValueKind::Negate(inner) => unsigned(inner),
        kind => kind,
    }
}

/// Whether a bare name is read by the form itself, not looked up.
fn reads_names(form: &Form) -> bool {
    match form {
        Form::Name | Form::Response | Form::Rule | Form::Comparison => true,
        Form::List(item) => reads_names(item),
        _ => false,
    }
}

fn form_has_numbers(form: &Form) -> bool {
    match form {
        Form::Number(_) | Form::Integer { .. } | Form::Place => true,
        Form::OneOf(forms) => forms.iter().any(form_has_numbers),
        _ => false,
    }
}

fn form_has_object(form: &Form, kind: &str) -> bool {
    match form {
        Form::Object(k) => *k == kind,
        Form::OneOf(forms) => forms.iter().any(|f| form_has_object(f, kind)),
        _ => false,
    }
}

/// `, 5 .. 3000 MN/m`, for a hole.
fn range_of(form: &Form) -> String {
    match form {
        Form::Number(m) => format!(", {} .. {} {}", number(m.min), number(m.max), m.unit).trim_end().to_string(),
        Form::OneOf(forms) => forms.iter().map(range_of).find(|t| !t.is_empty()).unwrap_or_default(),
        _ => String::new(),
    }
}
