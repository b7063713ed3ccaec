//! Quick fixes: the edits that diagnostics carry.

use super::diagnostics::Remedy;
use super::view::View;
use lsp_types::{CodeAction, CodeActionKind, Diagnostic, Range, WorkspaceEdit};
use std::collections::HashMap;

/// The edits for the diagnostics that touch a range.
pub fn actions(view: &View, shown: &[Diagnostic], range: Range) -> Vec<CodeAction> {
    let touches = |d: &&Diagnostic| d.range.start <= range.end && range.start <= d.range.end;
    shown.iter().filter(touches).flat_map(|diagnostic| fixes(view, diagnostic)).collect()
}

fn fixes(view: &View, diagnostic: &Diagnostic) -> Vec<CodeAction> {
    let remedies = diagnostic.data.clone().and_then(|data| serde_json::from_value::<Vec<Remedy>>(data).ok());
    let remedies = remedies.unwrap_or_default();
    let only = remedies.len() == 1;
    let action = |remedy: Remedy| CodeAction {
        title: remedy.title,
        kind: Some(CodeActionKind::QUICKFIX),
        diagnostics: Some(vec![diagnostic.clone()]),
        edit: Some(WorkspaceEdit {
            changes: Some(HashMap::from([(view.places.main.clone(), remedy.edits)])),
            ..WorkspaceEdit::default()
        }),
        is_preferred: Some(only),
        ..CodeAction::default()
    };
    remedies.into_iter().map(action).collect()
}
