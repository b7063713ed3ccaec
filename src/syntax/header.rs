//! Declarations that open with another sign than `{`, and lists with dashes: spellings that end several lines later.
//! Each is reported once and replaced by the right text before the brackets are checked.

use super::balance::starts_field;
use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic, Edit, Fix};

/// Corrects a draft with these tokens. Corrected brackets are no longer brackets in `tokens`.
pub(super) fn mend(draft: &mut Draft, tokens: &mut [Token]) {
    for i in 0..tokens.len() {
        let token = tokens[i];
        let starts_line = token.start == 0 || draft.original.as_bytes()[token.start - 1] == b'\n';
        if token.kind == Kind::Word && starts_line && !matches!(token.text(draft.original), "use" | "let") {
            open(draft, tokens, i);
        } else if token.kind == Kind::Sign && matches!(token.text(draft.original), ":" | "=") {
            dashes(draft, tokens, i);
        }
    }
}

/// A header from the `i`-th token on that continues with `(`, `[`, `:` or nothing, if fields follow in the next lines.
fn open(draft: &mut Draft, tokens: &mut [Token], i: usize) {
    let text = draft.original;
    let kind = |k: usize| tokens.get(k).map(|t| t.kind);
    let mut next = i + 1 + usize::from(kind(i + 1) == Some(Kind::Word));
    let bare = next;
    if tokens.get(next).is_some_and(|t| t.text(text) == ":") && kind(next + 1) == Some(Kind::Word) {
        next += 1;
        while kind(next) == Some(Kind::Word) {
            next += if tokens.get(next + 1).is_some_and(|t| t.text(text) == ".") { 2 } else { 1 };
        }
    }
    let last = tokens[next.min(tokens.len()) - 1];
    let sign = tokens.get(next).copied();
    let bracket = matches!(sign.map(|t| t.kind), Some(Kind::Open('(' | '[')));
    let colon = next == bare && sign.is_some_and(|t| t.text(text) == ":");
    let Some(first) = first_of_next_line(tokens, next + usize::from(bracket || colon)) else { return };
    let indented = tokens[first].start > 0 && text.as_bytes()[tokens[first].start - 1] != b'\n';
    if !indented || !starts_field(text, tokens, first) {
        return;
    }
    let header = text[tokens[i].start..last.end].trim_end();
    let closer = closer(text, tokens, first);
    let message = match sign.filter(|_| bracket || colon) {
        Some(sign) => format!("`{}` does not open a declaration: its fields need braces", sign.text(text)),
        None => "a declaration without braces around its fields".to_owned(),
    };
    let at = sign.filter(|_| bracket || colon).unwrap_or(last);
    let mut mistake = Diagnostic::new(Code::E0105, message).label(draft.span(at.start, at.end), "");
    let mut help = format!("write `{header} {{`");
    if let Some(wrong) = closer.map(|k| tokens[k]).filter(|t| t.kind != Kind::Close('}')) {
        mistake = mistake.label(draft.span(wrong.start, wrong.end), "`}` closes it");
    } else if closer.is_none() {
        help += ", and `}` behind its last field";
    }
    let opening = match bracket || colon {
        true => Edit { span: draft.span(at.start, at.end), text: if colon { " {" } else { "{" }.to_owned() },
        false => Edit { span: draft.span(last.end, last.end), text: " {".to_owned() },
    };
    let closing = closer.map(|k| Edit { span: draft.span(tokens[k].start, tokens[k].end), text: "}".to_owned() });
    let closing = closing.unwrap_or_else(|| {
        let end = end_of_fields(text, tokens, first).unwrap_or(last.end);
        Edit { span: draft.span(end, end), text: "\n}".to_owned() }
    });
    let fix = Fix { title: "put the fields into braces".to_owned(), edits: vec![opening, closing] };
    draft.report(mistake.help(help).fix(fix));
    if bracket || colon {
        draft.overwrite(&at, "{");
    } else {
        draft.insertions.push((last.end, '{'));
    }
    match closer {
        Some(k) => {
            draft.overwrite(&tokens[k], "}");
            tokens[k].kind = Kind::Sign;
        }
        None => draft.insertions.push((end_of_fields(text, tokens, first).unwrap_or(last.end), '}')),
    }
    if bracket || colon {
        tokens[next].kind = Kind::Sign;
    }
}

/// The end of the fields that begin at `first`: before the next item of the file.
fn end_of_fields(text: &str, tokens: &[Token], first: usize) -> Option<usize> {
    let item = |t: &Token| t.kind == Kind::Word && text.as_bytes()[t.start - 1] == b'\n';
    let end = tokens[first..].iter().position(item).map_or(tokens.len(), |k| first + k);
    tokens[first..end].iter().rev().find(|t| t.kind != Kind::LineBreak && !t.is_comment()).map(|t| t.end)
}

/// The first token of the next line, if the line of these tokens ends behind them.
fn first_of_next_line(tokens: &[Token], from: usize) -> Option<usize> {
    let next = (from..tokens.len()).find(|k| !tokens[*k].is_comment())?;
    let broken = tokens[next].kind == Kind::LineBreak;
    (next..tokens.len()).find(|k| tokens[*k].kind != Kind::LineBreak && !tokens[*k].is_comment()).filter(|_| broken)
}

/// The closing bracket at the start of a line that ends the fields from `first` on, before another item begins.
fn closer(text: &str, tokens: &[Token], first: usize) -> Option<usize> {
    let starts_line = |t: &Token| t.start == 0 || text.as_bytes()[t.start - 1] == b'\n';
    let ends = |t: &Token| starts_line(t) && matches!(t.kind, Kind::Close(_) | Kind::Word);
    let found = first + tokens[first..].iter().position(ends)?;
    matches!(tokens[found].kind, Kind::Close(_)).then_some(found)
}

/// A list by dashes, one item a line, behind the sign at `i`.
fn dashes(draft: &mut Draft, tokens: &mut [Token], i: usize) {
    let text = draft.original;
    let is_dash = |k: usize| tokens[k].text(text) == "-" && text[tokens[k].end..].starts_with([' ', '\t']);
    let Some(first) = first_of_next_line(tokens, i + 1).filter(|k| is_dash(*k)) else { return };
    let (mut dash, mut starts, mut items, mut end) = (Some(first), Vec::new(), Vec::new(), tokens[first].end);
    while let Some(k) = dash {
        let stop = (k..tokens.len()).find(|j| tokens[*j].kind == Kind::LineBreak).unwrap_or(tokens.len());
        let Some(last) = tokens[k + 1..stop].iter().rfind(|t| !t.is_comment()) else { break };
        items.push(text[tokens[k].end..last.end].trim());
        starts.push(k);
        end = last.end;
        dash = first_of_next_line(tokens, stop).filter(|k| is_dash(*k));
    }
    if starts.is_empty() {
        return;
    }
    let line = text[..tokens[i].start].rfind('\n').map_or(0, |n| n + 1);
    let field = text[line..tokens[i].start].trim();
    let field = field.rsplit(['{', ',']).next().unwrap_or(field).trim();
    let at = draft.span(tokens[first].start, tokens[first].end);
    let mistake = Diagnostic::new(Code::E0105, "a list needs brackets, not dashes").label(at, "");
    draft.report(mistake.help(format!("write `{field} = [{}]`", items.join(", "))));
    draft.overwrite(&tokens[i], "=");
    draft.insertions.push((tokens[i].end, '['));
    draft.insertions.push((end, ']'));
    for k in starts {
        draft.overwrite(&tokens[k], "");
        tokens[k].kind = Kind::Comment;
    }
}
