//! Lists of pairs, `[key: value]`: checks each side against its form, and helps if keys are missing or swapped with
//! values.

use super::evaluator::Evaluator;
use super::fit::form_has_numbers;
use super::value::{Slot, Val};
use super::written::with_unit;
use crate::check::text::scope::ScopeId;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::Origin;
use crate::schema::Form;
use crate::syntax::tree::{Entry, Value, ValueKind};

impl Evaluator<'_> {
    /// The pairs of a list, each side checked against its own form.
    pub(super) fn pairs(&mut self, form: &'static Form, value: &Value, scope: ScopeId) -> Option<Val> {
        let Form::Pairs { key, value: content, implied } = form else { return None };
        let alone;
        let (entries, unit) = match &value.kind {
            ValueKind::List { entries, unit } => (entries.as_slice(), unit.as_ref()),
            _ => {
                alone = [Entry { key: None, value: value.clone() }];
                (alone.as_slice(), None)
            }
        };
        if let Some(swapped) = self.swapped(key, entries) {
            self.findings.report(
                Diagnostic::new(Code::E0406, format!("expected {}", form.describe()))
                    .label(value.span, "keys and values are swapped")
                    .write(value.span, swapped),
            );
            return None;
        }
        let mut pairs = Vec::with_capacity(entries.len());
        let before = self.findings.diagnostics.len();
        let mut lone = false;
        for entry in entries {
            let pair = match (&entry.key, implied) {
                (Some(k), _) => (self.fit(key, k, scope), self.fit(content, &with_unit(&entry.value, unit), scope)),
                (None, Some(_)) if entry.value.kind == ValueKind::Error => {
                    let nothing = Slot { value: Val::Error, span: entry.value.span, origin: Origin::Derived };
                    (nothing.clone(), nothing)
                }
                (None, Some(text)) => (self.fit(key, &entry.value, scope), self.default_value(content, text)),
                (None, None) => {
                    // unreadable text behind it may have been the other half
                    let rest =
                        |s: &Span| s.file == entry.value.span.file && s.start.abs_diff(entry.value.span.end) <= 1;
                    let torn = self.unreadable.iter().any(rest) || entry.value.kind == ValueKind::Error;
                    if !torn && !lone {
                        self.superseded.push(value.span);
                        self.findings.report(
                            Diagnostic::new(Code::E0406, format!("expected {}", form.describe()))
                                .label(entry.value.span, "a pair is needed here")
                                .help(self.as_pairs(key, content, entries)),
                        );
                    }
                    // such a list is reported once
                    lone = true;
                    let nothing = Slot { value: Val::Error, span: entry.value.span, origin: Origin::Derived };
                    (nothing.clone(), nothing)
                }
            };
            pairs.push(pair);
        }
        self.one_missing_unit(before, entries);
        Some(Val::Pairs(pairs))
    }

    /// A list with numbers as keys and names as values, with keys and values swapped.
    fn swapped(&self, key: &Form, entries: &[Entry]) -> Option<String> {
        let number = |value: &Value| matches!(value.kind, ValueKind::Number { .. });
        let name = |value: &Value| matches!(value.kind, ValueKind::Path(_));
        let turned = |e: &Entry| e.key.as_ref().is_some_and(number) && name(&e.value);
        if form_has_numbers(key) || entries.is_empty() || !entries.iter().all(turned) {
            return None;
        }
        let text = |value: &Value| self.files.sources.text(value.span);
        let pair = |e: &Entry| Some(format!("{}: {}", text(&e.value), text(e.key.as_ref()?)));
        Some(format!("[{}]", entries.iter().map(pair).collect::<Option<Vec<_>>>()?.join(", ")))
    }

    /// Help to turn the entries of a list without keys into pairs.
    fn as_pairs(&self, key: &Form, content: &Form, entries: &[Entry]) -> String {
        let text = |e: &Entry| self.files.sources.text(e.value.span);
        let names = entries.iter().all(|e| e.key.is_none() && matches!(e.value.kind, ValueKind::Path(_)));
        match entries {
            [only] if matches!(key, Form::Name) && content.word(text(only)).is_some() => {
                format!("it needs a name: write `[edge: {}]`", text(only))
            }
            [_, _, ..] if names => {
                let pairs: Vec<String> = entries.iter().map(|e| format!("{}: ...", text(e))).collect();
                format!("each needs a value: write `[{}]`", pairs.join(", "))
            }
            _ => "write `[key: value]`".to_owned(),
        }
    }
}
