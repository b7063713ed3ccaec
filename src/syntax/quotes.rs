//! Quotes that do not match: a missing opening quote, quotes inside a text, a text over two lines. Each is reported
//! once, at the start of the text, and the text is read as an unknown value.

use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic, Fix};

pub(super) fn mend(draft: &mut Draft, tokens: &mut [Token]) {
    let mut i = 0;
    while i < tokens.len() {
        let line = tokens[i..].iter().position(|t| t.kind == Kind::LineBreak).map_or(tokens.len(), |n| i + n);
        if tokens[i..line].iter().any(|t| matches!(t.kind, Kind::Text { .. })) {
            lost_opening(draft, tokens, i, line);
            over_two_lines(draft, tokens, i, line);
            inside(draft, tokens, i, line);
        }
        i = line + 1;
    }
}

/// `title = Embankment to slab"`: a quote with nothing behind it, after words without quotes.
fn lost_opening(draft: &mut Draft, tokens: &mut [Token], first: usize, line: usize) {
    let text = draft.original;
    let alone = |t: &Token| t.kind == Kind::Text { closed: false } && t.text(text) == "\"";
    let Some(quote) = (first..line).find(|k| alone(&tokens[*k])) else { return };
    let opens = |t: &Token| matches!(t.kind, Kind::Open(_)) || matches!(t.text(text), "=" | ":");
    let Some(begin) = (first..quote).rev().find(|k| opens(&tokens[*k])).map(|k| k + 1).filter(|k| *k < quote) else {
        return;
    };
    let inner = text[tokens[begin].start..tokens[quote].start].trim_end();
    let inches = inner.chars().all(|c| c.is_ascii_digit() || c == '.');
    let help = match inches {
        true => format!(
            "a length in inches? {inner} in are {} mm (1 in = 25.4 mm)",
            crate::units::number(25.4 * inches_of(inner))
        ),
        false => format!("write `\"{inner}\"`"),
    };
    let mistake = Diagnostic::new(Code::E0106, "text without its opening quote");
    let fix = (!inches).then(|| format!("\"{inner}\""));
    told(draft, tokens, begin..quote + 1, mistake, "the text begins here", (help, fix));
}

fn inches_of(digits: &str) -> f64 {
    digits.parse().unwrap_or_default()
}

/// A text that continues in the next line and is closed there.
fn over_two_lines(draft: &mut Draft, tokens: &mut [Token], first: usize, line: usize) {
    let text = draft.original;
    let Some(open) = (first..line).find(|k| tokens[*k].kind == Kind::Text { closed: false }) else { return };
    let next = line + 1;
    let end = (next..tokens.len()).find(|k| tokens[*k].kind == Kind::LineBreak).unwrap_or(tokens.len());
    let quotes = |t: &Token| matches!(t.kind, Kind::Text { .. });
    let Some(close) = (next..end).find(|k| quotes(&tokens[*k])) else { return };
    let fields = tokens[next..close].iter().any(|t| matches!(t.text(text), "=" | ":" | "{" | "}"));
    if fields || close == next || tokens[close].text(text) != "\"" {
        return;
    }
    let (start, stop) = (tokens[open].start, tokens[close].end);
    let one_line = text[start..stop].split_whitespace().collect::<Vec<_>>().join(" ");
    let mistake = Diagnostic::new(Code::E0106, "a text over two lines")
        .label(draft.span(start, tokens[open].end), "it begins here");
    let fix = Fix::replace(draft.span(start, stop), one_line.as_str());
    draft.report(mistake.help(format!("a text must be on one line: write `{one_line}`")).fix(fix));
    poison(draft, tokens, open..open + 1);
    for token in &mut tokens[next..=close] {
        draft.overwrite(token, "");
        token.kind = Kind::Comment;
    }
}

/// `""doubled""`, `"""three"""` and `"a "quoted" word"`: texts that touch words or each other.
fn inside(draft: &mut Draft, tokens: &mut [Token], first: usize, line: usize) {
    let text = draft.original;
    let closed = |k: usize| tokens[k].kind == Kind::Text { closed: true };
    let touch =
        |k: usize| tokens[k].end == tokens[k + 1].start && !matches!(tokens[k + 1].kind, Kind::Close(_) | Kind::Sign);
    let Some(begin) = (first..line.saturating_sub(1)).find(|k| closed(*k) && touch(*k)) else { return };
    let Some(last) = (begin + 1..line).rev().find(|k| closed(*k)) else { return };
    let whole = &text[tokens[begin].start..tokens[last].end];
    let doubled = whole.starts_with("\"\"") && whole.ends_with("\"\"");
    let inner = if doubled { whole.trim_matches('"') } else { &whole[1..whole.len() - 1] };
    let written = format!("\"{}\"", inner.replace('"', "\\\""));
    let help = match inner.contains('"') {
        true => format!("a quote inside a text is written `\\\"`: `{written}`"),
        false => format!("write `{written}`"),
    };
    let mistake = Diagnostic::new(Code::E0105, "quotes inside quotes");
    told(draft, tokens, begin..last + 1, mistake, "", (help, Some(written)));
}

fn told(
    draft: &mut Draft,
    tokens: &mut [Token],
    range: std::ops::Range<usize>,
    mistake: Diagnostic,
    label: &str,
    (help, written): (String, Option<String>),
) {
    let place = draft.span(tokens[range.start].start, tokens[range.end - 1].end);
    let fix = written.map(|written| Fix::replace(place, written));
    draft.report(mistake.label(place, label).help(help).maybe_fix(fix));
    poison(draft, tokens, range);
}

/// Reads tokens as one unknown value.
fn poison(draft: &mut Draft, tokens: &mut [Token], range: std::ops::Range<usize>) {
    for (n, token) in tokens[range].iter_mut().enumerate() {
        draft.overwrite(token, if n == 0 { "?" } else { "" });
        if n == 0 {
            draft.poisoned.insert(token.start);
        }
        token.kind = if n == 0 { Kind::Word } else { Kind::Comment };
    }
}
