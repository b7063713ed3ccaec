//! What shipped files and defaults say of each field: the numbers from which most scenes are drawn.

use std::collections::HashMap;
use trackbed::diag::FileId;
use trackbed::schema::{self, Field, Form, KINDS, Kind, Measure, Need};
use trackbed::syntax::parse;
use trackbed::syntax::tree::{self, Item, Value, ValueKind};
use trackbed::units::{Dimension, parse_unit};

/// Smallest and largest number of each field, in the unit of its range, by its path: `pad.stiffness`,
/// `law.form.varandas.alpha`.
#[derive(Default)]
pub struct Typical(HashMap<String, [f64; 2]>);

impl Typical {
    /// Reads the defaults of all fields and these texts.
    pub fn read<'t>(texts: impl Iterator<Item = &'t str>) -> Typical {
        let mut typical = Typical::default();
        for kind in KINDS {
            typical.defaults(kind.name, kind.fields);
        }
        for text in texts {
            for item in parse(FileId(0), text).0.items {
                let Item::Declaration(declaration) = item else { continue };
                let Some(kind) = schema::kind(&declaration.kind.text) else { continue };
                typical.fields(kind, &declaration.fields);
            }
        }
        typical
    }

    /// The range in which a number usually lies: half of the smallest that is known, to twice the largest.
    pub fn range(&self, path: &str, measure: &Measure) -> Option<[f64; 2]> {
        let [low, high] = *self.0.get(path)?;
        let wide = if low < 0.0 || high == 0.0 { [low, high] } else { [low / 2.0, high * 2.0] };
        let range = wide.map(|x| x.clamp(measure.min, measure.max));
        (range[0] < range[1]).then_some(range)
    }

    fn defaults(&mut self, path: &str, fields: &'static [Field]) {
        for field in fields {
            let path = format!("{path}.{}", field.name);
            if let Need::Default(text) = field.need {
                let (tree, _) = parse(FileId(0), &format!("let it = {text}"));
                if let Some(Item::Let(given)) = tree.items.first() {
                    self.value(&path, &field.form, &given.value);
                }
            }
            for word in field.form.words() {
                self.defaults(&format!("{path}.{}", word.name), word.arguments);
            }
        }
    }

    fn fields(&mut self, kind: &'static Kind, fields: &[tree::Field]) {
        for field in fields {
            let (mut kind, mut names) = (kind, field.path.names.as_slice());
            // `pad.stiffness` of a trackform is a field of a pad
            while let [first, rest @ ..] = names {
                let Some(known) = kind.field(&first.text) else { break };
                if rest.is_empty() {
                    self.value(&format!("{}.{}", kind.name, first.text), &known.form, &field.value);
                    break;
                }
                let Some(inner) = object_kind(&known.form) else { break };
                (kind, names) = (inner, rest);
            }
        }
    }

    fn value(&mut self, path: &str, form: &'static Form, value: &Value) {
        match (form, &value.kind) {
            (Form::Number(measure) | Form::Interval(measure), _) => self.numbers(path, measure, value, ""),
            (Form::OneOf(forms), _) => forms.iter().for_each(|form| self.value(path, form, value)),
            (Form::Object(kind), ValueKind::Object { fields, .. }) => {
                if let Some(kind) = schema::kind(kind) {
                    self.fields(kind, fields);
                }
            }
            (Form::List(item), ValueKind::List { entries, .. }) => {
                entries.iter().for_each(|entry| self.value(path, item, &entry.value));
            }
            (Form::List(item), _) => self.value(path, item, value),
            (Form::Pairs { key, value: form, .. }, ValueKind::List { entries, .. }) => {
                for entry in entries {
                    self.value(path, form, &entry.value);
                    entry.key.iter().for_each(|given| self.value(&format!("{path}:key"), key, given));
                }
            }
            (Form::Words(words), ValueKind::Call { word, arguments }) => {
                let Some(known) = words.iter().find(|w| w.name == word.text) else { return };
                for (place, argument) in arguments.iter().enumerate() {
                    let named = |field: &&Field| argument.name.as_ref().is_some_and(|n| n.text == field.name);
                    let by_place = || known.arguments.get(place).filter(|_| argument.name.is_none());
                    let Some(field) = known.arguments.iter().find(named).or_else(by_place) else { continue };
                    self.value(&format!("{path}.{}.{}", word.text, field.name), &field.form, &argument.value);
                }
            }
            _ => {}
        }
    }

    /// Keeps the numbers of a value: one, the two of a range, or those of a profile.
    fn numbers(&mut self, path: &str, measure: &Measure, value: &Value, basis: &str) {
        match &value.kind {
            ValueKind::Number { value, unit } => {
                let Ok(unit) = parse_unit(unit.as_ref().map_or("", |unit| unit.text.as_str())) else { return };
                let Ok(own) = parse_unit(measure.unit) else { return };
                if unit.dimension != Dimension::of_unit(measure.unit) {
                    return;
                }
                let shares = measure.basis.and_then(|known| Some(known.factor(basis)? / known.names[0].1));
                self.keep(path, value * unit.factor / own.factor * shares.unwrap_or(1.0));
            }
            ValueKind::Per(inner, basis) => self.numbers(path, measure, inner, &basis.text),
            ValueKind::Negate(inner) => {
                let mut negative = Typical::default();
                negative.numbers(path, measure, inner, basis);
                negative.0.values().flatten().for_each(|x| self.keep(path, -x));
            }
            ValueKind::Range(from, to) => [from, to].into_iter().for_each(|x| self.numbers(path, measure, x, basis)),
            ValueKind::Call { arguments, .. } => {
                arguments.iter().for_each(|argument| self.numbers(path, measure, &argument.value, basis));
            }
            _ => {}
        }
    }

    fn keep(&mut self, path: &str, number: f64) {
        let range = self.0.entry(path.to_string()).or_insert([number; 2]);
        *range = [range[0].min(number), range[1].max(number)];
    }
}

/// The kind of the objects that may stand there.
pub fn object_kind(form: &'static Form) -> Option<&'static Kind> {
    match form {
        Form::Object(name) => schema::kind(name),
        Form::OneOf(forms) => forms.iter().find_map(object_kind),
        _ => None,
    }
}
