//! Lines of formatted text, and their alignment.

/// One line of the formatted text.
#[derive(Debug, Default)]
pub(super) struct Line {
    pub indent: usize,
    pub text: String,
    /// The comment at its end, or alone on it.
    pub comment: Option<String>,
    /// An empty line stood above it.
    pub blank_before: bool,
    /// It starts with a closing bracket.
    pub is_closer: bool,
    /// It holds one field or `let`.
    pub fields: bool,
    /// It leaves no bracket open.
    pub complete: bool,
    /// The position of its `=`.
    pub equals: Option<usize>,
}

impl Line {
    pub fn is_empty(&self) -> bool {
        self.text.is_empty() && self.comment.is_none()
    }

    fn can_align(&self) -> bool {
        self.fields && self.complete && self.equals.is_some()
    }

    fn width(&self) -> usize {
        2 * self.indent + self.text.chars().count()
    }

    fn has_line_end_comment(&self) -> bool {
        self.comment.is_some() && !self.text.is_empty()
    }
}

/// The text of all lines.
pub(super) fn assemble(mut lines: Vec<Line>) -> String {
    // Runs of neighbours are aligned; a line that holds none or an empty line ends a run.
    runs(&mut lines, Line::can_align, |run| {
        let column = run.iter().filter_map(|line| line.equals).max().unwrap_or(0);
        for line in run {
            if let Some(equals) = line.equals {
                line.text.insert_str(equals, &" ".repeat(column - equals));
            }
        }
    });
    runs(&mut lines, Line::has_line_end_comment, |run| {
        let column = run.iter().map(Line::width).max().unwrap_or(0) + 2;
        for line in run {
            let padding = column - line.width();
            line.text.push_str(&" ".repeat(padding));
        }
    });
    let mut out = String::new();
    let mut after_opener = true;
    for line in &lines {
        if line.blank_before && !after_opener && !line.is_closer {
            out.push('\n');
        }
        out.push_str(&"  ".repeat(line.indent));
        out.push_str(&line.text);
        out.push_str(line.comment.as_deref().unwrap_or(""));
        out.push('\n');
        after_opener = line.text.trim_end().ends_with(['{', '[', '(']);
    }
    out
}

/// Calls for each longest run of neighbours of one indent that belong to it.
fn runs(lines: &mut [Line], belongs: fn(&Line) -> bool, mut align: impl FnMut(&mut [Line])) {
    let mut start = 0;
    while start < lines.len() {
        let mut end = start + 1;
        while end < lines.len()
            && belongs(&lines[start])
            && belongs(&lines[end])
            && lines[end].indent == lines[start].indent
            && !lines[end].blank_before
        {
            end += 1;
        }
        if belongs(&lines[start]) {
            align(&mut lines[start..end]);
        }
        start = end;
    }
}
