//! The vocabulary as text: `trackbed docs` and `trackbed docs KIND`.

use super::{Field, Form, KINDS, Kind, Need, PLANNED_KINDS, Role, Varies, kinds::COMMON};
use crate::units::number;

/// One line a kind.
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

/// Everything about one kind.
pub fn page(kind: &Kind) -> String {
    let mut out = format!("{}\n\n{}\n\n", kind.name, kind.doc);
    for field in kind.fields.iter().chain(COMMON) {
        describe(&mut out, field, 2);
    }
    if let Some(changed) = kind.changes() {
        let names: Vec<&str> = changed.fields.iter().map(|f| f.name).collect();
        out.push_str(&format!(
            "  Any field or path of a {}: {}. `trackbed docs {0}` describes them.\n",
            changed.name,
            names.join(", ")
        ));
    }
    for alternative in kind.alternatives {
        let ways: Vec<String> = alternative.ways.iter().map(|way| format!("`{}`", way.join("` and `"))).collect();
        out.push_str(&format!("  Give {}", crate::diag::or_list(&ways)));
        match alternative.default {
            Some((field, value)) => out.push_str(&format!("; where none is given, `{field} = {value}`.\n")),
            None => out.push_str("; given together they must agree within 2 %.\n"),
        }
    }
    if !kind.planned.is_empty() {
        out.push_str(&format!("\n  Not in this version: {}.\n", kind.planned.join(", ")));
    }
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
    out.push_str(&format!("{pad}{:<24}{} ({need})\n", field.name, form(&field.form)));
    if !field.doc.is_empty() {
        out.push_str(&format!("{pad}{:<24}{}\n", "", field.doc));
    }
    for word in field.form.words().into_iter().filter(|w| !w.planned && !w.doc.is_empty()) {
        out.push_str(&format!("{pad}{:<24}`{}`: {}\n", "", word.name, word.doc));
        for argument in word.arguments {
            describe(out, argument, indent + 26);
        }
    }
}

fn form(form: &Form) -> String {
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
        Form::OneOf(forms) => forms.iter().map(self::form).collect::<Vec<_>>().join(" | "),
        Form::Words(words) => words.iter().filter(|w| !w.planned).map(|w| w.name).collect::<Vec<_>>().join(" | "),
        Form::List(item) => format!("[{}]", self::form(item)),
        Form::Pairs { key, value, .. } => format!("[{}: {}]", self::form(key), self::form(value)),
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
