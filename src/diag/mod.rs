//! What is wrong, where, and the way out: the one type in which every stage reports a mistake.
//!
//! A stage returns its result together with all the [`Diagnostic`]s it has, never the first one only.
//! Rendering for people and for programs is separate ([`render`]), so that the stages know no terminal.

mod code;
mod fix;
pub mod nearest;
pub mod render;
mod source;

pub use code::Code;
pub use fix::{Edit, Fix, Help};
pub use source::{FileId, Position, Source, Sources, Span};

/// How much a diagnostic weighs: only errors stop a run.
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

/// A place in the source and what is to be said about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    pub span: Span,
    pub text: String,
}

/// One mistake: a code that `trackbed explain` knows, the places that show it, and a way out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    pub code: Code,
    pub severity: Severity,
    /// Lower case, no full stop, source text in backticks.
    pub message: String,
    /// The first label is where the mistake stands; the others are its second parties. Empty where no file is to blame.
    pub labels: Vec<Label>,
    /// What to write instead, ready to paste where possible.
    pub help: Option<String>,
    /// The same as edits of the text, each of which takes the mistake away.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A diagnostic of the code's usual severity.
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

    /// Adds the help where there is one.
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

/// Orders diagnostics by file and place and drops exact repetitions, so that a reader goes down the file once.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|d| (d.labels.first().map(|l| l.span), d.code, d.message.clone()));
    diagnostics.dedup();
}

/// Whether any of them stops a run.
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
