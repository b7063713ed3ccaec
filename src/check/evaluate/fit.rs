//! Checks a value against the form of its field.

use super::evaluator::Evaluator;
use super::objects;
use super::value::{Slot, Val};
use super::written::{is_profile, looks_like, with_unit};
use crate::check::text::scope::{MAIN_FILE, ScopeId};
use crate::diag::{Code, Diagnostic, Help, Label, Span, or_list};
use crate::scenario::Origin;
use crate::schema::{self, Form, Measure, Varies};
use crate::syntax::tree::{Entry, Item, Name, UnitText, Value, ValueKind};
use crate::units::{Dimension, number};
use std::rc::Rc;

/// The kind of a value, after names have been followed.
#[derive(PartialEq)]
enum Shape {
    Number,
    Object,
    Other,
}

impl Evaluator<'_> {
    /// The value of a field; [`Val::Error`] if a diagnostic has been given.
    pub fn fit(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Slot {
        let span = value.span;
        let origin = self.origin(span, scope);
        if let ValueKind::Error = value.kind {
            return Slot { value: Val::Error, span, origin };
        }
        if let ValueKind::Hole = value.kind {
            self.findings.report(
                Diagnostic::new(Code::E0410, format!("`?` stands for {}{}", form.describe(), range_of(form)))
                    .label(span, "to be given before a run")
                    .help(self.fitting(form)),
            );
            return Slot { value: Val::Hole, span, origin };
        }
        if let Some(slot) = self.through_name(form, value, scope) {
            return slot;
        }
        let fitted = self.fit_form(form, value, scope).unwrap_or(Val::Error);
        Slot { value: fitted, span, origin }
    }

    /// Help for a hole: values that fit the form.
    fn fitting(&self, form: &Form) -> String {
        let entries = self.entries(form);
        if entries.is_empty() {
            return "write a value here, or give one with `--set`".into();
        }
        format!("write a value here, such as {}, or give one with `--set`", or_list(&entries))
    }

    /// Objects of the main file that a form takes.
    fn declared(&self, form: &Form) -> Vec<String> {
        let main = self.scopes.iter().find(|scope| scope.tree.file == MAIN_FILE);
        let items = main.map_or(&[][..], |scope| scope.tree.items.as_slice());
        let fits = |item: &Item| match item {
            Item::Declaration(d) if form_has_object(form, &d.kind.text) => Some(format!("`{}`", d.name.as_ref()?.text)),
            _ => None,
        };
        items.iter().filter_map(fits).collect()
    }

    /// Entries of the standard library that a form takes.
    fn entries(&self, form: &Form) -> Vec<String> {
        let mut entries = Vec::new();
        for (module, scope) in &self.scopes[self.standard].modules {
            for item in &self.scopes[*scope].tree.items {
                if let Item::Declaration(d) = item
                    && let Some(name) = &d.name
                    && form_has_object(form, &d.kind.text)
                {
                    entries.push(format!("`{module}.{}`", name.text));
                }
            }
        }
        entries
    }

    /// A value that is a name: a word, a `let`, or something in a declaration. `None` for everything else, and for
    /// numbers, which arithmetic follows.
    fn through_name(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Slot> {
        let ValueKind::Path(path) = &value.kind else { return None };
        let error = Slot { value: Val::Error, span: value.span, origin: Origin::Written(value.span) };
        if reads_names(form) {
            return None;
        }
        let bare = path.names.len() == 1;
        let bound = |c: &Self, name: &Name| match c.scopes[scope].names.get(&name.text) {
            Some(item) => matches!(c.scopes[scope].tree.items.get(*item), Some(Item::Let(_))),
            None => false,
        };
        if let Form::Pairs { key, .. } = form
            && bare
            && reads_names(key)
            && !bound(self, &path.names[0])
        {
            return None;
        }
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
        // a text or a place without its quotes or its number
        let place = |form: &Form| matches!(form, Form::Place | Form::Span);
        let by_name = matches!(form, Form::Text) || place(form) || matches!(form, Form::List(item) if place(item));
        if by_name && bare && !self.scopes[scope].names.contains_key(&path.names[0].text) {
            if !self.unread_word(&path.names[0]) {
                self.wrong_form(form, "a name", path.span);
            }
            return Some(error);
        }
        let names: Vec<&str> = words.iter().filter(|w| !w.planned).map(|w| w.name).collect();
        let Some(target) = self.resolve(path, scope, &names) else {
            self.say_what_helps(path.names[0].span, || format!("expected {}", form.describe()));
            return Some(error);
        };
        if target.is_let {
            let tree = self.scopes[target.id.scope].tree.clone();
            let Item::Let(binding) = &tree.items[target.id.item] else { return Some(error) };
            let written = self.files.sources.text(binding.value.span).to_owned();
            if let (true, Some(object)) = (!form_has_numbers(form), objects::of_number(form, &written, &path.text())) {
                self.used.insert(target.id);
                self.findings.report(
                    Diagnostic::new(Code::E0406, format!("expected {}, found a number", form.describe()))
                        .label(path.span, "a number")
                        .advise(path.span, object),
                );
                return Some(error);
            }
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
                let found = format!("a {}", record.kind.name);
                self.wrong_form(form, &found, path.span);
                self.also_at(path.span, record.span, "declared here");
                Some(error)
            }
            Val::Text(_) if matches!(form, Form::Text) => Some(slot),
            Val::Profile(shape) => {
                let Form::Number(measure) = form else {
                    self.wrong_form(form, "a profile along the track", path.span);
                    return Some(error);
                };
                if measure.varies != Varies::Yes {
                    self.wrong_form(form, "a profile along the track", path.span);
                    return Some(error);
                }
                let held = self.rehold(measure, shape, path.span);
                let value = held.map_or(Val::Error, |shape| Val::Profile(Rc::new(shape)));
                Some(Slot { value, span: path.span, origin: self.origin(path.span, scope) })
            }
            Val::Word { word, .. } if words.iter().any(|w| w.name == word.name) => Some(slot),
            _ => {
                self.findings.report(
                    Diagnostic::new(
                        Code::E0406,
                        format!("expected {}, found {}", form.describe(), slot.value.describe()),
                    )
                    .label(path.span, "wrong form"),
                );
                Some(error)
            }
        }
    }

    fn fit_form(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Val> {
        if let Some(word) = per_inside(form, value) {
            return self.fit_form(form, &word, scope);
        }
        match (form, &value.kind) {
            (Form::Text, ValueKind::Text(text)) => Some(Val::Text(text.clone())),
            (Form::Name, ValueKind::Path(path)) if path.names.len() == 1 => Some(Val::Text(path.text())),
            (Form::Response, ValueKind::Path(path)) => self.response(&path.names[0]).map(Val::Response),
            (Form::Rule, ValueKind::Path(path)) => self.rule(&path.names[0]),
            (Form::Comparison, ValueKind::Compare { .. } | ValueKind::Path(_))
            | (Form::Expression | Form::Axes | Form::Settings, _) => Some(Val::Written(Rc::new(value.clone()), scope)),
            (Form::Number(measure), _) => self.number_or_profile(measure, value, scope),
            (Form::Integer { min, max }, _) => self.integer(*min, *max, value, scope).map(Val::Number),
            (Form::Interval(measure), _) => self.interval(measure, value, scope),
            (Form::Place, ValueKind::Range(..)) => {
                self.wrong_form(form, "a range", value.span);
                None
            }
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
                self.wrong_form(form, looks_like(other), value.span);
                None
            }
        }
    }

    /// Refuses a value of a wrong form, with help.
    pub(super) fn wrong_form(&mut self, form: &Form, found: &str, span: Span) {
        let instead = self.instead(form, found, span);
        // reports on the signs inside would lead to another value of the same wrong form
        self.superseded.push(span);
        self.findings.report(
            Diagnostic::new(Code::E0406, format!("expected {}, found {found}", form.describe()))
                .label(span, found.to_string())
                .maybe_advise(span, instead),
        );
    }

    /// Adds a related place to the mistake that was just reported at a place.
    fn also_at(&mut self, place: Span, span: Span, text: &str) {
        if let Some(last) =
            self.findings.diagnostics.last_mut().filter(|d| d.labels.len() == 1 && d.labels[0].span == place)
        {
            last.labels.push(Label { span, text: text.into() });
        }
    }

    /// Adds a help to the last diagnostic, if it is about this place and has none.
    fn say_what_helps(&mut self, place: Span, help: impl FnOnce() -> String) {
        let last = self.findings.diagnostics.last_mut();
        if let Some(last) = last.filter(|d| d.help.is_none() && d.labels.first().is_some_and(|l| l.span == place)) {
            last.help = Some(help());
        }
    }

    /// Help for a value of a wrong form.
    fn instead(&self, form: &Form, found: &str, span: Span) -> Option<Help> {
        let text = self.files.sources.text(span);
        if let Some(help) = self.entry_or_file(form, text) {
            return Some(help);
        }
        let quotes = |mark: char| text.strip_prefix(mark).and_then(|t| t.strip_suffix(mark));
        let unquoted = quotes('"').or_else(|| quotes('\'')).filter(|_| found == "text");
        if let Some(inner) = unquoted.filter(|t| !t.is_empty() && !t.contains('"')) {
            return Some(Help::write(inner).and(", without quotes"));
        }
        if matches!(form, Form::Text) && !text.contains(['\n', '"', '\\']) {
            return Some(Help::write(format!("\"{text}\"")));
        }
        if let Some(help) = self.by_habit(form, found, text) {
            return Some(help);
        }
        if let Form::Interval(_) = form {
            return span_of(text).map(Help::write);
        }
        if let Form::Span = form {
            let such = || Help::say("from one end to the other: `-20 .. -1 sleepers`, `-6 .. 0 m`");
            return Some(span_of(text).map_or_else(such, Help::write));
        }
        if found == "a range" && matches!(form, Form::Number(m) if m.varies == Varies::Yes) {
            let ramp = Help::write(format!("ramp({text})"));
            return Some(ramp.and(", if the value changes from one end to the other along the track"));
        }
        let own = self.declared(form);
        let entries = if own.is_empty() { self.entries(form) } else { own };
        let such = or_list(&entries.into_iter().take(3).collect::<Vec<_>>());
        (!such.is_empty()).then(|| Help::say(format!("name one, such as {such}, or write `{{ field = value }}`")))
    }

    /// Help for a text in quotes that is an entry of the library, or a file if a profile is allowed.
    fn entry_or_file(&self, form: &Form, text: &str) -> Option<Help> {
        let inner = text.strip_prefix('"')?.strip_suffix('"')?;
        if matches!(form, Form::Number(m) if m.varies == Varies::Yes) && inner.ends_with(".csv") {
            return Some(Help::write(format!("file({text})")));
        }
        let entry = self.entry_called(inner).filter(|entry| self.entries(form).contains(&format!("`{entry}`")))?;
        Some(Help::write(entry))
    }

    /// Help for a value of a wrong form that other languages write in this way.
    fn by_habit(&self, form: &Form, found: &str, text: &str) -> Option<Help> {
        let form = if let Form::List(item) = form { item } else { form };
        let field = self.asked.map(|(_, field)| field);
        let has = |name: &str| self.asked.is_some_and(|(kind, _)| kind.field(name).is_some());
        if found == "a number" {
            if let Some((module, entry)) =
                text.split_once('/').filter(|(m, _)| self.scopes[self.standard].modules.contains_key(*m))
            {
                let entry = entry.split([' ', '{']).next().unwrap_or(entry);
                return Some(Help::write(format!("{module}.{entry}")));
            }
            if let Some(help) = objects::of_number(form, text, text).or_else(|| objects::counted(form, text)) {
                return Some(help);
            }
            if let Form::Span = form
                && has("at")
                && text.split(' ').count() <= 2
            {
                return Some(Help::say(format!("one place is given with `at`: write `at = {text}`")));
            }
            let points = |w: &&schema::Word| matches!(w.arguments, [schema::Field { form: Form::Integer { .. }, .. }]);
            let words: Vec<String> =
                form.words().into_iter().filter(points).map(|w| format!("{}({text})", w.name)).collect();
            return (!words.is_empty()).then(|| Help::write_one_of(words));
        }
        if found == "a range" && matches!(form, Form::Place) && field == Some("at") && has("over") {
            return Some(Help::say(format!("a span is given with `over`: write `over = {text}`")));
        }
        if matches!(form, Form::Place) && found == "a name" {
            return Some(Help::say(
                "a place is a number: `-20 sleepers`, `[-20, -5] sleepers`; `over = -20 .. -1 sleepers` takes a whole \
                 span",
            ));
        }
        if found == "a list" && matches!(form, Form::Number(_)) {
            return Some(Help::say("a field has one value; a study tries several: `vary = [path: [value, value]]`"));
        }
        None
    }

    fn shape_of(&mut self, value: &Value, scope: ScopeId, depth: u32) -> Shape {
        match &value.kind {
            ValueKind::Per(inner, _) if matches!(inner.kind, ValueKind::Call { .. }) => {
                self.shape_of(inner, scope, depth)
            }
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

    /// Picks the form that the value has: an object by its kind, a number by its dimension, a list, a range, a profile.
    fn one_of(&mut self, form: &'static Form, forms: &'static [Form], value: &Value, scope: ScopeId) -> Option<Val> {
        let varying = |f: &&Form| matches!(f, Form::Number(m) if m.varies != Varies::No);
        if let Some(number) = forms.iter().find(varying).filter(|_| is_profile(value)) {
            return self.fit_form(number, value, scope);
        }
        match self.shape_of(value, scope, 0) {
            Shape::Object => {
                let extended = self.kind_extended(value, scope);
                let objects = || forms.iter().filter(|f| matches!(f, Form::Object(_)));
                let same = objects().find(|f| extended.is_some_and(|kind| form_has_object(f, kind)));
                if let Some(object) = same.or(objects().next()) {
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
                    let chosen = measures.iter().find(|m| Dimension::of_unit(m.unit) == raw.dimension).unwrap_or(first);
                    if measures.len() > 1 && Dimension::of_unit(chosen.unit) != raw.dimension {
                        let units: Vec<String> = measures.iter().map(|m| format!("`{}`", m.unit)).collect();
                        self.wrong_dimension(&raw, &measures, &format!("expected {}", or_list(&units)));
                        return None;
                    }
                    return self.hold(chosen, raw).map(Val::Number);
                }
                if let Some(whole) = forms.iter().find(|f| matches!(f, Form::Integer { .. })) {
                    return self.fit_form(whole, value, scope);
                }
            }
            Shape::Other => {
                let fits = |f: &&Form| match &value.kind {
                    ValueKind::List { .. } => matches!(f, Form::List(_) | Form::Pairs { .. }),
                    ValueKind::Range(..) => matches!(f, Form::Interval(_) | Form::Span),
                    _ => false,
                };
                if let Some(chosen) = forms.iter().find(fits) {
                    return self.fit_form(chosen, value, scope);
                }
            }
        }
        let bare = if let ValueKind::Per(inner, _) = &value.kind { inner } else { value };
        if let ValueKind::Call { word, .. } = &bare.kind {
            if let Some(object) = objects::of_word(form, &word.text, self.files.sources.text(value.span)) {
                self.findings.report(
                    Diagnostic::new(Code::E0406, format!("expected {}, found a word with arguments", form.describe()))
                        .label(value.span, "a word")
                        .advise(value.span, object),
                );
                return None;
            }
            self.unknown_word(word, &form.words());
        } else {
            self.wrong_form(form, looks_like(&value.kind), value.span);
        }
        None
    }

    /// The kind of the base of an object written in place.
    fn kind_extended(&mut self, value: &Value, scope: ScopeId) -> Option<&'static str> {
        let ValueKind::Object { base: Some(path), .. } = &value.kind else { return None };
        let target = self.resolve(path, scope, &[]).filter(|target| !target.is_let)?;
        match self.slot_at(&target, path)?.value {
            Val::Record(record) => Some(record.kind.name),
            _ => None,
        }
    }

    fn list(&mut self, item: &'static Form, entries: &[Entry], unit: Option<&UnitText>, scope: ScopeId) -> Option<Val> {
        let mut slots = Vec::with_capacity(entries.len());
        let before = self.findings.diagnostics.len();
        for entry in entries {
            if let Some(key) = &entry.key {
                self.superseded.push(key.span.to(entry.value.span));
                let help = match item {
                    Form::Comparison => Help::say("comparisons are `<`, `<=`, `>` and `>=`"),
                    Form::Place => Help::say("several places are `[-20, -5] sleepers`, a span is `-20 .. -1 sleepers`"),
                    _ => Help::write(self.files.sources.text(key.span)).and(" alone"),
                };
                self.findings.report(
                    Diagnostic::new(Code::E0406, "expected a value, found a pair")
                        .label(key.span, "no key is allowed here")
                        .advise(key.span.to(entry.value.span), help),
                );
                continue;
            }
            slots.push(self.fit(item, &with_unit(&entry.value, unit), scope));
        }
        self.one_missing_unit(before, entries);
        Some(Val::List(slots))
    }

    /// Reports a unit that all numbers of a list lack once: behind the list, or behind each of its keys.
    pub fn one_missing_unit(&mut self, before: usize, entries: &[Entry]) {
        let found = &self.findings.diagnostics[before.min(self.findings.diagnostics.len())..];
        let (Some(first), Some(last)) = (entries.first(), entries.last()) else { return };
        let percent = |d: &Diagnostic| d.code == Code::E0405 && d.help.as_deref().is_some_and(|h| h.ends_with(" %`"));
        let code = match found {
            [one, ..] if found.iter().all(|d| d.code == Code::E0301) => one.code,
            [one, ..] if found.iter().all(percent) => one.code,
            _ => return,
        };
        let (one, other) = (&found[0], &found[found.len() - 1]);
        let of_keys = first.key.as_ref().is_some_and(|key| key.span.covers(one.labels[0].span));
        let several = found.len() == entries.len() || code == Code::E0405;
        if found.len() < 2 && entries.len() > 1 && !all_bare(entries)
            || entries.len() < 2
            || !several && found.len() > 1
        {
            return;
        }
        let start = first.key.as_ref().map_or(first.value.span, |key| key.span);
        let whole = start.to(last.value.span);
        // `write `-20 sleepers` or `-20 m`` gives the possible units
        let help = other.help.as_deref().unwrap_or_default();
        let wrote = self.files.sources.text(other.labels[0].span);
        let units: Vec<&str> = help.split('`').skip(1).step_by(2).filter_map(|code| code.strip_prefix(wrote)).collect();
        let text = |value: &Value| self.files.sources.text(value.span);
        let with = |unit: &&str| match of_keys {
            true => {
                let pair = |e: &Entry| format!("{}{unit}: {}", e.key.as_ref().map_or("", text), text(&e.value));
                format!("[{}]", entries.iter().map(pair).collect::<Vec<_>>().join(", "))
            }
            false => format!("[{}]{unit}", self.files.sources.text(whole)),
        };
        let write: Vec<String> = units.iter().map(with).collect();
        if write.is_empty() {
            return;
        }
        let message = match code {
            Code::E0301 => one.message.replace("a number without a unit", "numbers without a unit"),
            _ => "expected shares in `%`, found numbers without it".to_owned(),
        };
        self.findings.diagnostics.truncate(before);
        self.findings.report(
            Diagnostic::new(code, message)
                .label(whole, "their unit is missing")
                .advise(self.in_brackets(whole), Help::write_one_of(write)),
        );
    }

    /// The entries of a list with the brackets around them.
    fn in_brackets(&self, entries: Span) -> Span {
        let text = &self.files.sources.get(entries.file).text;
        let (before, after) = (&text[..entries.start as usize], &text[entries.end as usize..]);
        let start = before.trim_end().strip_suffix('[').map_or(before.len(), str::len);
        let skipped = after.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        let end = skipped.strip_prefix(']').map_or(entries.end as usize, |rest| text.len() - rest.len());
        Span::new(entries.file, start, end)
    }
}

/// Whether the values of a list are all numbers without a unit.
fn all_bare(entries: &[Entry]) -> bool {
    let bare = |value: &Value| matches!(value.kind, ValueKind::Number { unit: None, .. });
    entries.iter().all(|entry| entry.key.is_none() && bare(&entry.value))
}

/// `cyclic(5 .. 60 kN, 5 Hz) per sleeper`: `per` after a word applies to its arguments that have a basis.
fn per_inside(form: &Form, value: &Value) -> Option<Value> {
    let ValueKind::Per(inner, basis) = &value.kind else { return None };
    let ValueKind::Call { word, arguments } = &inner.kind else { return None };
    let known = form.word(&word.text)?;
    let mut arguments = arguments.clone();
    let mut any = false;
    for (i, argument) in arguments.iter_mut().enumerate() {
        let field = match &argument.name {
            Some(name) => known.arguments.iter().find(|a| a.name == name.text),
            None => known.arguments.get(i),
        };
        if let Some(Form::Number(Measure { basis: Some(_), .. }) | Form::Interval(Measure { basis: Some(_), .. })) =
            field.map(|f| &f.form)
        {
            any = true;
            let of = ValueKind::Per(Box::new(argument.value.clone()), basis.clone());
            argument.value = Value { kind: of, span: argument.value.span };
        }
    }
    if !any && known.arguments.iter().any(|a| a.name == "per") {
        let of = crate::syntax::tree::Path { names: vec![basis.clone()], span: basis.span };
        let name = Some(Name { text: "per".to_string(), span: basis.span });
        let value = Value { kind: ValueKind::Path(of), span: basis.span };
        arguments.push(crate::syntax::tree::Argument { name, value });
        any = true;
    }
    any.then(|| Value { kind: ValueKind::Call { word: word.clone(), arguments }, span: value.span })
}

/// The span that a difference or a list of two ends was meant for: `-20 - -1 sleepers`, `[-20, -1] sleepers`.
fn span_of(text: &str) -> Option<String> {
    if let Some((ends, unit)) = text.strip_prefix('[').and_then(|t| t.split_once(']')) {
        let (from, to) = ends.split_once(',')?;
        return Some(format!("{} .. {}{unit}", from.trim(), to.trim()));
    }
    let (from, to) = text.split_once(" - ")?;
    Some(format!("{} .. {}", from.trim(), to.trim()))
}

/// Whether the form itself reads a bare name, without looking it up.
fn reads_names(form: &Form) -> bool {
    match form {
        Form::Name | Form::Response | Form::Rule | Form::Comparison | Form::Expression => true,
        Form::Axes | Form::Settings => true,
        Form::List(item) => reads_names(item),
        _ => false,
    }
}

pub(super) fn form_has_numbers(form: &Form) -> bool {
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
