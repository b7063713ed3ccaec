//! Completion at the cursor: kinds, fields, words, fitting units, entries of the library with their numbers, names of
//! the scene.

use super::context::{Stand, Wanted, context};
use super::forms::{fields, follow, has, object_kind, object_kinds, pair_forms};
use super::hover;
use super::marks::is_asking;
use super::names::{kind_of, name_of};
use super::view::View;
use crate::check::{ItemId, ScopeId};
use crate::diag::Code;
use crate::scenario::response::Response;
use crate::schema::{self, Field, Form, KINDS, Kind, Measure, RANDOM, Role, Varies, Word};
use crate::syntax::tree::{Declaration, Item, ValueKind};
use crate::units::{Dimension, usual_units};
use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionTextEdit, Documentation, MarkupContent, MarkupKind, Position, Range,
    TextEdit,
};

/// Completions at an offset.
pub fn completion(view: &View, cursor: usize) -> Vec<CompletionItem> {
    let found = context(&view.text, cursor);
    let range = view.lines.range(&view.text, found.start, found.end);
    let mut offers = Offers { view, range, items: Vec::new() };
    match &found.stand {
        Stand::Item => offers.items_of_file(),
        Stand::Module(names) => offers.modules(names),
        Stand::Base(kind, names) => offers.objects(&[kind], names),
        Stand::Field(kind, names, given) => offers.fields(kind, names, given),
        Stand::Value(wanted, names) if names.is_empty() => offers.value(*wanted),
        Stand::Value(wanted, names) => offers.inside(*wanted, names),
        Stand::Unit(wanted) => offers.units(*wanted),
        Stand::Basis(wanted) => offers.bases(*wanted),
        Stand::Argument(word, wanted) => offers.arguments(word, *wanted),
        Stand::ScenePath(names) => offers.scene_path(names),
        Stand::Nothing => {}
    }
    offers.ordered()
}

struct Offers<'v> {
    view: &'v View,
    /// The range that an offer replaces.
    range: Range,
    items: Vec<CompletionItem>,
}

