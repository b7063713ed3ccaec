//! Diagnostics for people, drawn over the source text, and for programs, as JSON.
//!
//! Only this module uses miette. Spans are clamped and texts cleaned before miette gets them, so that unusual spans and
//! texts cannot break a report. Lines and columns come from [`Sources::position`].

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError, MietteSpanContents};
use miette::{SourceCode, SourceSpan, SpanContents};
use serde_json::{Value, json};

use super::{Diagnostic, Edit, FileId, Fix, Label, Severity, Sources, Span};

/// A report for a terminal of that width, with counts at the end; empty without diagnostics.
pub fn human(diagnostics: &[Diagnostic], sources: &Sources, colour: bool, width: usize) -> String {
    let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_links(false)
        .with_width(width.max(40))
        .tab_width(2)
        .with_context_lines(1);
    let excerpts: Vec<Excerpt> = sources.iter().map(|(_, source)| Excerpt::new(&source.name, &source.text)).collect();
    let mut out = String::new();
    for diagnostic in diagnostics {
        for (i, report) in Report::all(diagnostic, &excerpts).iter().enumerate() {
            let mut drawn = String::new();
            if handler.render_report(&mut drawn, report).is_err() {
                drawn = if i == 0 { plain(diagnostic, sources) } else { String::new() };
            }
            for line in drawn.trim_matches('\n').lines() {
                out.push_str(line.trim_end());
                out.push('\n');
            }
        }
        out.push('\n');
    }
    out.push_str(&footer(diagnostics));
    out
}

/// Such as `3 errors, 1 warning`.
fn footer(diagnostics: &[Diagnostic]) -> String {
    let counts = [Severity::Error, Severity::Warning, Severity::Note].map(|severity| {
        let count = diagnostics.iter().filter(|d| d.severity == severity).count();
        (count, format!("{count} {}{}", severity.as_str(), if count == 1 { "" } else { "s" }))
    });
    let counted: Vec<String> = counts.into_iter().filter(|(count, _)| *count > 0).map(|(_, text)| text).collect();
    if counted.is_empty() { String::new() } else { format!("{}\n", counted.join(", ")) }
}

/// The diagnostic on two lines, if the drawing fails.
fn plain(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let place = diagnostic.labels.first().and_then(|label| {
        let start = position(sources, label.span.file, label.span.start)?;
        Some(format!("  at {}:{}:{}\n", start.0, start.1, start.2))
    });
    let (severity, code) = (diagnostic.severity.as_str(), diagnostic.code);
    format!("{severity} {code}: {}\n{}", diagnostic.message, place.unwrap_or_default())
}

/// The diagnostics as data: lines and columns count from 1, unknown values are null.
pub fn json(diagnostics: &[Diagnostic], sources: &Sources) -> Value {
    json!({ "diagnostics": entries(diagnostics, sources) })
}

/// Each diagnostic as data.
pub fn entries(diagnostics: &[Diagnostic], sources: &Sources) -> Vec<Value> {
    diagnostics
        .iter()
        .map(|diagnostic| {
            let span = diagnostic.labels.first().map(|label| label.span);
            let at = |offset: fn(Span) -> u32| {
                let (name, line, column) = span.and_then(|s| position(sources, s.file, offset(s)))?;
                Some((name, json!({ "line": line, "column": column })))
            };
            let (start, end) = (at(|s| s.start), at(|s| s.end.max(s.start)));
            json!({
                "code": diagnostic.code.as_str(),
                "severity": diagnostic.severity.as_str(),
                "message": diagnostic.message,
                "file": start.as_ref().map(|(name, _)| name),
                "start": start.as_ref().map(|(_, place)| place),
                "end": end.map(|(_, place)| place),
                "help": diagnostic.help,
                "fixes": diagnostic.fixes.iter().map(|fix| fix_json(fix, sources)).collect::<Vec<_>>(),
            })
        })
        .collect()
}

/// An edit as data: spans of the files in bytes from 0, the end excluded, and their replacements.
fn fix_json(fix: &Fix, sources: &Sources) -> Value {
    let edit = |edit: &Edit| {
        let name = sources.iter().nth(edit.span.file.0 as usize).map(|(_, source)| source.name.as_str());
        json!({ "file": name, "start": edit.span.start, "end": edit.span.end, "text": edit.text })
    };
    json!({ "title": fix.title, "edits": fix.edits.iter().map(edit).collect::<Vec<_>>() })
}

/// File name, line and column of an offset, which may lie anywhere.
fn position(sources: &Sources, file: FileId, offset: u32) -> Option<(String, usize, usize)> {
    let (_, source) = sources.iter().nth(file.0 as usize)?;
    let offset = floor(&source.text, offset as usize);
    let position = sources.position(file, offset as u32);
    Some((source.name.clone(), position.line, position.column))
}

/// The character boundary at or before an offset.
fn floor(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// A source text for miette.
struct Excerpt<'a> {
    name: &'a str,
    /// The source, byte for byte, but with blanks for control characters.
    text: String,
    line_starts: Vec<usize>,
}

