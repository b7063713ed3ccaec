//! Comparisons as written, with names replaced by their values.

use super::{Resolver, literal};
use crate::check::evaluate::number::Number;
use crate::check::evaluate::value::Val;
use crate::check::text::scope::ScopeId;
use crate::diag::Span;
use crate::scenario::response::Response;
use crate::schema::Form;
use crate::syntax::parse;
use crate::syntax::tree::{Item, Path, Value, ValueKind};

impl Resolver<'_, '_> {
    /// The comparison at a place of a file.
    pub(super) fn comparison(&mut self, span: Span) -> String {
        let scope = self.scope_of(span);
        let text = format!("let comparison = {}", self.eval.files.sources.text(span));
        let (tree, _) = parse(span.file, &text);
        match tree.items.first() {
            Some(Item::Let(binding)) => self.inline(&binding.value, scope),
            _ => self.eval.files.sources.text(span).to_string(),
        }
    }

    fn inline(&mut self, value: &Value, scope: ScopeId) -> String {
        match &value.kind {
            ValueKind::Number { value, unit } => {
                let digits = literal::plain(*value);
                unit.as_ref().map_or(digits.clone(), |unit| format!("{digits} {}", unit.text))
            }
            ValueKind::Text(text) => super::text::quoted(text),
            ValueKind::Path(path) => self.inline_path(path, scope),
            ValueKind::Call { word, arguments } => {
                let arguments: Vec<String> = arguments
                    .iter()
                    .map(|a| {
                        let value = self.inline(&a.value, scope);
                        a.name.as_ref().map_or(value.clone(), |name| format!("{} = {value}", name.text))
                    })
                    .collect();
                format!("{}({})", word.text, arguments.join(", "))
            }
            ValueKind::List { entries, unit } => {
                let items: Vec<String> = entries.iter().map(|e| self.inline(&e.value, scope)).collect();
                let unit = unit.as_ref().map_or(String::new(), |unit| format!(" {}", unit.text));
                format!("[{}]{unit}", items.join(", "))
            }
            ValueKind::Range(a, b) => format!("{} .. {}", self.inline(a, scope), self.inline(b, scope)),
            ValueKind::Per(inner, basis) => format!("{} per {}", self.inline(inner, scope), basis.text),
            ValueKind::Binary(a, op, b) => {
                let (a, b) = (operand(self.inline(a, scope)), operand(self.inline(b, scope)));
                format!("({a} {} {b})", op.symbol())
            }
            ValueKind::Negate(inner) => format!("-{}", operand(self.inline(inner, scope))),
            ValueKind::Compare { operands, operators } => {
                let operands: Vec<String> = operands.iter().map(|o| self.inline(o, scope)).collect();
                let rest = operands[1..].iter().zip(operators).map(|(o, op)| format!(" {} {o}", op.symbol()));
                std::iter::once(operands[0].clone()).chain(rest).collect()
            }
            // a comparison contains nothing else
            ValueKind::Object { .. } | ValueKind::Hole | ValueKind::Error => "?".into(),
        }
    }

    /// A response is kept, a `let` is replaced by its value, and any other name is a number in an object.
    fn inline_path(&mut self, path: &Path, scope: ScopeId) -> String {
        if path.names.len() == 1 && Response::of_name(&path.names[0].text).is_some() {
            return path.text();
        }
        // a name in a module, or a word such as the name of a transition
        if path.names.len() == 1 && !self.eval.scopes[scope].names.contains_key(&path.names[0].text) {
            return path.text();
        }
        let Some(target) = self.eval.resolve(path, scope, &[]) else { return path.text() };
        if target.is_let {
            let tree = self.eval.scopes[target.id.scope].tree.clone();
            let Item::Let(binding) = &tree.items[target.id.item] else { return path.text() };
            let value = self.inline(&binding.value, target.id.scope);
            // a value in brackets, or one word, needs no further brackets
            let alone = matches!(
                binding.value.kind,
                ValueKind::Number { .. } | ValueKind::Binary(..) | ValueKind::Call { .. } | ValueKind::Path(_)
            );
            return if alone { value } else { format!("({value})") };
        }
        match self.eval.slot_at(&target, path).map(|slot| slot.value) {
            Some(Val::Number(Number { value, dimension, basis, factor })) => {
                literal::number(Number { value, dimension, basis, factor }, &Form::Text)
            }
            _ => path.text(),
        }
    }

    fn scope_of(&self, span: Span) -> ScopeId {
        self.eval.scopes.iter().position(|scope| scope.tree.file == span.file).unwrap_or(self.eval.main)
    }
}

/// `per` applies to everything before it, so in arithmetic a value with `per` needs brackets.
fn operand(text: String) -> String {
    if text.contains(" per ") && !text.starts_with('(') { format!("({text})") } else { text }
}
