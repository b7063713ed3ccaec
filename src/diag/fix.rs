//! Help as an edit: a change of the text that an editor or another program can apply.

use super::{Diagnostic, Span};

/// An edit that corrects a mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// Its title for a menu: ``write `stiffness` ``.
    pub title: String,
    /// Parts of the text that are replaced; they do not overlap.
    pub edits: Vec<Edit>,
}

/// A part of a text, and its replacement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    pub span: Span,
    pub text: String,
}

impl Fix {
    /// Replaces a span by a text.
    pub fn replace(span: Span, text: impl Into<String>) -> Fix {
        let text = text.into();
        let title = if text.is_empty() { "take it out".into() } else { format!("write `{}`", one_line(&text)) };
        Fix { title, edits: vec![Edit { span, text }] }
    }

    /// The same fix under another title.
    pub fn titled(self, title: impl Into<String>) -> Fix {
        Fix { title: title.into(), ..self }
    }

    /// The text of one file after the edits of the fix.
    pub fn applied(&self, file: super::FileId, text: &str) -> String {
        let mut edits: Vec<&Edit> = self.edits.iter().filter(|edit| edit.span.file == file).collect();
        edits.sort_by_key(|edit| std::cmp::Reverse(edit.span));
        let mut out = text.to_owned();
        for edit in edits {
            out.replace_range(edit.span.start as usize..edit.span.end as usize, &edit.text);
        }
        out
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl Diagnostic {
    /// Adds an edit that corrects the mistake.
    pub fn fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }

    /// Adds an edit if there is one.
    pub fn maybe_fix(mut self, fix: Option<Fix>) -> Self {
        self.fixes.extend(fix);
        self
    }

    /// Offers to replace a value by a text, if the value has a place in the text.
    pub fn rewrite(self, value: Option<Span>, text: impl Into<String>) -> Self {
        match value {
            Some(span) => self.fix(Fix::replace(span, text)),
            None => self,
        }
    }

    /// Tells to write a text instead of a span, and offers the edit.
    pub fn write(self, span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        self.help(format!("write `{text}`")).fix(Fix::replace(span, text))
    }

    /// Asks whether a text was meant instead of a span, and offers the edit.
    pub fn meant(self, span: Span, text: &str) -> Self {
        self.help(format!("did you mean `{text}`?")).fix(Fix::replace(span, text))
    }

    /// The same if there is such a text.
    pub fn maybe_meant(self, span: Span, text: Option<&str>) -> Self {
        match text {
            Some(text) => self.meant(span, text),
            None => self,
        }
    }
}

/// A help message, with the texts that can replace the mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Help {
    pub said: String,
    pub writes: Vec<String>,
}

impl Help {
    /// A help message without an edit.
    pub fn say(said: impl Into<String>) -> Help {
        Help { said: said.into(), writes: Vec::new() }
    }

    /// A text to be written.
    pub fn write(text: impl Into<String>) -> Help {
        let text = text.into();
        Help { said: format!("write `{text}`"), writes: vec![text] }
    }

    /// One of several texts to be written.
    pub fn write_one_of(texts: Vec<String>) -> Help {
        let quoted: Vec<String> = texts.iter().map(|text| format!("`{text}`")).collect();
        Help { said: format!("write {}", super::or_list(&quoted)), writes: texts }
    }

    /// A text that was probably meant.
    pub fn meant(text: impl Into<String>) -> Help {
        let text = text.into();
        Help { said: format!("did you mean `{text}`?"), writes: vec![text] }
    }

    /// Words before it.
    pub fn after(self, before: &str) -> Help {
        Help { said: format!("{before}{}", self.said), ..self }
    }

    /// Words behind it.
    pub fn and(self, more: &str) -> Help {
        Help { said: format!("{}{more}", self.said), ..self }
    }
}

impl Diagnostic {
    /// Adds help for the text of a span.
    pub fn advise(mut self, span: Span, help: Help) -> Self {
        self.fixes.extend(help.writes.into_iter().map(|text| Fix::replace(span, text)));
        self.help(help.said)
    }

    /// The same if there is help.
    pub fn maybe_advise(self, span: Span, help: Option<Help>) -> Self {
        match help {
            Some(help) => self.advise(span, help),
            None => self,
        }
    }
}