/// Longer lines are shown in part.
const LONG_LINE: usize = 400;
/// Largest number of lines between two excerpts that are drawn and not left out.
const NEAR: usize = 4;
/// Length of the shown part of a long line on either side of a label.
const MARGIN: usize = 60;

impl<'a> Excerpt<'a> {
    fn new(name: &'a str, text: &str) -> Self {
        let clean = |c: char| match c {
            '\n' | '\t' => c,
            _ if c.is_ascii_control() => ' ',
            _ => c,
        };
        let text: String = text.chars().map(clean).collect();
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
        Excerpt { name, text, line_starts }
    }

    /// The number of the line that holds an offset, from 0.
    fn line(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|start| *start <= offset).saturating_sub(1)
    }

    fn line_end(&self, line: usize) -> usize {
        self.line_starts.get(line + 1).map_or(self.text.len(), |next| next - 1)
    }

    /// Clamps a span to the text, to whole characters, and to one line.
    fn clamp(&self, span: Span) -> (usize, usize) {
        let start = floor(&self.text, span.start as usize);
        let end = floor(&self.text, span.end as usize).clamp(start, self.line_end(self.line(start)).max(start));
        (start, end)
    }
}

impl SourceCode for Excerpt<'_> {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let (start, end) = (floor(&self.text, span.offset()), floor(&self.text, span.offset() + span.len()));
        let (first, last) = (self.line(start), self.line(end));
        let from_line = first.saturating_sub(lines_before);
        let to_line = (last + lines_after).min(self.line_starts.len() - 1);
        let mut from = self.line_starts[from_line];
        let mut to = self.line_end(to_line);
        // Neighbouring lines that are too long are left out, and also the far ends of the lines themselves.
        if start - from > LONG_LINE {
            from = self.line_starts[first].max(floor(&self.text, start.saturating_sub(MARGIN)));
        }
        if to - end > LONG_LINE {
            to = self.line_end(last).min(floor(&self.text, end + MARGIN));
        }
        let column = self.text[self.line_starts[first]..start].chars().count();
        // miette takes the line number of the contents for the gutter and the line number of the label, read alone, for
        // the header.
        let (line, column) = if lines_before == 0 && lines_after == 0 { (first, column) } else { (self.line(from), 0) };
        // excerpts that meet are drawn as one
        let line_count = to_line + 1 - from_line + NEAR;
        let name = self.name.to_owned();
        let data = &self.text.as_bytes()[from..to];
        Ok(Box::new(MietteSpanContents::new_named(name, data, (from, to - from).into(), line, column, line_count)))
    }
}

/// One diagnostic for miette.
#[derive(Debug)]
struct Report<'a> {
    diagnostic: Option<&'a Diagnostic>,
    message: String,
    labels: Vec<LabeledSpan>,
    excerpt: Option<&'a Excerpt<'a>>,
}

impl std::fmt::Debug for Excerpt<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl<'a> Report<'a> {
    /// The report itself, then one report for each label in another file: miette draws one text at a time.
    fn all(diagnostic: &'a Diagnostic, excerpts: &'a [Excerpt<'a>]) -> Vec<Self> {
        let excerpt = |file: FileId| excerpts.get(file.0 as usize);
        let labelled = |label: &Label, text: &str, primary: bool| {
            let (start, end) = excerpt(label.span.file)?.clamp(label.span);
            let text = (!text.is_empty()).then(|| text.to_owned());
            Some(match primary {
                true => LabeledSpan::new_primary_with_span(text, (start, end - start)),
                false => LabeledSpan::new_with_span(text, (start, end - start)),
            })
        };
        let home = diagnostic.labels.first().map(|label| label.span.file);
        let (mut labels, mut related) = (Vec::new(), Vec::new());
        for (i, label) in diagnostic.labels.iter().enumerate() {
            if Some(label.span.file) == home {
                labels.extend(labelled(label, &label.text, i == 0));
            } else if let Some(span) = labelled(label, "", true) {
                let message = if label.text.is_empty() { "see here".to_owned() } else { label.text.clone() };
                let excerpt = excerpt(label.span.file);
                related.push(Report { diagnostic: None, message, labels: vec![span], excerpt });
            }
        }
        let message = diagnostic.message.clone();
        let report = Report { diagnostic: Some(diagnostic), message, labels, excerpt: home.and_then(excerpt) };
        related.insert(0, report);
        related
    }
}

impl std::fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report<'_> {}

impl miette::Diagnostic for Report<'_> {
    fn code<'b>(&'b self) -> Option<Box<dyn std::fmt::Display + 'b>> {
        self.diagnostic.map(|d| Box::new(format!("{} {}", d.severity.as_str(), d.code)) as Box<dyn std::fmt::Display>)
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.diagnostic.map(|d| d.severity) {
            Some(Severity::Error) => miette::Severity::Error,
            Some(Severity::Warning) => miette::Severity::Warning,
            Some(Severity::Note) | None => miette::Severity::Advice,
        })
    }

    fn help<'b>(&'b self) -> Option<Box<dyn std::fmt::Display + 'b>> {
        self.diagnostic?.help.as_ref().map(|help| Box::new(help) as Box<dyn std::fmt::Display>)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt.map(|excerpt| excerpt as &dyn SourceCode)
    }
}
