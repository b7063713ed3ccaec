//! Checked values as text of the language.

use super::Resolver;
use super::literal::{number, range};
use crate::check::evaluate::number::Number;
use crate::check::evaluate::shape::{Random, Reach, Shape, ShapeKind};
use crate::check::evaluate::value::{Slot, Val};
use crate::schema::{Field, Form, Word};
use crate::units::Dimension;
use std::collections::BTreeMap;

/// `"text"`, with escaped quotes and backslashes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

impl Resolver<'_, '_> {
    /// A value of a form.
    pub(super) fn value(&mut self, form: &'static Form, slot: &Slot) -> String {
        match &slot.value {
            Val::Number(n) => number(*n, form),
            Val::Text(text) if is_bare(form) => text.clone(),
            Val::Text(text) => quoted(text),
            Val::Word { word, arguments } => self.word(word, arguments),
            Val::Record(record) => self.object(record),
            Val::List(slots) => {
                let item = item_of(form);
                let items: Vec<String> = slots.iter().map(|slot| self.value(item, slot)).collect();
                listed(&items)
            }
            Val::Pairs(pairs) => {
                let (key, value) = pair_of(form);
                let pairs: Vec<String> =
                    pairs.iter().map(|(k, v)| format!("{}: {}", self.value(key, k), self.value(value, v))).collect();
                listed(&pairs)
            }
            Val::Range(a, b) => range(*a, *b, form),
            Val::Profile(shape) => self.profile(form, shape),
            Val::Response(response) => response.name().to_string(),
            Val::Written(..) if matches!(form, Form::Comparison) => self.comparison(slot.span),
            Val::Hole => "?".into(),
            // studies are left out, and a file without mistakes has no unreadable values
            Val::Written(..) | Val::Error => self.eval.files.sources.text(slot.span).to_string(),
        }
    }

    /// A word with all its arguments, defaults too, each by its name.
    fn word(&mut self, word: &'static Word, arguments: &BTreeMap<&'static str, Slot>) -> String {
        let inside = word.arguments.iter().filter(|a| a.name != "per");
        let given: Vec<String> = inside.filter_map(|a| self.argument(a, arguments)).collect();
        if let Some(Val::Text(of)) = arguments.get("per").map(|slot| &slot.value) {
            return format!("{}({}) per {of}", word.name, given.join(", "));
        }
        if given.is_empty() { word.name.to_string() } else { format!("{}({})", word.name, given.join(", ")) }
    }

    fn argument(&mut self, field: &'static Field, arguments: &BTreeMap<&'static str, Slot>) -> Option<String> {
        let slot = match (arguments.get(field.name), field.need) {
            (Some(slot), _) => slot.clone(),
            (None, crate::schema::Need::Default(text)) => self.eval.default_value(&field.form, text),
            (None, _) => return None,
        };
        Some(format!("{} = {}", field.name, self.value(&field.form, &slot)))
    }

    fn profile(&mut self, form: &'static Form, shape: &Shape) -> String {
        match &shape.kind {
            ShapeKind::Constant(n) => number(*n, form),
            ShapeKind::Ramp { from, to, smooth, over } => {
                let over = over.map_or(String::new(), |reach| format!(", over = {}", span(reach)));
                format!("{}({}{over})", if *smooth { "smooth" } else { "ramp" }, range(*from, *to, form))
            }
            ShapeKind::Points(points) => {
                let points: Vec<String> =
                    points.iter().map(|(at, _, n)| format!("{}: {}", place(*at), number(*n, form))).collect();
                listed(&points)
            }
            ShapeKind::Spans(spans) => {
                let spans: Vec<String> = spans
                    .iter()
                    .map(|(reach, inner)| format!("{}: {}", span(*reach), self.profile(form, inner)))
                    .collect();
                listed(&spans)
            }
            ShapeKind::Random(field) => random(field, form),
            ShapeKind::Table { column, rows, ends } => {
                let basis = rows.first().and_then(|(_, n)| n.basis).map_or(String::new(), |b| format!(" per {b}"));
                let file = quoted(&self.eval.files.sources.get(ends[0].file).name);
                // a column without a name is the only column and needs no name
                let named = column.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
                let column = if named { format!(", column = {column}") } else { String::new() };
                format!("file({file}{column}){basis}")
            }
        }
    }
}

/// The distribution and the stream of random values, so that the same values are drawn at any place.
fn random(field: &Random, form: &Form) -> String {
    let deviation = Number { value: field.deviation, ..field.mean };
    let metres = Number { value: field.correlation, dimension: Dimension::LENGTH, basis: None, factor: 1.0 };
    let seed = field.seed.map_or(String::new(), |seed| format!(", seed = {seed}"));
    format!(
        "random({}, sd = {}, correlation = {}, distribution = {}{seed}, stream = {})",
        number(field.mean, form),
        number(deviation, form),
        number(metres, &Form::Place),
        if field.log_normal { "log_normal" } else { "normal" },
        quoted(&field.path)
    )
}

fn place(at: Number) -> String {
    number(at, &Form::Place)
}

/// A span, or one sleeper.
fn span(reach: Reach) -> String {
    let single = reach.from.value == reach.to.value && reach.from.dimension == Dimension::SLEEPERS;
    if single { place(reach.from) } else { range(reach.from, reach.to, &Form::Span) }
}

/// `[a, b]`; over several lines if an item is. Each item has its own unit.
fn listed(items: &[String]) -> String {
    if items.iter().any(|item| item.contains('\n')) || items.iter().map(String::len).sum::<usize>() > 90 {
        return format!("[\n{}\n]", items.join("\n"));
    }
    format!("[{}]", items.join(", "))
}

fn is_bare(form: &Form) -> bool {
    match form {
        Form::Name | Form::Rule => true,
        Form::List(item) => is_bare(item),
        _ => false,
    }
}

fn item_of(form: &'static Form) -> &'static Form {
    match form {
        Form::List(item) => item,
        Form::OneOf(forms) => forms.iter().find(|f| matches!(f, Form::List(_))).map_or(form, item_of),
        other => other,
    }
}

fn pair_of(form: &'static Form) -> (&'static Form, &'static Form) {
    match form {
        Form::Pairs { key, value, .. } => (key, value),
        Form::OneOf(forms) => forms.iter().find(|f| matches!(f, Form::Pairs { .. })).map_or((form, form), pair_of),
        other => (other, other),
    }
}
