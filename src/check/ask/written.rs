//! The value of the scene itself at the path of an axis, shown beside the values of the points.

use super::expression::one_line;
use super::reader::Reader;
use super::vary::{is_number, unit_size};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::Span;
use crate::scenario::Written;
use crate::schema::Need;
use crate::syntax::tree::{Item, Name, Path};
use crate::units::{Dimension, parse_unit};

/// The value at the end of a path.
enum Said {
    /// A value of the scene or of a base.
    Here(Slot),
    /// The default of its field.
    Default(&'static str),
    /// Nothing: the part does not exist.
    Nothing,
}

impl Reader<'_, '_> {
    /// The value at a path of this file, which leads to a field or to a `let`. Mistakes are reported at their own
    /// place.
    pub(super) fn written(&mut self, path: &Path, unit: &str, scope: ScopeId) -> Option<Written> {
        let item = *self.eval.scopes[scope].names.get(&path.names[0].text)?;
        let id = ItemId { scope, item };
        let tree = self.eval.scopes[scope].tree.clone();
        if let Item::Let(binding) = &tree.items[item] {
            let before = self.eval.findings.diagnostics.len();
            let raw = if is_number(&binding.value) { self.eval.raw(&binding.value, scope) } else { None };
            self.eval.findings.diagnostics.truncate(before);
            let number = raw.map(|raw| (raw.value, raw.dimension));
            return Some(self.text_and_number(binding.value.span, number, unit));
        }
        match said(self.eval.known(id)?, &path.names[1..])? {
            Said::Here(slot) => {
                let number = if let Val::Number(n) = &slot.value { Some((n.value, n.dimension)) } else { None };
                Some(self.text_and_number(slot.span, number, unit))
            }
            Said::Default(text) => Some(Written { text: named(text), number: None }),
            Said::Nothing => Some(Written { text: named("none"), number: None }),
        }
    }

    /// The text of a value, and its number in the unit of the axis if both have the same basis.
    fn text_and_number(&self, span: Span, number: Option<(f64, Dimension)>, unit: &str) -> Written {
        let text = one_line(self.eval.files.sources.text(span));
        let (of, per) = split(unit);
        let same = |dimension: Dimension| {
            parse_unit(of).is_ok_and(|unit| unit.dimension == dimension) && split(&text).1 == per
        };
        let number = number.filter(|(_, dimension)| same(*dimension));
        let number = number.and_then(|(value, _)| Some(value / unit_size(unit)?));
        Written { number, text: named(&text) }
    }
}

/// A value as text for a table; an empty list is `none`.
fn named(text: &str) -> String {
    if text == "[]" { "none" } else { text }.to_string()
}

/// The text in front of `per`, and the basis behind it.
fn split(text: &str) -> (&str, &str) {
    text.split_once("per ").map_or((text.trim(), ""), |(before, per)| (before.trim(), per.trim()))
}

/// Follows fields into an object.
fn said(record: &Record, names: &[Name]) -> Option<Said> {
    let [name, rest @ ..] = names else { return None };
    match record.get(&name.text) {
        Some(slot) => inside(slot, rest),
        None => match record.kind.field(&name.text)?.need {
            Need::Default(text) if rest.is_empty() => Some(Said::Default(text)),
            _ => Some(Said::Nothing),
        },
    }
}

/// Follows names into a value: an object, the arguments of a word, or pairs by their keys.
fn inside(slot: &Slot, names: &[Name]) -> Option<Said> {
    let [name, rest @ ..] = names else { return Some(Said::Here(slot.clone())) };
    match &slot.value {
        Val::Record(record) => said(record, names),
        Val::Word { arguments, .. } => inside(arguments.get(name.text.as_str())?, rest),
        Val::Pairs(pairs) => {
            let called = |key: &Slot| matches!(&key.value, Val::Record(record) if record.name == name.text);
            inside(&pairs.iter().find(|(key, _)| called(key))?.1, rest)
        }
        _ => None,
    }
}
