//! Hover text of a word: for a field its unit, range, default, and its value with the source of the value; for a name
//! its declaration.

use super::marks::{Mark, Place, What};
use super::names::name_of;
use super::view::View;
use crate::check::{Content, Held, ItemId, Object};
use crate::diag::FileId;
use crate::scenario::Origin;
use crate::schema::{self, Field, Need, Role, Word};
use crate::syntax::tree::Item;
use crate::units::{number, parse_unit};
use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind};

/// Hover text of the word at an offset.
pub fn hover(view: &View, offset: usize) -> Option<Hover> {
    let mark = view.mark(offset)?;
    let value = meaning(view, mark)?;
    let contents = HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value });
    Some(Hover { contents, range: Some(view.range_of(mark)) })
}

fn meaning(view: &View, mark: &Mark) -> Option<String> {
    let text = || view.text.get(mark.span.start as usize..mark.span.end as usize);
    Some(match &mark.what {
        What::Kind(kind) => format!("**{}** (kind)\n\n{}", kind.name, kind.doc),
        What::Declared(id) | What::Reference(id) => declared(view, *id),
        What::Module(scope) => {
            let names: Vec<String> = view.survey.files.scopes[*scope].names.keys().map(|n| format!("`{n}`")).collect();
            format!("**{}** (module)\n\n{}", text()?, names.join(", "))
        }
        What::Field(kind, field, place) => {
            let head = format!("**{}** of `{}`: {}", field.name, kind.name, form_and_need(field));
            paragraphs([head, field_meaning(field), place.as_ref().and_then(|p| value(view, p)).unwrap_or_default()])
        }
        What::Argument(word, field) => {
            let head = format!("**{}** of `{}`: {}", field.name, word.name, form_and_need(field));
            paragraphs([head, field_meaning(field), String::new()])
        }
        What::Word(word) => paragraphs([format!("**{}**", signature(word)), word_meaning(word), String::new()]),
        What::Response(response) => {
            format!("**{}** (response): {}, in `{}`", response.name(), response.doc(), response.unit())
        }
        What::Rule(code) => format!("**{}** (physics rule {code})\n\n{}", text()?, code.title()),
        What::Transition(_) => format!("**{}** (transition)", text()?),
        What::Number(Some(field)) => format!("**{}**: {}\n\n{}", field.name, form_and_need(field), field.doc),
        What::Unit => unit(text()?)?,
        What::Basis => format!("the value is for one {}", text()?),
        What::Hole => "a hole: replace it by a value before a run".into(),
        What::Number(None) | What::Text | What::Function => return None,
    })
}

fn paragraphs(parts: [String; 3]) -> String {
    let said: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    said.join("\n\n")
}

/// A unit with its dimension and its size.
fn unit(text: &str) -> Option<String> {
    let unit = parse_unit(text).ok()?;
    let si = unit.dimension.si_unit();
    let size = if si.is_empty() { number(unit.factor) } else { format!("{} {si}", number(unit.factor)) };
    Some(format!("`{text}`: {}, 1 {text} = {size}", unit.dimension.describe()))
}

/// Allowed values of a field, and whether it is required: `MN/m, 5 .. 3000; required`.
pub fn form_and_need(field: &Field) -> String {
    let form = schema::form_text(&field.form);
    match field.need {
        Need::Required => format!("{form}; required"),
        Need::Default(text) => format!("{form}; default `{text}`"),
        Need::Optional => form,
        Need::Alternative => format!("{form}; one way of several"),
    }
}

/// Description of a field, with its words.
pub fn field_meaning(field: &Field) -> String {
    let words = field.form.words().into_iter().filter(|word| !word.planned && !word.doc.is_empty());
    let words: Vec<String> = words.map(|word| format!("- `{}`: {}", word.name, word.doc)).collect();
    let unread = if field.unread { "not used by this version" } else { "" };
    paragraphs([field.doc.to_owned(), words.join("\n"), unread.to_owned()])
}

/// `geometric(first, ratio = 0.2)`
pub fn signature(word: &Word) -> String {
    if word.arguments.is_empty() {
        return word.name.to_owned();
    }
    let argument = |field: &Field| match field.need {
        Need::Default(text) => format!("{} = {text}", field.name),
        _ => field.name.to_owned(),
    };
    let arguments: Vec<String> = word.arguments.iter().map(argument).collect();
    format!("{}({})", word.name, arguments.join(", "))
}

