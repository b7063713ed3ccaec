//! The outline of a file: its declarations, and their fields inside them.

use super::view::View;
use crate::diag::Span;
use crate::syntax::tree::{Declaration, Field, Item, ValueKind};
use lsp_types::{DocumentSymbol, Range, SymbolKind};

/// The declarations and `let`s of a text.
pub fn outline(view: &View) -> Vec<DocumentSymbol> {
    view.tree().items.iter().filter_map(|item| symbol_of(view, item)).collect()
}

fn symbol_of(view: &View, item: &Item) -> Option<DocumentSymbol> {
    match item {
        Item::Use(_) => None,
        Item::Let(binding) => {
            let detail = one_line(view, binding.value.span);
            let (name, selection) = (binding.name.text.clone(), binding.name.span);
            Some(symbol(view, name, detail, SymbolKind::CONSTANT, binding.span, selection, Vec::new()))
        }
        Item::Declaration(declaration) => Some(declared(view, declaration)),
    }
}

fn declared(view: &View, declaration: &Declaration) -> DocumentSymbol {
    let named = declaration.name.as_ref().unwrap_or(&declaration.kind);
    let base = declaration.base.as_ref().map_or(String::new(), |base| format!(" : {}", base.text()));
    let detail = format!("{}{base}", declaration.kind.text);
    let kind = match declaration.kind.text.as_str() {
        "scenario" | "track" => SymbolKind::MODULE,
        "traffic" | "load" | "tamping" => SymbolKind::EVENT,
        "solve" | "record" | "expect" | "study" => SymbolKind::FUNCTION,
        _ => SymbolKind::OBJECT,
    };
    symbol(view, named.text.clone(), detail, kind, declaration.span, named.span, fields(view, &declaration.fields))
}

fn fields(view: &View, given: &[Field]) -> Vec<DocumentSymbol> {
    given.iter().map(|field| field_symbol(view, field)).collect()
}

fn field_symbol(view: &View, field: &Field) -> DocumentSymbol {
    let (inner, detail) = match &field.value.kind {
        ValueKind::Object { base, fields: inner } => {
            (fields(view, inner), base.as_ref().map_or(String::new(), |base| base.text()))
        }
        _ => (Vec::new(), one_line(view, field.value.span)),
    };
    symbol(view, field.path.text(), detail, SymbolKind::FIELD, field.span, field.path.span, inner)
}

/// The first line of a part of the text, shortened.
fn one_line(view: &View, span: Span) -> String {
    let text = view.text.get(span.start as usize..span.end as usize).unwrap_or_default();
    let line = text.lines().next().unwrap_or_default();
    let short: String = line.chars().take(60).collect();
    if short.len() < text.trim_end().len() { format!("{short} ...") } else { short }
}

/// A symbol; the range of its name lies inside its range, as the protocol requires.
fn symbol(
    view: &View,
    name: String,
    detail: String,
    kind: SymbolKind,
    whole: Span,
    selection: Span,
    children: Vec<DocumentSymbol>,
) -> DocumentSymbol {
    let range: Range = view.range(whole.start.min(selection.start), whole.end.max(selection.end));
    #[allow(deprecated, reason = "the type cannot be constructed without this field, and the field is unused")]
    DocumentSymbol {
        name,
        detail: Some(detail).filter(|detail| !detail.is_empty()),
        kind,
        tags: None,
        deprecated: None,
        range,
        selection_range: view.range(selection.start, selection.end),
        children: Some(children).filter(|children| !children.is_empty()),
    }
}