impl Offers<'_> {
    fn add(&mut self, label: &str, kind: CompletionItemKind, detail: &str, documentation: &str) -> &mut CompletionItem {
        self.insert(label, label, kind, detail, documentation)
    }

    fn insert(
        &mut self,
        label: &str,
        text: &str,
        kind: CompletionItemKind,
        detail: &str,
        documentation: &str,
    ) -> &mut CompletionItem {
        let markdown = |value: &str| {
            Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value: value.to_owned() })
        };
        self.items.push(CompletionItem {
            label: label.to_owned(),
            kind: Some(kind),
            detail: Some(detail.to_owned()).filter(|detail| !detail.is_empty()),
            documentation: (!documentation.is_empty()).then(|| markdown(documentation)),
            text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(self.range, text.to_owned()))),
            filter_text: Some(label.to_owned()),
            ..CompletionItem::default()
        });
        let last = self.items.len() - 1;
        &mut self.items[last]
    }

    /// The offers in their order, without duplicates.
    fn ordered(mut self) -> Vec<CompletionItem> {
        let mut seen = std::collections::BTreeSet::new();
        self.items.retain(|item| seen.insert(item.label.clone()));
        for (place, item) in self.items.iter_mut().enumerate() {
            item.sort_text = Some(format!("{place:04}"));
        }
        self.items
    }

    fn items_of_file(&mut self) {
        for kind in KINDS.iter().filter(|kind| kind.role != Role::Nested) {
            self.add(kind.name, CompletionItemKind::CLASS, "kind", kind.doc);
        }
        self.add("let", CompletionItemKind::KEYWORD, "gives a value a name", "");
        self.add("use", CompletionItemKind::KEYWORD, "imports a module", "");
    }

    fn modules(&mut self, names: &[String]) {
        let standard = &self.view.survey.files.scopes[self.view.survey.files.standard];
        let modules: Vec<String> = standard.modules.keys().cloned().collect();
        match names {
            [] => {
                self.add("std", CompletionItemKind::MODULE, "the standard library", &modules.join(", "));
                modules.iter().for_each(|module| {
                    self.add(
                        &format!("std.{module}"),
                        CompletionItemKind::MODULE,
                        "module of the standard library",
                        "",
                    );
                });
                self.files("");
            }
            [std] if std == "std" => modules.iter().for_each(|module| {
                self.add(module, CompletionItemKind::MODULE, "module of the standard library", "");
            }),
            _ => self.files(&names.join("/")),
        }
    }

    /// Modules in files in the folder of the scene or below it.
    fn files(&mut self, below: &str) {
        let Some(folder) = &self.view.places.folder else { return };
        let Ok(entries) = std::fs::read_dir(folder.join(below)) else { return };
        let mut names: Vec<String> =
            entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).take(500).collect();
        names.sort();
        let own = self.view.places.main.path().rsplit('/').next().unwrap_or_default().to_owned();
        for name in names.iter().filter(|name| **name != own) {
            if let Some(module) = name.strip_suffix(".track") {
                self.add(module, CompletionItemKind::FILE, "file", "");
            }
        }
    }

    /// Fields of a kind that are not yet given in the block.
    fn fields(&mut self, kind: &'static Kind, names: &[String], given: &[String]) {
        let path: Vec<&str> = names.iter().map(String::as_str).collect();
        let (kind, whole) = match follow(kind, &path) {
            None if names.is_empty() => (kind, true),
            Some((_, field)) => match object_kind(&field.form) {
                Some(inner) => (inner, false),
                None => return self.inside_field(field),
            },
            None => return,
        };
        let prefix = if whole { String::new() } else { format!("{}.", names.join(".")) };
        let next = self.view.text[self.view.lines.offset(&self.view.text, self.range.end)..].trim_start_matches(' ');
        let ending = if next.starts_with(['=', '.']) { "" } else { " = " };
        for field in fields(kind).filter(|field| !given.contains(&format!("{prefix}{}", field.name))) {
            let text = format!("{}{ending}", field.name);
            let detail = hover::form_and_need(field);
            let item = self.insert(field.name, &text, CompletionItemKind::FIELD, &detail, &hover::field_meaning(field));
            // required fields come first
            item.preselect = Some(field.need == schema::Need::Required && whole).filter(|first| *first);
        }
        let required = |item: &CompletionItem| item.preselect != Some(true);
        self.items.sort_by_key(required);
        self.items.iter_mut().for_each(|item| item.preselect = None);
    }

    /// Arguments of a word, after `form.` and `sections.`.
    fn inside_field(&mut self, field: &'static Field) {
        for word in field.form.words() {
            for argument in word.arguments {
                let text = format!("{} = ", argument.name);
                let detail = format!("{} of {}", hover::form_and_need(argument), word.name);
                self.insert(argument.name, &text, CompletionItemKind::FIELD, &detail, argument.doc);
            }
        }
    }

    fn value(&mut self, wanted: Wanted) {
        let Some(form) = wanted.form else {
            self.lets();
            return self.objects(&[], &[]);
        };
        if let Some(schema::Need::Default(text)) = wanted.field.map(|field| field.need)
            && wanted.field.is_some_and(|field| std::ptr::eq(&field.form, form))
        {
            self.add(text, CompletionItemKind::VALUE, "default", "");
        }
        self.words(form);
        let key = pair_forms(form).filter(|_| !has(form, |f| matches!(f, Form::Number(_))));
        let kinds = object_kinds(key.map_or(form, |(key, _)| key));
        let kinds: Vec<&'static Kind> = kinds.into_iter().chain(list_kinds(form)).collect();
        if !kinds.is_empty() {
            self.objects(&kinds, &[]);
        }
        if has(form, is_asking) {
            self.asking(form);
        }
        if has(form, |form| matches!(form, Form::Rule)) || key.is_some_and(|(key, _)| matches!(key, Form::Rule)) {
            for code in Code::ALL {
                if let Some(rule) = code.rule() {
                    self.add(rule, CompletionItemKind::ENUM_MEMBER, code.as_str(), code.title());
                }
            }
        }
        if has(form, |form| matches!(form, Form::Name)) {
            self.transitions();
        }
        if let Some(measure) = form.measure() {
            self.lets();
            self.profiles(measure);
        }
    }

    fn words(&mut self, form: &'static Form) {
        for word in form.words().into_iter().filter(|word| !word.planned) {
            self.word(word);
        }
    }

    fn word(&mut self, word: &'static Word) {
        let documentation = hover::word_meaning(word);
        let kind =
            if word.arguments.is_empty() { CompletionItemKind::ENUM_MEMBER } else { CompletionItemKind::FUNCTION };
        let detail = if word.arguments.is_empty() { String::new() } else { hover::signature(word) };
        self.add(word.name, kind, &detail, &documentation);
    }

    /// Objects of these kinds (of all kinds if `kinds` is empty) from the scene, its modules and the standard library.
    fn objects(&mut self, kinds: &[&'static Kind], names: &[String]) {
        let files = &self.view.survey.files;
        if let [module, ..] = names {
            let standard = || files.scopes[files.standard].modules.get(module);
            if let Some(scope) = files.scopes[files.main].modules.get(module).or_else(standard) {
                self.declared(*scope, kinds, "");
            }
            return;
        }
        self.declared(files.main, kinds, "");
        let mut modules: Vec<(&String, ScopeId, bool)> =
            files.scopes[files.main].modules.iter().map(|(name, scope)| (name, *scope, true)).collect();
        let standard = files.scopes[files.standard].modules.iter();
        let missing = standard.filter(|(name, scope)| {
            let named = files.scopes[files.main].modules.contains_key(*name);
            !named && !modules.iter().any(|(_, known, _)| known == *scope)
        });
        let missing: Vec<_> = missing.map(|(name, scope)| (name, *scope, false)).collect();
        modules.extend(missing);
        for (module, scope, known) in modules {
            let from = self.items.len();
            self.declared(scope, kinds, &format!("{module}."));
            if !known {
                let line = self.use_line();
                self.items[from..].iter_mut().for_each(|item| item.additional_text_edits = Some(vec![line.clone()]));
            }
        }
    }

    /// The edit that imports the standard library.
    fn use_line(&self) -> TextEdit {
        let start = self.view.tree().items.first().map_or(0, |item| match item {
            Item::Use(used) => used.span.start,
            Item::Let(binding) => binding.span.start,
            Item::Declaration(d) => d.span.start,
        });
        let mut position = self.view.lines.position(&self.view.text, start as usize);
        // the doc comments of the first declaration stay directly above it
        let docs = |line: u32| {
            let start = self.view.lines.offset(&self.view.text, Position::new(line, 0));
            self.view.text[start..].starts_with("///")
        };
        position.character = 0;
        while position.line > 0 && docs(position.line - 1) {
            position.line -= 1;
        }
        TextEdit::new(Range::new(position, position), "use std\n".to_owned())
    }

    fn declared(&mut self, scope: ScopeId, kinds: &[&'static Kind], prefix: &str) {
        let items = &self.view.survey.files.scopes[scope].tree.items;
        for (item, thing) in items.iter().enumerate() {
            let Item::Declaration(declaration) = thing else { continue };
            let kind = kind_of(declaration);
            let fits = kinds.is_empty() || kind.is_some_and(|kind| kinds.iter().any(|k| k.name == kind.name));
            let (name, _) = name_of(thing);
            if !fits || name.is_empty() {
                continue;
            }
            let numbers = self.numbers(declaration, ItemId { scope, item });
            let documentation = hover::declared(self.view, ItemId { scope, item });
            let detail = format!("{}: {numbers}", declaration.kind.text);
            self.add(&format!("{prefix}{name}"), CompletionItemKind::VARIABLE, &detail, &documentation);
        }
    }

    /// The numbers of a declaration in one line.
    fn numbers(&self, declaration: &Declaration, id: ItemId) -> String {
        let file = self.view.survey.files.scopes[id.scope].tree.file;
        let text = &self.view.source(file).text;
        let number = |field: &crate::syntax::tree::Field| {
            let written = text.get(field.value.span.start as usize..field.value.span.end as usize)?;
            let is_number = matches!(field.value.kind, ValueKind::Number { .. } | ValueKind::Per(..));
            is_number.then(|| format!("{} {written}", field.path.text().replace('_', " ")))
        };
        let said: Vec<String> = declaration.fields.iter().filter_map(number).take(4).collect();
        match (said.is_empty(), &declaration.base) {
            (true, Some(base)) => format!("as {}", base.text()),
            _ => said.join(", "),
        }
    }

    fn lets(&mut self) {
        for item in &self.view.tree().items {
            if let Item::Let(binding) = item {
                let span = binding.value.span;
                let value = self.view.text.get(span.start as usize..span.end as usize).unwrap_or_default();
                let docs = binding.docs.join(" ");
                self.add(&binding.name.text, CompletionItemKind::CONSTANT, &value.replace('\n', " "), &docs);
            }
        }
    }

    fn asking(&mut self, form: &'static Form) {
        for response in Response::ALL {
            self.add(response.name(), CompletionItemKind::PROPERTY, &format!("response, {}", response.unit()), "");
        }
        if has(form, |form| matches!(form, Form::Comparison | Form::Expression)) {
            for name in ["max", "min", "mean", "rms", "percentile", "place_of_max", "misfit"] {
                self.add(name, CompletionItemKind::FUNCTION, "of a response", "");
            }
        }
    }

    fn transitions(&mut self) {
        for mark in &self.view.marks.0 {
            if let super::marks::What::Transition(true) = mark.what {
                let name = self.view.text[mark.span.start as usize..mark.span.end as usize].to_owned();
                self.add(&name, CompletionItemKind::VARIABLE, "transition", "");
            }
        }
    }

    fn profiles(&mut self, measure: &Measure) {
        if measure.varies == Varies::Yes {
            self.add(
                "ramp",
                CompletionItemKind::FUNCTION,
                "ramp(a .. b, over = span)",
                "linear change from one value to another",
            );
            self.add(
                "smooth",
                CompletionItemKind::FUNCTION,
                "smooth(a .. b, over = span)",
                "cubic change with zero slope at both ends",
            );
            self.add(
                "file",
                CompletionItemKind::FUNCTION,
                "file(\"level.csv\")",
                "a table in the folder of the scene or below it",
            );
            self.word(&RANDOM);
        }
    }

    /// Completions after `module.` or `name.`.
    fn inside(&mut self, wanted: Wanted, names: &[String]) {
        let files = &self.view.survey.files;
        let is_module = |scope: ScopeId| files.scopes[scope].modules.contains_key(&names[0]);
        if names.len() == 1 && (is_module(files.main) || is_module(files.standard)) {
            let kinds = wanted.form.map_or_else(Vec::new, |form| {
                let key = pair_forms(form).map(|(key, _)| key).filter(|_| !has(form, |f| matches!(f, Form::Number(_))));
                object_kinds(key.unwrap_or(form)).into_iter().chain(list_kinds(form)).collect()
            });
            return self.objects(&kinds, names);
        }
        self.scene_path(names);
    }

    /// Fields after the names of a path of the scene; names of the scene if the path is empty.
    fn scene_path(&mut self, names: &[String]) {
        let Some(first) = names.first() else {
            let files = &self.view.survey.files;
            self.lets();
            self.declared(files.main, &[], "");
            return;
        };
        let files = &self.view.survey.files;
        let in_module = files.scopes[files.main].modules.get(first).zip(names.get(1));
        let target = match in_module {
            Some((module, second)) => files.named(*module, second).map(|id| (id, 2)),
            None => files.named(files.main, first).map(|id| (id, 1)),
        };
        let (kind, taken) = match target {
            Some((id, taken)) => (files.kind(id), taken),
            None => (schema::kind(first), 1),
        };
        let path: Vec<&str> = names[taken..].iter().map(String::as_str).collect();
        let inner = match path.is_empty() {
            true => kind,
            false => kind.and_then(|kind| follow(kind, &path)).and_then(|(_, field)| object_kind(&field.form)),
        };
        for field in inner.into_iter().flat_map(|kind| kind.fields) {
            self.add(field.name, CompletionItemKind::FIELD, &hover::form_and_need(field), &hover::field_meaning(field));
        }
    }

    /// Units of the field, the usual one first.
    fn units(&mut self, wanted: Wanted) {
        let measures = wanted.form.map_or_else(Vec::new, measures);
        for measure in &measures {
            let dimension = Dimension::of_unit(measure.unit);
            let said = dimension.describe();
            for unit in std::iter::once(&measure.unit).chain(usual_units(dimension)).filter(|unit| !unit.is_empty()) {
                self.add(unit, CompletionItemKind::UNIT, &said, "");
                let bases = measure.basis.map_or(&[][..], |basis| basis.names);
                for (basis, _) in bases {
                    self.add(&format!("{unit} per {basis}"), CompletionItemKind::UNIT, &said, "");
                }
            }
        }
        let places = wanted.form.is_some_and(|form| has(form, |form| matches!(form, Form::Place | Form::Span)));
        if places {
            self.add("m", CompletionItemKind::UNIT, "along the track, from the transition", "");
            self.add("sleepers", CompletionItemKind::UNIT, "counted from the transition", "");
        }
    }

    fn bases(&mut self, wanted: Wanted) {
        for measure in wanted.form.map_or_else(Vec::new, measures) {
            for (name, factor) in measure.basis.map_or(&[][..], |basis| basis.names) {
                let detail = format!("the value for one rail is {factor} x this value");
                self.add(name, CompletionItemKind::UNIT, &detail, "");
            }
        }
    }

    fn arguments(&mut self, word: &'static Word, wanted: Wanted) {
        self.value(wanted);
        for argument in word.arguments {
            let text = format!("{} = ", argument.name);
            let detail = hover::form_and_need(argument);
            self.insert(argument.name, &text, CompletionItemKind::FIELD, &detail, argument.doc);
        }
    }
}

/// Kinds of the objects in a list.
fn list_kinds(form: &'static Form) -> Vec<&'static Kind> {
    match form {
        Form::List(item) => object_kinds(item),
        Form::OneOf(forms) => forms.iter().flat_map(list_kinds).collect(),
        _ => Vec::new(),
    }
}

/// Every measure of a form.
fn measures(form: &'static Form) -> Vec<&'static Measure> {
    match form {
        Form::Number(measure) | Form::Interval(measure) => vec![measure],
        Form::OneOf(forms) => forms.iter().flat_map(measures).collect(),
        Form::List(item) => measures(item),
        Form::Pairs { value, .. } => measures(value),
        _ => Vec::new(),
    }
}
