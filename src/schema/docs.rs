//! The vocabulary as text: `trackbed docs` and `trackbed docs KIND`.

use super::{Field, Form, KINDS, Kind, Need, PLANNED_KINDS, Role, Varies, kinds::COMMON};
use crate::units::number;

/// One line for each kind.
pub fn index() -> String {
    let mut out = String::from("Kinds of declarations\n\n");
    for kind in KINDS.iter().filter(|k| k.role != Role::Nested) {
        out.push_str(&format!("  {:<10} {}\n", kind.name, kind.doc));
    }
    out.push_str("\nValues inside them\n\n");
    for kind in KINDS.iter().filter(|k| k.role == Role::Nested) {
        out.push_str(&format!("  {:<21} {}\n", kind.name, kind.doc));
    }
    if !PLANNED_KINDS.is_empty() {
        out.push_str(&format!("\nNot in this version: {}.\n", PLANNED_KINDS.join(", ")));
    }
    out
}

/// Everything about one kind, as a section of a Markdown page.
pub fn section(kind: &Kind) -> String {
    let mut out = format!("### `{}`\n\n{}\n\n", kind.name, kind.doc);
    out.push_str("| field | value | | meaning |\n|---|---|---|---|\n");
    for field in kind.fields {
        out.push_str(&row(field, &format!("`{}`", field.name)));
    }
    for field in kind.fields {
        for word in known_words(field) {
            for argument in word.arguments {
                out.push_str(&row(argument, &format!("`{}`: `{}({})`", field.name, word.name, argument.name)));
            }
        }
    }
    for paragraph in remarks(kind) {
        out.push_str(&format!("\n{paragraph}\n"));
    }
    out
}

/// A field as a row of a table: its name, form, need and meaning, and the meanings of its words.
fn row(field: &Field, name: &str) -> String {
    let words = known_words(field).filter(|w| !w.doc.is_empty()).map(|w| format!("`{}`: {}", w.name, w.doc));
    let docs = [field.doc, remark(field)].map(str::to_string);
    let meaning: Vec<String> = docs.into_iter().filter(|doc| !doc.is_empty()).chain(words).collect();
    let need = match field.need {
        Need::Required => "required".into(),
        Need::Optional | Need::Alternative => String::new(),
        Need::Default(text) => format!("default `{text}`"),
    };
    let cells = [name.to_string(), form_text(&field.form), need, meaning.join("; ")];
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}

/// The remark on a field that no run reads yet.
fn remark(field: &Field) -> &'static str {
    if field.unread { "not used by this version" } else { "" }
}

fn known_words(field: &Field) -> impl Iterator<Item = &'static super::Word> {
    field.form.words().into_iter().filter(|w| !w.planned)
}

/// Remarks on a kind: which kind it changes, which fields exclude each other, which fields are not read yet.
fn remarks(kind: &Kind) -> Vec<String> {
    let changed = kind.changes().map(|changed| {
        let names: Vec<&str> = changed.fields.iter().map(|f| f.name).collect();
        format!("Any field or path of a {}: {}. `trackbed docs {0}` describes them.", changed.name, names.join(", "))
    });
    let alternatives = kind.alternatives.iter().map(|alternative| {
        let ways: Vec<String> = alternative.ways.iter().map(|way| format!("`{}`", way.join("` and `"))).collect();
        let ways = crate::diag::or_list(&ways);
        match alternative.default {
            Some((field, value)) => format!("Give {ways}. If none is given, `{field} = {value}` is used."),
            None if alternative.exclusive => format!("Give exactly one: {ways}."),
            None => format!("Give {ways}. If both are given, they must agree within 2 %."),
        }
    });
    let planned = (!kind.planned.is_empty()).then(|| format!("Not in this version: {}.", kind.planned.join(", ")));
    changed.into_iter().chain(alternatives).chain(planned).collect()
}

/// Everything about one kind.
pub fn page(kind: &Kind) -> String {
    let mut out = format!("{}\n\n{}\n\n", kind.name, kind.doc);
    for field in kind.fields.iter().chain(COMMON) {
        describe(&mut out, field, 2);
    }
    for remark in remarks(kind) {
        out.push_str(&format!("  {remark}\n"));
    }
    out
}

/// Everything about one field.
pub fn field_page(kind: &Kind, field: &Field) -> String {
    let mut out = format!("{}.{}\n\n", kind.name, field.name);
    describe(&mut out, field, 2);
    out
}

fn describe(out: &mut String, field: &Field, indent: usize) {
    let pad = " ".repeat(indent);
    let need = match field.need {
        Need::Required => "required".into(),
        Need::Optional => "optional".into(),
        Need::Default(text) => format!("default {text}"),
        Need::Alternative => "see below".into(),
    };
    out.push_str(&format!("{pad}{:<24}{} ({need})\n", field.name, form_text(&field.form)));
    for text in [field.doc, remark(field)].into_iter().filter(|text| !text.is_empty()) {
        out.push_str(&format!("{pad}{:<24}{text}\n", ""));
    }
    for word in field.form.words().into_iter().filter(|w| !w.planned && !w.doc.is_empty()) {
        out.push_str(&format!("{pad}{:<24}`{}`: {}\n", "", word.name, word.doc));
        for argument in word.arguments {
            describe(out, argument, indent + 26);
        }
    }
}

/// The allowed values of a field in one line: `MN/m, 5 .. 3000`.
pub fn form_text(form: &Form) -> String {
    match form {
        Form::Number(m) | Form::Interval(m) => {
            let mut text = if m.unit.is_empty() { "number".to_string() } else { m.unit.to_string() };
            if let Some(basis) = m.basis {
                let names: Vec<String> = basis
                    .names
                    .iter()
                    .map(|(n, _)| format!("{n}{}", if basis.assumed == Some(n) { "*" } else { "" }))
                    .collect();
                text.push_str(&format!(" per {}", names.join(" | ")));
            }
            let along = if m.varies == Varies::Yes { ", may vary along the track" } else { "" };
            format!("{text}, {} .. {}{along}", number(m.min), number(m.max))
        }
        Form::Integer { min, max } => format!("whole number, {min} .. {max}"),
        Form::OneOf(forms) => forms.iter().map(form_text).collect::<Vec<_>>().join(" | "),
        Form::Words(words) => words.iter().filter(|w| !w.planned).map(|w| w.name).collect::<Vec<_>>().join(" | "),
        Form::List(item) => format!("[{}]", form_text(item)),
        Form::Pairs { key, value, .. } => format!("[{}: {}]", form_text(key), form_text(value)),
        Form::Object(kind) => (*kind).to_string(),
        Form::Text => "text".into(),
        Form::Name => "name of a transition".into(),
        Form::Place => "place in m or sleepers".into(),
        Form::Span => "span in m or sleepers".into(),
        Form::Response => "response".into(),
        Form::Rule => "physics rule".into(),
        Form::Comparison => "comparison".into(),
        Form::Expression => "expression of responses".into(),
        Form::Axes => "[path: list | range | steps | distribution]".into(),
        Form::Settings => "[path: value]".into(),
    }
}