/// Description of a word, with its arguments.
pub fn word_meaning(word: &Word) -> String {
    let arguments: Vec<String> =
        word.arguments.iter().map(|a| format!("- `{}` ({}): {}", a.name, form_and_need(a), a.doc)).collect();
    paragraphs([word.doc.to_owned(), arguments.join("\n"), String::new()])
}

/// The value of a field here, and its source.
fn value(view: &View, place: &Place) -> Option<String> {
    let object = view.survey.objects.get(&place.id)?;
    let held = object.held(&place.path)?;
    let text = held_text(view, held)?;
    Some(format!("here `{text}`, {}", origin(view, held)))
}

/// A value in one line.
fn held_text(view: &View, held: &Held) -> Option<String> {
    match &held.content {
        Content::Number { text, .. } => Some(text.clone()),
        Content::Object(name, _) => Some(name.clone()),
        Content::Other => {
            let source = view.source(held.span.file);
            let text = source.text.get(held.span.start as usize..held.span.end as usize)?;
            let line: String = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(80).collect();
            let line = line.strip_prefix("let default = ").unwrap_or(&line).to_owned();
            (!line.is_empty()).then_some(line)
        }
        Content::Unknown => None,
    }
}

/// The source of a value in words.
fn origin(view: &View, held: &Held) -> String {
    let place = |span: crate::diag::Span| {
        let source = view.source(span.file);
        let line = view.survey.checked.sources.position(span.file, span.start).line;
        if span.file == FileId(0) {
            format!("from line {line}")
        } else {
            format!("from `{}`, line {line}", source.name)
        }
    };
    match held.origin {
        Origin::Written(span) | Origin::Library(span) => place(span),
        Origin::Default => "by default".into(),
        Origin::Derived => "derived".into(),
    }
}

/// A declaration or a `let`: its kind, its doc comment, its content.
pub fn declared(view: &View, id: ItemId) -> String {
    let item = view.survey.files.item(id);
    let (name, _) = name_of(item);
    match item {
        Item::Declaration(declaration) => {
            let base = declaration.base.as_ref().map_or(String::new(), |base| format!(" : {}", base.text()));
            let head = format!("**{name}**: `{}{base}`", declaration.kind.text);
            let docs = declaration.docs.join(" ").trim().to_owned();
            paragraphs([head, docs, table(view, id)])
        }
        Item::Let(binding) => {
            let text = &view.source(binding.span.file).text;
            let value =
                text.get(binding.value.span.start as usize..binding.value.span.end as usize).unwrap_or_default();
            paragraphs([format!("**{name}** = `{value}`"), binding.docs.join(" "), String::new()])
        }
        Item::Use(used) => format!("module `{}`", used.path.text()),
    }
}

/// The content of an object, one line for each field; the written text if the object has not been evaluated.
fn table(view: &View, id: ItemId) -> String {
    match view.survey.objects.get(&id) {
        Some(object) if !matches!(object.kind.role, Role::Changes(_)) => lines(view, object, "").join("\n"),
        _ => written(view, id),
    }
}

fn lines(view: &View, object: &Object, prefix: &str) -> Vec<String> {
    let one = |held: &Held| match &held.content {
        Content::Object(_, inner) if prefix.matches('.').count() < 2 => {
            lines(view, inner, &format!("{prefix}{}.", held.field.name))
        }
        _ => {
            let said = held_text(view, held)
                .map(|text| format!("- `{prefix}{} = {text}` {}", held.field.name, origin(view, held)));
            said.into_iter().collect()
        }
    };
    object.fields.iter().flat_map(one).take(40).collect()
}

/// The fields of a declaration as written.
fn written(view: &View, id: ItemId) -> String {
    let Some(declaration) = view.survey.files.declaration(id) else { return String::new() };
    let text = &view.source(declaration.span.file).text;
    let line = |field: &crate::syntax::tree::Field| {
        let written = text.get(field.span.start as usize..field.span.end as usize)?;
        Some(format!("- `{}`", written.split_whitespace().collect::<Vec<_>>().join(" ")))
    };
    declaration.fields.iter().filter_map(line).take(40).collect::<Vec<_>>().join("\n")
}
