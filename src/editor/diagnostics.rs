//! Diagnostics for an editor: the main place, the related places, and the edits.

use super::files::Places;
use super::positions::Lines;
use crate::diag::{Diagnostic, FileId, Fix, Severity, Sources, Span};
use lsp_types::{
    DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location, NumberOrString, Position, Range,
};
use serde::{Deserialize, Serialize};

/// An edit that belongs to a diagnostic.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Remedy {
    pub title: String,
    pub edits: Vec<lsp_types::TextEdit>,
}

/// The diagnostics of a main file.
pub fn shown(diagnostics: &[Diagnostic], sources: &Sources, places: &Places) -> Vec<lsp_types::Diagnostic> {
    let Some((_, main)) = sources.iter().next() else { return Vec::new() };
    let page = Page { lines: Lines::new(&main.text), text: &main.text, sources, places };
    diagnostics.iter().map(|diagnostic| page.shown(diagnostic)).collect()
}

struct Page<'a> {
    lines: Lines,
    text: &'a str,
    sources: &'a Sources,
    places: &'a Places,
}

impl Page<'_> {
    fn shown(&self, diagnostic: &Diagnostic) -> lsp_types::Diagnostic {
        // the first place in this file; a fault in another file is shown at the place that leads there
        let own = diagnostic.labels.iter().find(|label| label.span.file == FileId(0));
        let range = own.map_or_else(|| Range::new(Position::new(0, 0), Position::new(0, 0)), |l| self.range(l.span));
        let mut message = diagnostic.message.clone();
        let first = diagnostic.labels.first();
        if let Some(elsewhere) = first.filter(|label| label.span.file != FileId(0)) {
            message = format!("in `{}`: {message}", self.sources.get(elsewhere.span.file).name);
        }
        if let Some(label) = own.filter(|label| !label.text.is_empty() && label.text.len() > 3) {
            message = format!("{message} ({})", label.text);
        }
        if let Some(help) = &diagnostic.help {
            message = format!("{message}\nhelp: {help}");
        }
        let related = diagnostic.labels.iter().filter(|label| own.is_none_or(|own| !std::ptr::eq(*label, own)));
        let related: Vec<_> = related.filter_map(|label| self.related(label.span, &label.text)).collect();
        let remedies: Vec<Remedy> = diagnostic.fixes.iter().filter_map(|fix| self.remedy(fix)).collect();
        lsp_types::Diagnostic {
            range,
            severity: Some(severity(diagnostic.severity)),
            code: Some(NumberOrString::String(diagnostic.code.as_str().to_owned())),
            source: Some("trackbed".to_owned()),
            message,
            related_information: (!related.is_empty()).then_some(related),
            tags: is_idle(diagnostic).then(|| vec![DiagnosticTag::UNNECESSARY]),
            data: serde_json::to_value(&remedies).ok().filter(|_| !remedies.is_empty()),
            ..lsp_types::Diagnostic::default()
        }
    }

    fn range(&self, span: Span) -> Range {
        self.lines.range(self.text, span.start as usize, span.end as usize)
    }

    fn related(&self, span: Span, text: &str) -> Option<DiagnosticRelatedInformation> {
        let location = match span.file {
            FileId(0) => Location::new(self.places.main.clone(), self.range(span)),
            file => self.places.location(self.sources, file, span.start as usize, span.end as usize)?,
        };
        let message = if text.is_empty() { "see here" } else { text }.to_owned();
        Some(DiagnosticRelatedInformation { location, message })
    }

    /// The edits of a fix that stays in this file.
    fn remedy(&self, fix: &Fix) -> Option<Remedy> {
        let edit = |edit: &crate::diag::Edit| lsp_types::TextEdit::new(self.range(edit.span), edit.text.clone());
        let here = fix.edits.iter().all(|edit| edit.span.file == FileId(0));
        here.then(|| Remedy { title: fix.title.clone(), edits: fix.edits.iter().map(edit).collect() })
    }
}

/// Whether the marked text could be removed.
fn is_idle(diagnostic: &Diagnostic) -> bool {
    use crate::diag::Code;
    matches!(diagnostic.code, Code::E0412 | Code::E0429)
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::ERROR,
        Severity::Warning => DiagnosticSeverity::WARNING,
        Severity::Note => DiagnosticSeverity::INFORMATION,
    }
}
