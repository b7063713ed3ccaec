//! Diagnostics: every stage reports a mistake, its place and its help in this type.
//!
//! A stage returns its result together with all its [`Diagnostic`]s, not only the first.
//! Rendering for people and for programs is separate ([`render`]), so that the stages do not depend on a terminal.

mod code;
mod fix;
pub mod nearest;
pub mod render;
mod source;

pub use code::Code;
pub use fix::{Edit, Fix, Help};
pub use source::{FileId, Position, Source, Sources, Span};

/// The severity of a diagnostic: only errors stop a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    Note,
    Warning,
    Error,
}

impl Severity {
    pub fn as_str(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

/// A place in the source with a short text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    pub span: Span,
    pub text: String,
}

/// One mistake: a code for `trackbed explain`, the places that show it, and help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    pub code: Code,
    pub severity: Severity,
    /// Lower case, no full stop, source text in backticks.
    pub message: String,
    /// The first label is the place of the mistake; the others are related places. Empty if no file has the mistake.
    pub labels: Vec<Label>,
    /// Text to write instead, ready to paste if possible.
    pub help: Option<String>,
    /// The same as edits of the text; each edit alone corrects the mistake.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A diagnostic with the code's usual severity.
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        let (labels, fixes) = (Vec::new(), Vec::new());
        Diagnostic { code, severity: code.severity(), message: message.into(), labels, help: None, fixes }
    }

    /// Adds a place; the first one added is the place of the mistake.
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push(Label { span, text: text.into() });
        self
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the help if there is one.
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.or(self.help);
        self
    }

    pub fn severity(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Orders diagnostics by file and place and drops exact repetitions.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|d| (d.labels.first().map(|l| l.span), d.code, d.message.clone()));
    diagnostics.dedup();
}

/// Whether any diagnostic stops a run.
pub fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}

/// `a, b or c`
pub fn or_list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// `a, b and c`
pub fn and_list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
