//! Completes an object: adds defaults for fields that are not given, and reports required fields that are missing.

use super::evaluator::Evaluator;
use super::value::{Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Fix, Span, or_list};
use crate::schema::{Alternative, Field, Form, Need};
use crate::syntax::tree::{Item, Value};
use std::rc::Rc;

impl Evaluator<'_> {
    /// The record with every default, also in the objects inside it.
    pub fn complete(&mut self, record: &Record) -> Record {
        let mut full = record.clone();
        for field in record.kind.fields {
            if let Some(slot) = full.fields.get_mut(field.name) {
                self.complete_slot(slot);
                continue;
            }
            match field.need {
                Need::Required => self.missing(&full, &format!("`{}`", field.name)),
                Need::Default(text) => {
                    let slot = self.default_slot(field, text);
                    full.fields.insert(field.name, slot);
                }
                Need::Optional | Need::Alternative => {}
            }
        }
        for alternative in record.kind.alternatives {
            self.complete_alternative(&mut full, alternative);
        }
        full
    }

    /// Puts defaults into the value of a slot.
    pub(super) fn complete_slot(&mut self, slot: &mut Slot) {
        match &mut slot.value {
            Val::Record(inner) => *inner = Rc::new(self.complete(inner)),
            Val::Word { word, arguments } => {
                arguments.values_mut().for_each(|argument| self.complete_slot(argument));
                let mut missing = Vec::new();
                for argument in word.arguments {
                    if arguments.contains_key(argument.name) {
                        continue;
                    }
                    match argument.need {
                        Need::Default(text) => {
                            let slot = self.default_slot(argument, text);
                            arguments.insert(argument.name, slot);
                        }
                        Need::Required => missing.push(argument.name),
                        Need::Optional | Need::Alternative => {}
                    }
                }
                if !missing.is_empty() {
                    let (what, names) = (missing.join("` and `"), missing.join(" = ..., "));
                    self.findings.report(
                        Diagnostic::new(Code::E0403, format!("`{}` needs `{what}`", word.name))
                            .label(slot.span, format!("without `{what}`"))
                            .help(format!("write `{}({names} = ...)`", word.name)),
                    );
                }
            }
            Val::List(slots) => slots.iter_mut().for_each(|s| self.complete_slot(s)),
            Val::Pairs(pairs) => pairs.iter_mut().for_each(|(k, v)| {
                self.complete_slot(k);
                self.complete_slot(v);
            }),
            _ => {}
        }
    }

    fn complete_alternative(&mut self, record: &mut Record, alternative: &'static Alternative) {
        let given = |path: &&str| record.slot(path).is_some() || hidden_by_error(record, path);
        if alternative.exclusive {
            self.one_way(record, alternative);
        }
        if alternative.ways.iter().any(|way| way.iter().all(given)) {
            return;
        }
        match alternative.default {
            Some((name, text)) => {
                if let Some(field) = record.kind.field(name) {
                    let slot = self.default_slot(field, text);
                    record.fields.insert(field.name, slot);
                }
            }
            None => {
                let ways: Vec<String> =
                    alternative.ways.iter().map(|way| format!("`{}`", way.join("` and `"))).collect();
                self.missing(record, &or_list(&ways));
            }
        }
    }

    /// Refuses two ways of giving the same quantity.
    fn one_way(&mut self, record: &Record, alternative: &'static Alternative) {
        let fields = alternative.ways.iter().flat_map(|way| way.iter());
        let given: Vec<(&str, Span)> = fields.filter_map(|path| Some((*path, record.slot(path)?.span))).collect();
        if let [(first, one), (second, other), ..] = given[..] {
            self.findings.report(
                Diagnostic::new(Code::E0404, format!("`{first}` and `{second}` give the same quantity in two ways"))
                    .label(other, "")
                    .label(one, "")
                    .help("keep one of the two"),
            );
        }
    }

    fn missing(&mut self, record: &Record, what: &str) {
        let who = if record.name == record.kind.name {
            format!("this {}", record.kind.name)
        } else {
            format!("{} `{}`", record.kind.name, record.name)
        };
        let mistake = Diagnostic::new(Code::E0403, format!("{who} needs {what}"))
            .label(record.span, "not given")
            .help(format!("`trackbed docs {}` explains the field", record.kind.name))
            .maybe_fix(self.hole(record, what));
        record.lacks(what, mistake, &mut self.findings);
    }

    /// A line for a missing field, with a hole, behind the bracket that opens the object.
    fn hole(&self, record: &Record, what: &str) -> Option<Fix> {
        let field = what.trim_matches('`');
        let source = self.files.sources.get(record.span.file);
        if field.contains('`') || source.library || record.span.start == record.span.end {
            return None;
        }
        let whole = source.text.get(record.span.start as usize..record.span.end as usize)?;
        let (from, header) = match whole.find('{') {
            Some(n) => (record.span.start as usize + n, ""),
            None => {
                let rest = source.text.get(record.span.end as usize..)?;
                let n = rest.find('{')?;
                (record.span.end as usize + n, &rest[..n])
            }
        };
        // only names and a colon are allowed between a header and its bracket
        let plain = header.chars().all(|c| c.is_alphanumeric() || c.is_whitespace() || "_.:".contains(c));
        let place = Span::new(record.span.file, from + 1, from + 1);
        let empty = source.text[from + 1..].trim_start().starts_with('}');
        let text = if empty { format!(" {field} = ? ") } else { format!(" {field} = ?,") };
        plain.then(|| Fix::replace(place, text).titled(format!("add `{field} = ?`")))
    }

    fn default_slot(&mut self, field: &'static Field, text: &'static str) -> Slot {
        let mut slot = self.default_value(&field.form, text);
        self.complete_slot(&mut slot);
        slot
    }

    /// A default, written in the language, read like everything else.
    pub fn default_value(&mut self, form: &'static Form, text: &'static str) -> Slot {
        let value = self.default_text(text);
        self.fit(form, &value, self.standard)
    }

    fn default_text(&mut self, text: &'static str) -> Rc<Value> {
        if let Some(known) = self.defaults.get(text) {
            return known.clone();
        }
        let source = format!("let default = {text}");
        let file = self.files.sources.add("default", source.as_str(), true);
        let tree = self.files.modules.parsed(file, &source).tree;
        let value = match tree.items.first() {
            Some(Item::Let(binding)) => binding.value.clone(),
            _ => Value { kind: crate::syntax::tree::ValueKind::Error, span: Span::new(file, 0, 0) },
        };
        let value = Rc::new(value);
        self.defaults.insert(text, value.clone());
        value
    }
}

/// Whether a part of a path could not be understood, so that its value is unknown.
fn hidden_by_error(record: &Record, path: &str) -> bool {
    record.unknown(path)
        || path.split_once('.').is_some_and(|(first, _)| record.get(first).is_none() || record.unknown(first))
}
