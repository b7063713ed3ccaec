//! The values that a study varies: `open.pad.stiffness: 20 .. 80 MN/m`. Every path must lead to a field or a `let` of
//! the file. Every value is checked against the form of that field, as if it were written there.

use super::expression::one_line;
use super::reader::Reader;
use crate::check::evaluate::measure::swapped;
use crate::check::evaluate::number::Raw;
use crate::check::evaluate::records::object_kind;
use crate::check::evaluate::written::{looks_like, with_unit};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Help, Span, or_list};
use crate::scenario::{Axis, Choice, Setting, Spread, Values};
use crate::schema::{self, Form, Kind, Names, called};
use crate::syntax::tree::{Argument, Declaration, Entry, Item, Name, Path, UnitText, Value, ValueKind};
use crate::units::{Dimension, number, parse_unit};

const DISTRIBUTIONS: [&str; 4] = ["steps", "uniform", "normal", "log_normal"];
/// Largest number of levels of `steps`.
const MOST_STEPS: f64 = 1e4;
/// Kinds that ask about the scene and are not part of it.
const NOT_OF_THE_SCENE: [&str; 2] = ["study", "scenario"];

/// The target of a path.
#[derive(Clone, Copy)]
enum Varied {
    Field(&'static Form),
    Let(ItemId),
}

/// The unit and basis that an axis states once for all its numbers.
struct Suffix {
    unit: Option<UnitText>,
    per: Option<Name>,
}

impl Reader<'_, '_> {
    /// `[path: values]`
    pub(super) fn axes(&mut self, value: &Value, scope: ScopeId) -> Option<Vec<Axis>> {
        let pairs = self.paths(value, "values")?;
        let axes: Vec<Option<Axis>> = pairs
            .into_iter()
            .map(|(path, entry)| {
                let target = self.target(path, scope)?;
                let (unit, values) = self.values(target, &entry.value, scope)?;
                let written = self.written(path, &unit, scope);
                Some(Axis { path: path.text(), span: path.span, unit, values, written })
            })
            .collect();
        axes.into_iter().collect()
    }

    /// `[path: value]`
    pub fn settings(&mut self, value: &Value, scope: ScopeId) -> Option<Vec<Setting>> {
        let pairs = self.paths(value, "value")?;
        let settings: Vec<Option<Setting>> = pairs
            .into_iter()
            .map(|(path, entry)| {
                let target = self.target(path, scope)?;
                self.may_stand(target, &entry.value, scope)?;
                let value = one_line(self.eval.files.sources.text(entry.value.span));
                Some(Setting { path: path.text(), value, span: path.span })
            })
            .collect();
        settings.into_iter().collect()
    }

    /// Pairs whose keys are paths.
    fn paths<'v>(&mut self, value: &'v Value, what: &str) -> Option<Vec<(&'v Path, &'v Entry)>> {
        let help = format!("write `[path: {what}]`, such as `[open.pad.stiffness: [20, 40] MN/m]`");
        let ValueKind::List { entries, unit: None } = &value.kind else {
            self.eval.findings.report(
                Diagnostic::new(Code::E0406, format!("expected a list of pairs, found {}", looks_like(&value.kind)))
                    .label(value.span, "no path")
                    .help(help),
            );
            return None;
        };
        let mut pairs = Vec::with_capacity(entries.len());
        let mut told = false;
        for (i, entry) in entries.iter().enumerate() {
            match entry.key.as_ref().map(|key| (&key.kind, key.span)) {
                Some((ValueKind::Path(path), _)) => pairs.push((path, entry)),
                // values without a key behind a pair belong to the pair
                None if told => {}
                found => {
                    let place = found.map_or(entry.value.span, |(_, span)| span);
                    let mended = found.and_then(|(_, span)| self.as_path(span));
                    let alone = || self.values_alone(entries, i).map(Help::say);
                    let help = mended.or_else(alone).unwrap_or_else(|| Help::say(help.clone()));
                    self.eval.findings.report(
                        Diagnostic::new(Code::E0406, format!("expected `path: {what}`"))
                            .label(place, "no path")
                            .advise(place, help),
                    );
                    told = true;
                }
            }
        }
        if entries.is_empty() {
            self.eval.findings.report(
                Diagnostic::new(Code::E0406, "the list is empty").label(value.span, "varies nothing").help(&help),
            );
        }
        (!pairs.is_empty() && pairs.len() == entries.len()).then_some(pairs)
    }

