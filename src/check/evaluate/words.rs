//! Words of a field: enumerations, variants with arguments, responses and rules.

use super::evaluator::Evaluator;
use super::value::{Slot, Val};
use super::written::bare;
use crate::check::text::scope::ScopeId;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Help, or_list};
use crate::scenario::response::Response;
use crate::schema::{Form, Names, Word, called};
use crate::syntax::tree::{Argument, Name, ValueKind};
use std::collections::BTreeMap;

impl Evaluator<'_> {
    /// The response of that name.
    pub fn response(&mut self, name: &Name) -> Option<Response> {
        let found = Response::of_name(&name.text);
        if found.is_none() {
            let names = || Response::ALL.iter().map(|r| r.name());
            let near = called(Names::Responses, &name.text, names()).or_else(|| nearest(&name.text, names()));
            let help = near.map_or_else(
                || {
                    let all: Vec<&str> = Response::ALL.iter().map(|r| r.name()).collect();
                    Help::say(format!("the responses are {}", all.join(", ")))
                },
                Help::meant,
            );
            self.findings.report(
                Diagnostic::new(Code::E0408, format!("no response is called `{}`", name.text))
                    .label(name.span, "unknown")
                    .advise(name.span, help),
            );
        }
        found
    }

    /// The name of a physics rule.
    pub(super) fn rule(&mut self, name: &Name) -> Option<Val> {
        if Code::of_rule(&name.text).is_some() {
            return Some(Val::Text(name.text.clone()));
        }
        let rules: Vec<&str> = Code::ALL.iter().filter_map(|c| c.rule()).collect();
        let by_code = Code::ALL.iter().find(|c| c.to_string() == name.text).and_then(|c| c.rule());
        let help = by_code
            .or_else(|| nearest(&name.text, rules.iter().copied()))
            .map_or_else(|| Help::say(format!("the rules are {}", rules.join(", "))), Help::meant);
        self.findings.report(
            Diagnostic::new(Code::E0408, format!("no rule is called `{}`", name.text))
                .label(name.span, "unknown")
                .advise(name.span, help),
        );
        None
    }

    /// Refuses a word that a form does not know.
    pub(super) fn unknown_word(&mut self, name: &Name, words: &[&'static Word]) {
        let known: Vec<&str> = words.iter().filter(|w| !w.planned).map(|w| w.name).collect();
        let near = called(Names::Words, &name.text, known.iter().copied());
        let near = near.or_else(|| nearest(&name.text, known.iter().copied()));
        let quoted: Vec<String> = known.iter().map(|w| format!("`{w}`")).collect();
        self.findings.report(
            Diagnostic::new(Code::E0408, format!("expected {}, found `{}`", or_list(&quoted), name.text))
                .label(name.span, "unknown word")
                .maybe_meant(name.span, near),
        );
    }

    /// A word with its arguments, by place or by name.
    pub fn word(&mut self, word: &'static Word, arguments: &[Argument], name: &Name, scope: ScopeId) -> Option<Val> {
        if word.planned {
            self.findings.report(
                Diagnostic::new(Code::E0411, format!("this version does not know `{}` yet", word.name))
                    .label(name.span, "planned"),
            );
            return None;
        }
        if let (Some(Form::Interval(_)), [first, second, ..]) = (word.arguments.first().map(|a| &a.form), arguments)
            && [first, second]
                .iter()
                .all(|a| a.name.is_none() && matches!(bare(&a.value).0.kind, ValueKind::Number { .. }))
        {
            let [from, to] = [first, second].map(|a| self.files.sources.text(bare(&a.value).0.span));
            let place = first.value.span.to(second.value.span);
            let help = Help::write(format!("{from} .. {to}")).after("from one to the other: ");
            self.findings.report(
                Diagnostic::new(
                    Code::E0406,
                    format!("the first argument of `{}` is a range, found two numbers", word.name),
                )
                .label(place, "two numbers")
                .advise(place, help),
            );
            return None;
        }
        let mut slots = BTreeMap::new();
        // unreadable text may continue into the next argument
        let mut unknown = arguments.iter().any(|argument| argument.value.kind == ValueKind::Error);
        for (i, argument) in arguments.iter().enumerate() {
            let field = match &argument.name {
                Some(name) => word.arguments.iter().find(|a| a.name == name.text),
                None => word.arguments.get(i),
            };
            let Some(field) = field else {
                let names: Vec<String> = word.arguments.iter().map(|a| format!("`{}`", a.name)).collect();
                let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
                let known = word.arguments.iter().map(|a| a.name).chain((word.name == "random").then_some("sd"));
                let near = argument.name.as_ref().and_then(|n| called(Names::Fields, &n.text, known));
                let help = match near {
                    Some(near) => Help::meant(near),
                    None if names.is_empty() => Help::say("it takes no arguments"),
                    None => Help::say(format!("it takes {}", or_list(&names))),
                };
                self.findings.report(
                    Diagnostic::new(Code::E0402, format!("`{}` has no such argument", word.name))
                        .label(place, "unknown argument")
                        .advise(place, help),
                );
                unknown = true;
                continue;
            };
            let around = self.asked.take();
            let slot = self.fit(&field.form, &argument.value, scope);
            self.asked = around;
            if slots.insert(field.name, slot).is_some() {
                self.findings.report(
                    Diagnostic::new(Code::E0404, format!("`{}` of `{}` is given twice", field.name, word.name))
                        .label(argument.value.span, "again here"),
                );
            }
        }
        if unknown {
            // it may be a misspelt argument that seems to be missing
            let origin = self.origin(name.span, scope);
            for argument in word.arguments {
                slots.entry(argument.name).or_insert(Slot { value: Val::Error, span: name.span, origin });
            }
        }
        Some(Val::Word { word, arguments: slots })
    }
}
