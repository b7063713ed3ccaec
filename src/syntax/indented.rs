//! Layouts without braces, as in YAML, TOML and Pascal: a line that ends with `:`, `=` or `begin`, or a name in
//! brackets, and the fields in the lines below. Each is reported once, at its beginning; the text becomes a
//! declaration, or an object, in braces.

use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic};

pub(super) fn mend(draft: &mut Draft, tokens: &mut [Token]) {
    // nothing is reported again inside a reported part
    let mut told_until = 0;
    for i in 0..tokens.len() {
        let first = i == 0 || tokens[i - 1].kind == Kind::LineBreak;
        if !first || tokens[i].is_comment() || tokens[i].kind == Kind::LineBreak {
            continue;
        }
        let end = line_end(tokens, i);
        let quiet = tokens[i].start < told_until;
        let done = section(draft, tokens, i, end, quiet).or_else(|| block(draft, tokens, i, end, quiet));
        told_until = told_until.max(done.unwrap_or(0));
    }
}

fn line_end(tokens: &[Token], i: usize) -> usize {
    tokens[i..].iter().position(|t| t.kind == Kind::LineBreak).map_or(tokens.len(), |n| i + n)
}

fn indent(text: &str, token: &Token) -> usize {
    token.start - text[..token.start].rfind('\n').map_or(0, |n| n + 1)
}

/// The first tokens of the lines below, empty ones and comments left out.
fn lines_below(tokens: &[Token], end: usize) -> impl Iterator<Item = usize> {
    let starts = (end + 1..tokens.len()).filter(|k| tokens[*k - 1].kind == Kind::LineBreak);
    starts.filter(|k| tokens[*k].kind != Kind::LineBreak && !tokens[*k].is_comment())
}

/// `[train.ore]` at column 0, and lines `name = value` until the next header.
fn section(draft: &mut Draft, tokens: &mut [Token], i: usize, end: usize, quiet: bool) -> Option<usize> {
    let text = draft.original;
    let signs: Vec<&str> = tokens[i..end].iter().map(|t| t.text(text)).collect();
    let word = |n: usize| tokens[i + n].kind == Kind::Word;
    let header = match signs.as_slice() {
        ["[", kind, "]"] if word(1) => (*kind).to_owned(),
        ["[", kind, ".", name, "]"] if word(1) && word(3) => format!("{kind} {name}"),
        _ => return None,
    };
    let given = |k: &usize| field_sign(text, tokens, *k).is_some_and(|s| tokens[s].text(text) == "=");
    let last = lines_below(tokens, end).take_while(given).last()?;
    let stop = last_token(tokens, last)?;
    if !quiet {
        let at = draft.span(tokens[i].start, tokens[end - 1].end);
        let mistake = Diagnostic::new(Code::E0105, "a declaration needs braces").label(at, "its fields follow");
        draft.report(mistake.help(format!("write `{header} {{`, and `}}` behind its last field")));
    }
    for token in &mut tokens[i..end] {
        match token.text(text) {
            "[" | "." => draft.overwrite(token, ""),
            "]" => draft.overwrite(token, "{"),
            _ => continue,
        }
        token.kind = Kind::Comment;
    }
    draft.insertions.push((tokens[stop].end, '}'));
    Some(tokens[stop].end)
}

/// `train ore:` or `pad =` at the end of a line, and fields in the lines below with a larger indent.
fn block(draft: &mut Draft, tokens: &mut [Token], i: usize, end: usize, quiet: bool) -> Option<usize> {
    let text = draft.original;
    let last = (i..end).rev().find(|k| !tokens[*k].is_comment())?;
    let (sign, own) = (tokens[last].text(text), indent(text, &tokens[i]));
    let begins = sign == "begin" && own == 0;
    if !(matches!(sign, ":" | "=") || begins) || last == i {
        return None;
    }
    let plain = |t: &Token| t.kind == Kind::Word || matches!(t.text(text), "." | ":");
    if !tokens[i..last].iter().all(plain) {
        return None;
    }
    // at column 0 the words in front are a header, elsewhere the path of one field
    let words = tokens[i..last].windows(2).any(|w| w[0].kind == Kind::Word && w[1].kind == Kind::Word);
    if own > 0 && words || own == 0 && sign == "=" {
        return None;
    }
    let inner: Vec<usize> = lines_below(tokens, end).take_while(|k| indent(text, &tokens[*k]) > own).collect();
    let (first, signs) = (inner.first()?, inner.iter().map(|k| field_sign(text, tokens, *k)));
    let signs: Vec<usize> = signs.collect::<Option<_>>()?;
    let colons = signs.iter().any(|s| tokens[*s].text(text) == ":");
    if own == 0 && sign == ":" && !colons && !begins {
        // `header` looks for the bracket that closes such a declaration
        return None;
    }
    let level = indent(text, &tokens[*first]);
    let stop = last_token(tokens, *inner.last()?)?;
    if !quiet {
        let header = text[tokens[i].start..tokens[last].start].trim_end();
        let opened = if own == 0 { format!("{header} {{") } else { format!("{header} = {{") };
        let message = match own == 0 {
            true => "a declaration without braces around its fields",
            false => "an object without braces around its fields",
        };
        let at = draft.span(tokens[last].start, tokens[last].end);
        let mistake = Diagnostic::new(Code::E0105, message).label(at, "");
        draft.report(mistake.help(format!("write `{opened}`, and `}}` behind its last field, each as `name = value`")));
    }
    match own == 0 {
        true => draft.overwrite(&tokens[last], "{"),
        false => {
            draft.overwrite(&tokens[last], "=");
            draft.insertions.push((tokens[last].end, '{'));
        }
    }
    tokens[last].kind = Kind::Sign;
    for (line, sign) in inner.iter().zip(&signs) {
        let opens = last_token(tokens, *line) == Some(*sign);
        if indent(text, &tokens[*line]) == level && !opens {
            draft.overwrite(&tokens[*sign], "=");
            // it is now an ordinary sign
            tokens[*sign].kind = Kind::Comment;
        }
    }
    // a closing word is alone in the next line
    let behind = lines_below(tokens, end).nth(inner.len());
    let closer = behind.filter(|k| begins && tokens[*k].text(text) == "end");
    match closer {
        Some(k) => {
            draft.overwrite(&tokens[k], "}");
            tokens[k].kind = Kind::Comment;
        }
        None => draft.insertions.push((tokens[stop].end, '}')),
    }
    Some(tokens[stop].end)
}

/// The sign behind the path that a line begins with: `=` or `:`.
fn field_sign(text: &str, tokens: &[Token], mut i: usize) -> Option<usize> {
    while tokens.get(i).is_some_and(|t| t.kind == Kind::Word) {
        match tokens.get(i + 1).map_or("", |t| t.text(text)) {
            "." => i += 2,
            "=" | ":" => return Some(i + 1),
            _ => return None,
        }
    }
    None
}

/// The last token of a line that is no comment.
fn last_token(tokens: &[Token], i: usize) -> Option<usize> {
    (i..line_end(tokens, i)).rev().find(|k| !tokens[*k].is_comment())
}