    /// A path in quotes, or with `/` between its names.
    fn as_path(&self, span: Span) -> Option<Help> {
        let text = self.eval.files.sources.text(span).trim_matches('"').replace('/', ".");
        let plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "_.".contains(c));
        plain.then(|| Help::write(text).after("join names by dots: "))
    }

    /// The missing brackets around values behind a pair: `bay: 0.55, 0.6 m`.
    fn values_alone(&self, entries: &[Entry], at: usize) -> Option<String> {
        let last = entries[at..].iter().take_while(|e| e.key.is_none()).last()?;
        let first = entries.get(at.checked_sub(1)?)?;
        let text = self.eval.files.sources.text(first.value.span.to(last.value.span));
        let (numbers, unit) = match text.rsplit_once(',') {
            Some((_, last)) => last
                .trim()
                .split_once(' ')
                .map_or((text, ""), |(_, unit)| (text.trim_end_matches(unit).trim_end(), unit)),
            None => (text, ""),
        };
        let path = self.eval.files.sources.text(first.key.as_ref()?.span);
        Some(format!("write several values in brackets: `{}`", format!("{path}: [{numbers}] {unit}").trim_end()))
    }

    /// The target of a path in this file.
    fn target(&mut self, path: &Path, scope: ScopeId) -> Option<Varied> {
        let first = &path.names[0];
        let Some(&item) = self.eval.scopes[scope].names.get(&first.text) else {
            self.nothing_there(path, scope);
            return None;
        };
        let tree = self.eval.scopes[scope].tree.clone();
        let declaration = match &tree.items[item] {
            Item::Declaration(declaration) => declaration,
            Item::Let(_) if path.names.len() == 1 => return Some(Varied::Let(ItemId { scope, item })),
            _ => {
                let text = format!("there is nothing inside `{}` to vary", first.text);
                self.eval
                    .findings
                    .report(Diagnostic::new(Code::E0704, text).label(path.names[1].span, "inside a `let`"));
                return None;
            }
        };
        let kind = schema::kind(&declaration.kind.text)?;
        if NOT_OF_THE_SCENE.contains(&kind.name) {
            let text = format!("a study cannot vary a {}", kind.name);
            self.eval.findings.report(Diagnostic::new(Code::E0704, text).label(first.span, "not a part of the scene"));
            return None;
        }
        let [_, fields @ ..] = path.names.as_slice() else { return None };
        if fields.is_empty() {
            let number = kind.fields.iter().find(|f| f.form.measure().is_some());
            let example = number.or(kind.fields.first()).map(|f| format!("such as `{}.{}`", first.text, f.name));
            self.eval.findings.report(
                Diagnostic::new(Code::E0704, format!("`{}` is a {}, not one field", first.text, kind.name))
                    .label(path.span, "name one field")
                    .maybe_help(example),
            );
            return None;
        }
        self.field_at(kind, fields).map(Varied::Field)
    }

    /// Reports a path whose first name is unknown.
    fn nothing_there(&mut self, path: &Path, scope: ScopeId) {
        let first = &path.names[0];
        if self.eval.unread_word(first) || self.eval.scopes[scope].broken.contains(&first.text) {
            return;
        }
        let (message, help) = if self.eval.scopes[scope].modules.contains_key(&first.text) {
            let message = format!("a study varies declarations of its own file, but `{}` is a module", first.text);
            (message, self.declared_here(path, scope).map(Help::say))
        } else {
            let near = nearest(&first.text, self.eval.scopes[scope].names.keys().map(String::as_str));
            let message = format!("this file declares nothing called `{}` to vary", first.text);
            let full = self.full_path(path, scope).map(|full| (path.span, Help::write(full)));
            let (place, help) = full.or_else(|| Some((first.span, Help::meant(near?)))).unzip();
            let mistake = Diagnostic::new(Code::E0704, message).label(first.span, "unknown here");
            self.eval.findings.report(mistake.maybe_advise(place.unwrap_or(first.span), help));
            return;
        };
        self.eval.findings.report(
            Diagnostic::new(Code::E0704, message).label(first.span, "unknown here").maybe_advise(first.span, help),
        );
    }

    /// Help for an object of another file: how to declare it in this file, so that a study may vary it.
    fn declared_here(&self, path: &Path, scope: ScopeId) -> Option<String> {
        let [module, own, rest @ ..] = path.names.as_slice() else { return None };
        let other = self.eval.scopes[scope].modules.get(&module.text)?;
        let item = self.eval.scopes[*other].names.get(&own.text)?;
        let Item::Declaration(declared) = &self.eval.scopes[*other].tree.items[*item] else { return None };
        let kind = &declared.kind.text;
        let behind: String = rest.iter().map(|name| format!(".{}", name.text)).collect();
        let declare = format!(
            "declare `{kind} {0} : {1}.{0}` here, let the scene use it, and vary `{0}{behind}`",
            own.text, module.text
        );
        // a field of this file that may hold such an object
        let holds = |d: &Declaration| {
            let field = schema::kind(&d.kind.text)?.field(kind)?;
            object_kind(&field.form).filter(|k| k.name == kind.as_str())?;
            Some(format!("{}.{}{behind}", d.name.as_ref()?.text, field.name))
        };
        let held = self.declarations(scope).find_map(holds);
        Some(match held {
            Some(held) => format!("{declare}; or vary `{held}`"),
            None => declare,
        })
    }

    /// The path of this file that was probably meant by a path that begins with a kind or with a field.
    fn full_path(&self, path: &Path, scope: ScopeId) -> Option<String> {
        let text = |names: &[Name]| names.iter().map(|n| n.text.as_str()).collect::<Vec<_>>().join(".");
        let [first, rest @ ..] = path.names.as_slice() else { return None };
        if let Some(second) = rest.first().filter(|_| schema::kind(&first.text).is_some())
            && self.eval.scopes[scope].names.contains_key(&second.text)
        {
            return Some(text(rest));
        }
        let named = |d: &Declaration| Some((schema::kind(&d.kind.text)?, d.name.as_ref()?.text.clone()));
        if !rest.is_empty()
            && let Some((_, name)) =
                self.declarations(scope).filter_map(named).find(|(kind, _)| kind.name == first.text)
        {
            return Some(format!("{name}.{}", text(rest)));
        }
        let has = |(kind, _): &(&'static Kind, String)| kind.fields.iter().any(|f| f.name == first.text);
        self.declarations(scope).filter_map(named).find(has).map(|(_, name)| format!("{name}.{}", path.text()))
    }

    fn declarations(&self, scope: ScopeId) -> impl Iterator<Item = &Declaration> {
        self.eval.scopes[scope].tree.items.iter().filter_map(|item| match item {
            Item::Declaration(d) => Some(d),
            _ => None,
        })
    }

    /// Follows fields into a kind, at last into an argument of a word or a pair by its key.
    fn field_at(&mut self, kind: &'static Kind, names: &[Name]) -> Option<&'static Form> {
        let [name, rest @ ..] = names else { return None };
        let Some(field) = kind.field(&name.text) else {
            if kind.planned.contains(&name.text.as_str()) {
                self.eval.field_of(kind, name);
                return None;
            }
            let near = kind.meant(&name.text).map(Help::meant);
            self.eval.findings.report(
                Diagnostic::new(Code::E0704, format!("a {} has no `{}` to vary", kind.name, name.text))
                    .label(name.span, "unknown field")
                    .help(format!("`trackbed docs {}` lists its fields", kind.name))
                    .maybe_advise(name.span, near),
            );
            return None;
        };
        let [next, ..] = rest else { return Some(&field.form) };
        if let Some(inner) = object_kind(&field.form) {
            return self.field_at(inner, rest);
        }
        let arguments = || field.form.words().into_iter().flat_map(|w| w.arguments);
        if let Some(argument) = arguments().find(|a| a.name == next.text) {
            return Some(&argument.form);
        }
        if let Form::Pairs { value, .. } = &field.form {
            return Some(value);
        }
        let near = nearest(&next.text, arguments().map(|a| a.name));
        self.eval.findings.report(
            Diagnostic::new(Code::E0704, format!("there is no `{}` inside `{}` to vary", next.text, field.name))
                .label(next.span, "not found")
                .maybe_meant(next.span, near),
        );
        None
    }

    /// Whether a value is allowed at the target of the path.
    fn may_stand(&mut self, target: Varied, value: &Value, scope: ScopeId) -> Option<()> {
        let before = self.eval.findings.errors();
        match target {
            Varied::Field(form) => {
                let slot = self.eval.fit(form, value, scope);
                self.read(form, &slot);
            }
            Varied::Let(id) => self.like_the_let(id, value, scope),
        }
        (self.eval.findings.errors() == before).then_some(())
    }

    /// Checks that a number for a numeric `let` has the dimension of the `let`.
    fn like_the_let(&mut self, id: ItemId, value: &Value, scope: ScopeId) {
        let tree = self.eval.scopes[id.scope].tree.clone();
        let Item::Let(binding) = &tree.items[id.item] else { return };
        if !is_number(value) || !is_number(&binding.value) {
            self.eval.units_in(value);
            return;
        }
        // the value there may be wrong itself; then it has been reported
        let told = self.eval.findings.diagnostics.iter().filter(|d| d.is_error()).filter_map(|d| d.labels.first());
        if told.map(|label| label.span).any(|span| binding.value.span.covers(span)) {
            return;
        }
        if let (Some(own), Some(raw)) = (self.eval.raw(&binding.value, id.scope), self.eval.raw(value, scope))
            && own.dimension != raw.dimension
        {
            let code = if raw.dimension.is_none() { Code::E0301 } else { Code::E0302 };
            let unit = unit_text(&binding.value).filter(|_| code == Code::E0301);
            let text = self.eval.files.sources.text(value.span);
            let written = unit.map(|unit| Help::write(format!("{text} {}", unit.text)));
            let help = written.map(|help| help.and(", if that is the unit you meant"));
            self.eval.findings.report(
                Diagnostic::new(
                    code,
                    format!("expected {}, found {}", own.dimension.describe(), raw.dimension.describe()),
                )
                .label(value.span, "wrong dimension")
                .label(binding.value.span, "the value that it replaces")
                .maybe_advise(value.span, help),
            );
        }
    }

    /// The values of an axis, and the text behind its numbers.
    fn values(&mut self, target: Varied, value: &Value, scope: ScopeId) -> Option<(String, Values)> {
        let (inner, per) = match &value.kind {
            ValueKind::Per(inner, per) => (&**inner, Some(per.clone())),
            _ => (value, None),
        };
        match &inner.kind {
            ValueKind::List { entries, unit } if !entries.is_empty() => {
                self.choices(target, entries, Suffix { unit: unit.clone(), per }, scope)
            }
            ValueKind::Range(from, to) => {
                let (unit, [from, to]) = self.ends_of(target, from, to, per.as_ref(), scope)?;
                Some((unit, Values::Spread(Spread::Uniform { from, to })))
            }
            ValueKind::Call { word, arguments } if DISTRIBUTIONS.contains(&word.text.as_str()) => {
                self.distribution(target, word, arguments, per.as_ref(), scope)
            }
            other => {
                if *other == ValueKind::Error {
                    return None;
                }
                let near = match other {
                    ValueKind::Call { word, .. } => {
                        let called = called(Names::Words, &word.text, DISTRIBUTIONS.into_iter());
                        called.or_else(|| nearest(&word.text, DISTRIBUTIONS))
                    }
                    _ => None,
                };
                let text = self.eval.files.sources.text(inner.span);
                let help = match near {
                    Some("steps") => Help::say("write something like `steps(20 .. 80 MN/m, count = 4)`"),
                    Some(near) => Help::say(format!("did you mean `{near}`?")),
                    None if is_number(inner) => Help::write(format!("[{text}]")).after("write one value as a list: "),
                    None => Help::say("write `[value, value]`"),
                };
                let words: Vec<String> = DISTRIBUTIONS.iter().map(|w| format!("`{w}`")).collect();
                let expected =
                    format!("expected a list, `from .. to`, {}, found {}", or_list(&words), looks_like(other));
                self.eval.findings.report(
                    Diagnostic::new(Code::E0406, expected)
                        .label(inner.span, "not a list or range of values")
                        .advise(inner.span, help),
                );
                None
            }
        }
    }

    fn choices(
        &mut self,
        target: Varied,
        entries: &[Entry],
        suffix: Suffix,
        scope: ScopeId,
    ) -> Option<(String, Values)> {
        let mut choices = Vec::with_capacity(entries.len());
        let (mut sound, mut common) = (true, None);
        let mut wrong_unit = false;
        let before = self.eval.findings.diagnostics.len();
        for entry in entries {
            let bare = unit_of_all(&entry.value);
            if wrong_unit && bare {
                continue;
            }
            let value = wrapped(with_unit(&entry.value, suffix.unit.as_ref()), suffix.per.as_ref());
            if let (Some(_), ValueKind::Error) = (&entry.key, &entry.value.kind) {
                sound = false;
                continue;
            }
            if let Some(key) = &entry.key {
                self.eval
                    .findings
                    .report(Diagnostic::new(Code::E0406, "expected a value, found a pair").label(key.span, "a key"));
                sound = false;
                continue;
            }
            let stands = self.may_stand(target, &value, scope).is_some();
            sound &= stands;
            // a mistake of all numbers of the list is reported once
            wrong_unit |= !stands
                && bare
                && matches!(
                    self.eval.findings.diagnostics.last().map(|d| d.code),
                    Some(Code::E0301 | Code::E0302 | Code::E0304)
                );
            let raw = if sound && is_number(&value) { self.eval.raw(&value, scope) } else { None };
            let unit = suffix_of(&value, raw.as_ref());
            let number = raw.and_then(|raw| Some((raw.value / unit_size(&unit)?, unit.clone())));
            let text = one_line(self.eval.files.sources.text(entry.value.span));
            let behind = if bare { suffix.text() } else { suffix.per_text() };
            choices.push((text + &behind, number, entry.value.span));
            common.get_or_insert(unit);
        }
        if wrong_unit {
            self.eval.one_missing_unit(before, entries);
        }
        // numbers are shown in one unit, if they have one
        let common = common?;
        let same = choices.iter().all(|(_, number, _)| number.as_ref().is_some_and(|(_, unit)| *unit == common));
        let choices = choices
            .into_iter()
            .map(|(text, number, span)| Choice { text, number: number.filter(|_| same).map(|(n, _)| n), span })
            .collect();
        sound.then_some((if same { common } else { String::new() }, Values::Listed(choices)))
    }

    /// Both ends of a range in its unit, each checked against the target.
    fn ends_of(
        &mut self,
        target: Varied,
        from: &Value,
        to: &Value,
        per: Option<&Name>,
        scope: ScopeId,
    ) -> Option<(String, [f64; 2])> {
        let unit = unit_text(to);
        let from = with_unit(from, unit.as_ref());
        self.with_units(target, &from, to, per, scope)?;
        let held = [&from, to].map(|end| self.may_stand(target, &wrapped(end.clone(), per), scope));
        let (a, b) = self.eval.ends(&from, to, scope)?;
        held[0].and(held[1])?;
        if a.dimension != b.dimension {
            self.unlike(&a, &b);
            return None;
        }
        if a.value >= b.value {
            let whole = from.span.to(to.span);
            let text = self.eval.files.sources.text(whole).to_owned();
            self.eval.findings.report(
                Diagnostic::new(Code::E0505, "a range must ascend")
                    .label(whole, "the first end is not smaller than the second")
                    .maybe_help(swapped(&text).map(|help| help.said)),
            );
            return None;
        }
        let suffix = suffix_of(&wrapped(to.clone(), per), Some(&b));
        let size = unit_size(&suffix)?;
        Some((suffix, [a.value / size, b.value / size]))
    }

    /// Refuses two ends without units, in one diagnostic.
    fn with_units(
        &mut self,
        target: Varied,
        from: &Value,
        to: &Value,
        per: Option<&Name>,
        scope: ScopeId,
    ) -> Option<()> {
        let Varied::Field(form) = target else { return Some(()) };
        let Some(measure) = form.measure().filter(|m| !Dimension::of_unit(m.unit).is_none()) else { return Some(()) };
        if !(unit_of_all(from) && unit_of_all(to)) {
            return Some(());
        }
        let ends = [self.eval.raw(from, scope)?.value, self.eval.raw(to, scope)?.value];
        let expected = format!("expected {}", Form::Number(*measure).describe());
        let per = per.map(|name| name.text.as_str());
        self.eval.missing_unit(&[measure], &ends, per, from.span.to(to.span), &expected);
        None
    }

    fn unlike(&mut self, a: &Raw, b: &Raw) {
        self.eval.findings.report(
            Diagnostic::new(Code::E0305, "both values need the same dimension")
                .label(a.span, a.dimension.describe())
                .label(b.span, b.dimension.describe()),
        );
    }

    fn distribution(
        &mut self,
        target: Varied,
        word: &Name,
        arguments: &[Argument],
        per: Option<&Name>,
        scope: ScopeId,
    ) -> Option<(String, Values)> {
        let (arguments, per) = bare(arguments, per);
        let (arguments, per) = (arguments.as_slice(), per.as_ref());
        let named = |i: usize, names: &[&str]| {
            let by_name = arguments.iter().find(|a| a.name.as_ref().is_some_and(|n| names.contains(&n.text.as_str())));
            by_name.or_else(|| arguments.get(i).filter(|a| a.name.is_none())).map(|a| &a.value)
        };
        let spread = |unit: String, spread: Spread| Some((unit, Values::Spread(spread)));
        match (word.text.as_str(), arguments) {
            ("uniform", [Argument { name: None, value: Value { kind: ValueKind::Range(from, to), .. } }]) => {
                let (unit, [from, to]) = self.ends_of(target, from, to, per, scope)?;
                spread(unit, Spread::Uniform { from, to })
            }
            ("steps", [Argument { name: None, value: range }, Argument { name: Some(how), value: step }]) => {
                let ValueKind::Range(from, to) = &range.kind else {
                    return self.malformed(word);
                };
                self.steps(target, (from, to), (how, step), per, scope)
            }
            ("normal", [_, _]) => {
                let (Some(mean), Some(sd)) = (named(0, &["mean"]), named(1, &["sd"])) else {
                    return self.malformed(word);
                };
                self.may_stand(target, &wrapped(mean.clone(), per), scope)?;
                let (m, s) = (self.eval.raw(mean, scope)?, self.eval.raw(sd, scope)?);
                if m.dimension != s.dimension {
                    self.unlike(&m, &s);
                    return None;
                }
                self.positive(s.value, sd.span)?;
                let unit = suffix_of(&wrapped(mean.clone(), per), Some(&m));
                let size = unit_size(&unit)?;
                spread(unit, Spread::Normal { mean: m.value / size, deviation: s.value / size })
            }
            ("log_normal", [_, _]) => {
                let (Some(median), Some(cov)) = (named(0, &["median"]), named(1, &["cov"])) else {
                    return self.malformed(word);
                };
                self.may_stand(target, &wrapped(median.clone(), per), scope)?;
                let (m, c) = (self.eval.raw(median, scope)?, self.eval.raw(cov, scope)?);
                if !c.dimension.is_none() {
                    let found = c.dimension.describe();
                    let text = format!("expected a share such as `20 %`, found {found}");
                    self.eval.findings.report(Diagnostic::new(Code::E0302, text).label(cov.span, found));
                    return None;
                }
                self.positive(c.value, cov.span)?;
                self.positive(m.value, median.span)?;
                let unit = suffix_of(&wrapped(median.clone(), per), Some(&m));
                let sigma = (1.0 + c.value * c.value).ln().sqrt();
                let size = unit_size(&unit)?;
                spread(unit, Spread::LogNormal { median: m.value / size, sigma })
            }
            _ => self.malformed(word),
        }
    }

    fn positive(&mut self, value: f64, span: Span) -> Option<()> {
        if value > 0.0 {
            return Some(());
        }
        self.eval
            .findings
            .report(Diagnostic::new(Code::E0405, "expected a value above zero").label(span, "out of range"));
        None
    }

    fn malformed(&mut self, word: &Name) -> Option<(String, Values)> {
        let form = match word.text.as_str() {
            "steps" => "steps(20 .. 80 MN/m, by = 20 MN/m)` or `steps(20 .. 80 MN/m, count = 4)",
            "uniform" => "uniform(20 .. 80 MN/m)",
            "normal" => "normal(40 MN/m, sd = 5 MN/m)",
            _ => "log_normal(40 MN/m, cov = 20 %)",
        };
        self.eval.findings.report(
            Diagnostic::new(Code::E0406, format!("these are not the arguments of `{}`", word.text))
                .label(word.span, "not understood")
                .help(format!("write something like `{form}`")),
        );
        None
    }

    fn steps(
        &mut self,
        target: Varied,
        (from, to): (&Value, &Value),
        (how, step): (&Name, &Value),
        per: Option<&Name>,
        scope: ScopeId,
    ) -> Option<(String, Values)> {
        let (unit, [a, b]) = self.ends_of(target, from, to, per, scope)?;
        let size = unit_size(&unit)?;
        let raw =
            self.eval.raw(&with_unit(step, if how.text == "by" { unit_text(to) } else { None }.as_ref()), scope)?;
        let intervals = match how.text.as_str() {
            "by" => {
                let end = self.eval.ends(from, to, scope)?.1;
                if raw.dimension != end.dimension {
                    self.unlike(&raw, &end);
                    return None;
                }
                self.positive(raw.value, step.span)?;
                (b - a) / (raw.value / size)
            }
            "count" => raw.value - 1.0,
            _ => {
                self.malformed(&Name { text: "steps".into(), span: how.span });
                return None;
            }
        };
        let whole = intervals.round();
        if (intervals - whole).abs() > 1e-6 * whole.max(1.0) || !(1.0..MOST_STEPS).contains(&whole) {
            let message = format!("{} steps do not lead from {} to {} {unit}", number(intervals), number(a), number(b));
            self.eval.findings.report(
                Diagnostic::new(Code::E0706, message.trim_end().to_string())
                    .label(step.span, "not a whole number of steps")
                    .help("write `count = 5` for five values, both ends included"),
            );
            return None;
        }
        let span = from.span.to(to.span);
        let level = |i: usize| a + (b - a) * i as f64 / whole;
        let choice = |x: f64| Choice { text: with_suffix(x, &unit), number: Some(rounded(x)), span };
        Some((unit.clone(), Values::Listed((0..=whole as usize).map(|i| choice(level(i))).collect())))
    }
}

impl Suffix {
    fn text(&self) -> String {
        self.unit.as_ref().map_or(String::new(), |unit| format!(" {}", unit.text)) + &self.per_text()
    }

    fn per_text(&self) -> String {
        self.per.as_ref().map_or(String::new(), |per| format!(" per {}", per.text))
    }
}

/// A number as text: six digits.
fn rounded(x: f64) -> f64 {
    number(x).parse().unwrap_or(x)
}

/// `40 MN/m per seat`
fn with_suffix(x: f64, suffix: &str) -> String {
    format!("{} {suffix}", number(x)).trim_end().to_string()
}

/// Arguments without the basis that they all share: it may follow each of them or the whole.
fn bare(arguments: &[Argument], per: Option<&Name>) -> (Vec<Argument>, Option<Name>) {
    let mut per = per.cloned();
    let strip = |argument: &Argument| match &argument.value.kind {
        ValueKind::Per(inner, name) if per.get_or_insert_with(|| name.clone()).text == name.text => {
            Argument { name: argument.name.clone(), value: (**inner).clone() }
        }
        _ => argument.clone(),
    };
    let arguments = arguments.iter().map(strip).collect();
    (arguments, per)
}

fn wrapped(value: Value, per: Option<&Name>) -> Value {
    match per {
        Some(per) => {
            let span = value.span;
            Value { kind: ValueKind::Per(Box::new(value), per.clone()), span }
        }
        None => value,
    }
}

/// Whether the value is written as a number.
pub(super) fn is_number(value: &Value) -> bool {
    match &value.kind {
        ValueKind::Number { .. } => true,
        ValueKind::Negate(inner) | ValueKind::Per(inner, _) => is_number(inner),
        ValueKind::Binary(left, _, right) => is_number(left) && is_number(right),
        _ => false,
    }
}

/// Whether the unit after a list applies to this entry.
fn unit_of_all(value: &Value) -> bool {
    match &value.kind {
        ValueKind::Number { unit, .. } => unit.is_none(),
        ValueKind::Negate(inner) => unit_of_all(inner),
        ValueKind::Range(_, to) => unit_of_all(to),
        _ => false,
    }
}

/// The unit written in a number.
fn unit_text(value: &Value) -> Option<UnitText> {
    match &value.kind {
        ValueKind::Number { unit, .. } => unit.clone(),
        ValueKind::Negate(inner) | ValueKind::Per(inner, _) => unit_text(inner),
        ValueKind::Binary(left, _, right) => unit_text(left).or_else(|| unit_text(right)),
        _ => None,
    }
}

/// Text behind such a number: its unit and its basis.
fn suffix_of(value: &Value, raw: Option<&Raw>) -> String {
    let Some(raw) = raw else { return String::new() };
    let written = unit_text(value).map(|u| u.text).filter(|u| {
        let unit = parse_unit(u);
        unit.is_ok_and(|u| u.dimension == raw.dimension)
    });
    let unit = written.unwrap_or_else(|| raw.dimension.usual_unit());
    let per = match &value.kind {
        ValueKind::Per(_, per) => format!(" per {}", per.text),
        _ => raw.basis.as_ref().map_or(String::new(), |(name, _)| format!(" per {name}")),
    };
    (unit + &per).trim().to_string()
}

/// Size in SI of the unit in front of `per`.
pub(super) fn unit_size(suffix: &str) -> Option<f64> {
    let unit = match suffix.split_once("per ") {
        Some((unit, _)) => unit.trim(),
        None => suffix,
    };
    parse_unit(unit).ok().map(|u| u.factor)
}
