//! Values as text, before any field reads them: their kind, and whether they are profiles.

use crate::diag::Span;
use crate::syntax::tree::{UnitText, Value, ValueKind};

/// `per` after a profile, with its place: it holds for every value in it.
pub type Per = Option<(String, Span)>;

/// Words that begin a profile.
pub const PROFILES: [&str; 4] = ["ramp", "smooth", "random", "file"];

/// The value without the `per` around it.
pub fn bare(value: &Value) -> (&Value, Per) {
    match &value.kind {
        ValueKind::Per(inner, name) => (inner, Some((name.text.clone(), name.span))),
        _ => (value, None),
    }
}

/// Whether a value is written as a profile.
pub(super) fn is_profile(value: &Value) -> bool {
    match &bare(value).0.kind {
        ValueKind::Call { word, .. } => PROFILES.contains(&word.text.as_str()),
        ValueKind::List { entries, .. } => entries.iter().any(|e| e.key.is_some()),
        _ => false,
    }
}

/// Gives the unit after a list to a bare number in it.
pub fn with_unit(value: &Value, unit: Option<&UnitText>) -> Value {
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

/// The kind of a value, for a message.
pub fn looks_like(kind: &ValueKind) -> &'static str {
    match kind {
        ValueKind::Number { .. } | ValueKind::Binary(..) | ValueKind::Negate(_) | ValueKind::Per(..) => "a number",
        ValueKind::Text(_) => "text",
        ValueKind::Hole => "a hole",
        ValueKind::List { .. } => "a list",
        ValueKind::Call { .. } => "a word with arguments",
        ValueKind::Object { .. } => "an object",
        ValueKind::Path(_) => "a name",
        ValueKind::Range(..) => "a range",
        ValueKind::Compare { .. } => "a comparison",
        ValueKind::Error => "something unreadable",
    }
}
