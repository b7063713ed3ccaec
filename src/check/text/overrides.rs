//! `--set path=value`: edits that line of the main file before the check.

use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Sources, Span};
use crate::schema::{self, Role};
use crate::syntax::parse;
use crate::syntax::tree::{Argument, Declaration, Field, Item, Name, Path, Tree, Value, ValueKind};
use serde::{Deserialize, Serialize};

/// The name of the text of an edited line.
pub const EDIT: &str = "--set";

/// One override: a path and the text of a value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Override {
    pub path: String,
    pub value: String,
}

impl Override {
    /// Reads `path=value`.
    pub fn parse(text: &str) -> Result<Override, String> {
        match text.split_once('=') {
            Some((path, value)) if !path.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Override { path: path.trim().into(), value: value.trim().into() })
            }
            _ => Err(format!("expected `path=value`, found `{text}`")),
        }
    }
}

/// Edits the tree of the main file.
pub fn apply(sources: &mut Sources, diagnostics: &mut Vec<Diagnostic>, tree: &mut Tree, overrides: &[Override]) {
    for wanted in overrides {
        // read as a binding of the same length, shown with the path that it sets
        let text = format!("let {} = {}", wanted.path.replace('.', "_"), wanted.value);
        let shown = format!("    {} = {}", wanted.path, wanted.value);
        let file = sources.add(EDIT, shown.as_str(), false);
        let (parsed, mistakes) = parse(file, &text);
        let sound = mistakes.is_empty();
        diagnostics.extend(mistakes);
        let [Item::Let(binding)] = parsed.items.as_slice() else {
            if sound {
                diagnostics.push(
                    Diagnostic::new(Code::E0101, format!("expected one value, found `{}`", wanted.value))
                        .label(Span::new(file, 4, shown.len()), "more than one value")
                        .help("give each path a `--set` of its own"),
                );
            }
            continue;
        };
        let span = binding.name.span;
        let names = wanted.path.split('.').map(|n| Name { text: n.trim().to_string(), span }).collect::<Vec<_>>();
        if let Err(mistake) = edit(tree, &names, &binding.value, span) {
            diagnostics.push(mistake);
        }
    }
}

fn edit(tree: &mut Tree, names: &[Name], value: &Value, span: Span) -> Result<(), Diagnostic> {
    let first = &names[0].text;
    let mut known = Vec::new();
    for item in &mut tree.items {
        match item {
            Item::Let(l) if l.name.text == *first && names.len() == 1 => {
                l.value = value.clone();
                return Ok(());
            }
            Item::Declaration(d) if d.name.as_ref().unwrap_or(&d.kind).text == *first && names.len() > 1 => {
                set(&mut d.fields, &names[1..], value, span);
                return Ok(());
            }
            Item::Let(l) => known.push(l.name.text.clone()),
            Item::Declaration(d) => known.push(d.name.as_ref().unwrap_or(&d.kind).text.clone()),
            Item::Use(_) => {}
        }
    }
    if let Some(fields) = scene_kind(tree, &names[0]).filter(|_| names.len() > 1) {
        set(fields, &names[1..], value, span);
        return Ok(());
    }
    let near = nearest(first, known.iter().map(String::as_str)).map(|n| format!("did you mean `{n}`?"));
    Err(Diagnostic::new(Code::E0201, format!("the file declares nothing called `{first}` that could be set"))
        .label(span, "unknown name")
        .maybe_help(
            near.or_else(|| Some("write `--set declaration.field=value`, or `--set name=value` for a `let`".into())),
        ))
}

/// The fields of the declaration of a single kind, under any name; a declaration is added if there is none.
fn scene_kind<'t>(tree: &'t mut Tree, kind: &Name) -> Option<&'t mut Vec<Field>> {
    let role = schema::kind(&kind.text)?.role;
    if role != (Role::Scene { once: true }) || !matches!(kind.text.as_str(), "solve" | "scenario") {
        return None;
    }
    let own = |item: &Item| matches!(item, Item::Declaration(d) if d.kind.text == kind.text);
    let at = tree.items.iter().position(own).unwrap_or_else(|| {
        let (name, base, fields, docs) = (None, None, Vec::new(), Vec::new());
        tree.items.push(Item::Declaration(Declaration {
            kind: kind.clone(),
            name,
            base,
            fields,
            docs,
            span: kind.span,
        }));
        tree.items.len() - 1
    });
    match &mut tree.items[at] {
        Item::Declaration(d) => Some(&mut d.fields),
        _ => None,
    }
}

/// Replaces the value at a path of a block, or adds a line for it.
fn set(fields: &mut Vec<Field>, names: &[Name], value: &Value, span: Span) {
    let path_of = |f: &Field| f.path.names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
    let wanted: Vec<String> = names.iter().map(|n| n.text.clone()).collect();
    // longer paths inside a replaced field are removed with it
    fields.retain(|f| !(path_of(f).starts_with(&wanted) && path_of(f).len() > wanted.len()));
    if let Some(field) = fields.iter_mut().find(|f| path_of(f) == wanted) {
        field.value = value.clone();
        return;
    }
    if let Some(field) = fields.iter_mut().find(|f| wanted.starts_with(&path_of(f))) {
        let rest = &names[field.path.names.len()..];
        if inside(&mut field.value, rest, value, span) {
            return;
        }
    }
    fields.push(Field { path: Path { names: names.to_vec(), span }, value: value.clone(), docs: Vec::new(), span });
}

/// Replaces inside a value: in an object, in an extension of a named object, or in an argument of a word.
fn inside(target: &mut Value, rest: &[Name], value: &Value, span: Span) -> bool {
    match &mut target.kind {
        ValueKind::Object { fields, .. } => {
            set(fields, rest, value, span);
            true
        }
        ValueKind::Path(path) => {
            let field =
                Field { path: Path { names: rest.to_vec(), span }, value: value.clone(), docs: Vec::new(), span };
            target.kind = ValueKind::Object { base: Some(path.clone()), fields: vec![field] };
            true
        }
        ValueKind::Call { word, arguments } if rest.len() == 1 => {
            let named = arguments.iter().position(|a| a.name.as_ref().is_some_and(|n| n.text == rest[0].text));
            // an argument given by its place is replaced there
            let placed = || {
                let place = schema::word(&word.text)?.arguments.iter().position(|a| a.name == rest[0].text)?;
                arguments.get(place).filter(|a| a.name.is_none()).map(|_| place)
            };
            match named.or_else(placed).and_then(|i| arguments.get_mut(i)) {
                Some(argument) => argument.value = value.clone(),
                None => arguments.push(Argument { name: Some(rest[0].clone()), value: value.clone() }),
            }
            true
        }
        ValueKind::List { entries, .. } if rest.len() == 1 => {
            let ends_with = |key: &Option<Value>| match key.as_ref().map(|k| &k.kind) {
                Some(ValueKind::Path(path)) => path.names.last().is_some_and(|n| n.text == rest[0].text),
                _ => false,
            };
            match entries.iter_mut().find(|e| ends_with(&e.key)) {
                Some(entry) => {
                    entry.value = value.clone();
                    true
                }
                None => false,
            }
        }
        _ => false,
    }
}
