//! Signs of other languages and of word processors: each is reported with the right form of the user's text, and
//! replaced by that form with the same number of bytes, so that the parser continues with the right form.
//!
//! This module handles only signs that are never right; the grammar reports signs at a wrong place.

use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic, Edit, Fix};

/// Signs that look like signs of this language.
const LOOK_ALIKES: [(&str, &str); 9] =
    [("−", "-"), ("–", "-"), ("—", "-"), ("≤", "<="), ("≥", ">="), ("×", "*"), ("÷", "/"), ("…", ".."), ("∙", "*")];

/// Reports and replaces the foreign signs of a text. If its brackets are not balanced, only brackets opened on the same
/// line show the context of a sign.
pub(super) fn replace(draft: &mut Draft, tokens: &[Token], balanced: bool) {
    let mut brackets = Vec::new();
    // a habit repeats along a line and is reported once
    let mut told: Vec<&str> = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        let text = token.text(draft.original);
        match token.kind {
            Kind::LineBreak => {
                told.clear();
                if !balanced {
                    brackets.clear();
                }
            }
            Kind::Open(c) => brackets.push(c),
            Kind::Close(_) => {
                brackets.pop();
            }
            Kind::ForeignComment => {
                draft.overwrite(token, "");
                let words = text.trim_start_matches(['#', '-', '%', '!', '\'']);
                let included =
                    words.trim().strip_prefix("include").map(|name| name.trim().trim_matches(['<', '>', '"']));
                let sign = if text.starts_with("--") { "--" } else { &text[..1] };
                let help = match included {
                    Some(name) => format!("write `use {name}`"),
                    None => format!("write `// {}`", words.trim()),
                };
                let fix =
                    help.strip_prefix("write `").and_then(|text| text.strip_suffix('`')).unwrap_or_default().to_owned();
                mend(draft, token, format!("`{sign}` does not begin a comment"), help, &fix);
            }
            Kind::BlockComment => block_comment(draft, token),
            Kind::OddText => odd_text(draft, token),
            Kind::Text { closed: false } => {
                draft.overwrite(token, "?");
                draft.poisoned.insert(token.start);
                let (place, closed) = (draft.span(token.start, token.end), text.trim_end());
                let mistake = Diagnostic::new(Code::E0106, "text without its closing quote")
                    .label(place, "opened here, and still open at the end of the line")
                    .write(place, format!("{}\"", closed.trim_end_matches(['\'', '’', '”', '`'])));
                draft.report(mistake);
            }
            Kind::Sign => match text {
                "->" | "::" if in_header(draft.original, tokens, i) => {
                    draft.overwrite(token, ":");
                    let help = format!("write `{}`", rewritten(draft.original, tokens, i, " : "));
                    mend(draft, token, format!("`{text}` is not a sign of this language"), help, ":");
                }
                "–" | "—" if between_ends(draft.original, tokens, i) => {
                    draft.overwrite(token, "..");
                    let help = format!("write `{}`", rewritten(draft.original, tokens, i, " .. "));
                    mend(draft, token, "a dash between the ends of a range", help, " .. ");
                }
                ";" | "=>" | ":=" | "=<" | "->" if told.contains(&text) => {
                    draft.overwrite(token, replacement(text, brackets.last()));
                }
                ";" => {
                    draft.overwrite(token, ",");
                    told.push(text);
                    let (first, _) = item_around(draft.original, tokens, i);
                    let item = draft.written(tokens[first].start, token.start);
                    let help = match bracket_around(draft.original, tokens, i) {
                        Some(whole) => format!("write `{}`", whole.replace(';', ",")),
                        None if item.is_empty() => "remove it".to_owned(),
                        None => format!("write `{item}`"),
                    };
                    let fix = alike(draft, tokens, i, ",");
                    let message = "`;` does not end an item: a line break or a comma does";
                    report(draft, token, message, help, Some(fix));
                }
                "=>" if brackets.last() == Some(&'[') => {
                    draft.overwrite(token, ":");
                    told.push(text);
                    let help = format!(
                        "write `{}` for a pair, `{}` for a comparison",
                        rewritten(draft.original, tokens, i, ": "),
                        rewritten(draft.original, tokens, i, " >= ")
                    );
                    report(draft, token, "`=>` is not a sign of this language", help, None);
                }
                "=>" | ":=" | "=<" | "->" => {
                    let right = replacement(text, brackets.last());
                    draft.overwrite(token, right);
                    told.push(text);
                    let joint = if right == ":" { ": ".to_owned() } else { format!(" {right} ") };
                    let help = format!("write `{}`", rewritten(draft.original, tokens, i, &joint));
                    let fix = alike(draft, tokens, i, right);
                    report(draft, token, format!("`{text}` is not a sign of this language"), help, Some(fix));
                }
                _ if wide(draft, token, &mut told) => {}
                _ => look_alike(draft, tokens, i),
            },
            _ => {}
        }
    }
}

/// Whether a sign follows a name in a line that begins at column 0.
fn in_header(text: &str, tokens: &[Token], i: usize) -> bool {
    let line = text[..tokens[i].start].rfind('\n').map_or(0, |n| n + 1);
    let header = &text[line..tokens[i].start];
    let plain = |c: char| c.is_ascii_alphanumeric() || "_ ".contains(c);
    header.starts_with(|c: char| c.is_ascii_alphabetic())
        && header.chars().all(plain)
        && !header.starts_with("let ")
        && !header.starts_with("use ")
}

/// Whether a sign is between two numbers, the first perhaps with its unit.
fn between_ends(text: &str, tokens: &[Token], i: usize) -> bool {
    let number = |token: Option<&Token>| token.is_some_and(|t| t.kind == Kind::Number);
    let signed =
        tokens.get(i + 1).is_some_and(|t| matches!(t.text(text), "-" | "+" | "−")) && number(tokens.get(i + 2));
    let behind = i > 0 && matches!(tokens[i - 1].kind, Kind::Number | Kind::Word);
    behind && (number(tokens.get(i + 1)) || signed)
}

/// The replacement of a foreign sign inside this bracket.
fn replacement(sign: &str, bracket: Option<&char>) -> &'static str {
    match sign {
        ";" => ",",
        "=<" => "<=",
        "=>" | "->" if bracket == Some(&'[') => ":",
        _ => "=",
    }
}

/// The brackets around a token with their content and the unit behind, if they begin and end on its line.
fn bracket_around<'t>(text: &'t str, tokens: &[Token], i: usize) -> Option<&'t str> {
    let mut depth = 0;
    let mut first = i;
    loop {
        first = first.checked_sub(1)?;
        match tokens[first].kind {
            Kind::LineBreak => return None,
            Kind::Close(_) => depth += 1,
            Kind::Open('[' | '(') if depth == 0 => break,
            Kind::Open(_) if depth == 0 => return None,
            Kind::Open(_) => depth -= 1,
            _ => {}
        }
    }
    for token in &tokens[i..] {
        match token.kind {
            Kind::LineBreak => return None,
            Kind::Open(_) => depth += 1,
            Kind::Close(_) if depth == 0 => return Some(&text[tokens[first].start..token.end]),
            Kind::Close(_) => depth -= 1,
            _ => {}
        }
    }
    None
}

fn report(draft: &mut Draft, token: &Token, message: impl Into<String>, help: String, fix: Option<Fix>) {
    let end = draft.original[token.start..token.end].find('\n').map_or(token.end, |i| token.start + i);
    let mistake = Diagnostic::new(Code::E0105, message).label(draft.span(token.start, end), "").help(help);
    draft.report(mistake.maybe_fix(fix));
}

/// Reports a token that must be replaced by another text.
fn mend(draft: &mut Draft, token: &Token, message: impl Into<String>, help: String, text: &str) {
    let fix = Fix::replace(draft.span(token.start, token.end), text);
    report(draft, token, message, help, Some(fix));
}

/// Replaces a sign, and all equal signs behind it on the line, which are reported with it.
fn alike(draft: &Draft, tokens: &[Token], i: usize, sign: &str) -> Fix {
    let wrong = tokens[i].text(draft.original);
    let line = tokens[i..].iter().take_while(|token| token.kind != Kind::LineBreak);
    let same = line.filter(|token| token.kind == Kind::Sign && token.text(draft.original) == wrong);
    let edits = same.map(|token| Edit { span: draft.span(token.start, token.end), text: sign.to_owned() });
    Fix { title: format!("write `{sign}` for `{wrong}`"), edits: edits.collect() }
}

fn block_comment(draft: &mut Draft, token: &Token) {
    let text = token.text(draft.original);
    draft.overwrite(token, "");
    let inner = text.trim_start_matches("/*").trim_end_matches("*/");
    let lines = inner.lines().map(|l| l.trim().trim_start_matches('*').trim()).filter(|l| !l.is_empty());
    let first = lines.clone().next().unwrap_or("");
    let mut written = lines.clone().map(|line| format!("// {line}")).collect::<Vec<_>>().join("\n");
    let behind = draft.original[token.end..].lines().next().unwrap_or_default();
    if !behind.trim().is_empty() {
        written.push('\n');
    }
    let help = if lines.count() > 1 {
        format!("begin each of its lines with `//`: `// {first}`")
    } else {
        format!("write `// {first}`, with nothing behind it on its line")
    };
    mend(draft, token, "`/* */` is not a comment here", help, &written);
}

fn odd_text(draft: &mut Draft, token: &Token) {
    let text = token.text(draft.original);
    let mut inner = text.chars();
    inner.next();
    inner.next_back();
    let inner = inner.as_str();
    let right = format!("\"{inner}\"");
    if inner.contains(['"', '\\']) || right.len() > text.len() {
        draft.overwrite(token, "?");
        draft.poisoned.insert(token.start);
    } else {
        draft.overwrite(token, &right);
    }
    let right = format!("\"{}\"", inner.replace('\\', "\\\\").replace('"', "\\\""));
    mend(draft, token, "text needs double quotes", format!("write `{right}`"), &right);
}

/// Signs of a Chinese or Japanese keyboard, with the blank that follows them.
const WIDE: [(&str, &str); 12] = [
    ("＝", "= "),
    ("：", ": "),
    ("，", ", "),
    ("、", ", "),
    ("；", ", "),
    ("（", "("),
    ("）", ")"),
    ("【", "["),
    ("】", "]"),
    ("％", "%"),
    ("＜", "< "),
    ("＞", "> "),
];

/// A wide sign is reported once per line, with the right line.
fn wide(draft: &mut Draft, token: &Token, known: &mut Vec<&str>) -> bool {
    let text = token.text(draft.original);
    let Some((_, right)) = WIDE.iter().find(|(wide, _)| *wide == text) else { return false };
    draft.overwrite(token, right.trim_end());
    if !known.contains(&"wide") {
        known.push("wide");
        let start = draft.original[..token.start].rfind('\n').map_or(0, |n| n + 1);
        let line = draft.original[start..].lines().next().unwrap_or_default();
        let mended = WIDE.iter().fold(line.to_owned(), |line, (wide, right)| line.replace(wide, right));
        let mended = mended.split_whitespace().collect::<Vec<_>>().join(" ");
        let help = format!("write `{mended}`");
        let place = draft.span(start, start + line.len());
        let indent: String = line.chars().take_while(|c| c.is_whitespace()).collect();
        let fix = Fix::replace(place, format!("{indent}{mended}"));
        let message = format!("`{text}` looks like `{}` but is another character", right.trim_end());
        report(draft, token, message, help, Some(fix));
    }
    true
}

fn look_alike(draft: &mut Draft, tokens: &[Token], i: usize) {
    let text = tokens[i].text(draft.original);
    if let Some((_, right)) = LOOK_ALIKES.iter().find(|(wrong, _)| *wrong == text) {
        draft.overwrite(&tokens[i], right);
        let spaced = if *right == "-" { right.to_string() } else { format!(" {right} ") };
        let help = format!("write `{}`", rewritten(draft.original, tokens, i, &spaced));
        mend(draft, &tokens[i], format!("`{text}` looks like `{right}` but is another character"), help, right);
    } else if text.chars().all(|c| c.is_whitespace() || matches!(c, '\u{200b}' | '\u{feff}' | '\u{2060}')) {
        draft.overwrite(&tokens[i], "");
        let code = text.chars().next().map_or(0, u32::from);
        let help = "replace it by an ordinary blank".to_owned();
        mend(draft, &tokens[i], format!("blank of another kind (U+{code:04X})"), help, " ");
    }
}

/// The part of the item on the token's line, with another sign instead of the token.
fn rewritten(text: &str, tokens: &[Token], i: usize, sign: &str) -> String {
    let (first, last) = item_around(text, tokens, i);
    let before = text[tokens[first].start..tokens[i].start].trim_end();
    let after = text[tokens[i].end..tokens[last].end].trim_start();
    let unary = sign == "-" && before.ends_with(['=', '(', '[', ':', '.', '*', '/', ',']);
    let joint = if unary {
        " -"
    } else if sign == "-" && !before.is_empty() {
        " - "
    } else {
        sign
    };
    format!("{before}{joint}{after}").trim().to_owned()
}

/// The first and last token of the item around a token, on its line.
fn item_around(text: &str, tokens: &[Token], i: usize) -> (usize, usize) {
    let ends = |t: &Token| t.kind == Kind::LineBreak || t.is_comment() || matches!(t.text(text), "," | ";");
    let mut depth = 0;
    let mut first = i;
    while first > 0 && i - first < 100 && !ends(&tokens[first - 1]) {
        match tokens[first - 1].kind {
            Kind::Close(_) => depth += 1,
            Kind::Open(_) if depth == 0 => break,
            Kind::Open(_) => depth -= 1,
            _ => {}
        }
        first -= 1;
    }
    let mut last = i;
    while last + 1 < tokens.len() && last - i < 100 && !ends(&tokens[last + 1]) {
        match tokens[last + 1].kind {
            Kind::Open(_) => depth += 1,
            Kind::Close(_) if depth <= 0 => break,
            Kind::Close(_) => depth -= 1,
            _ => {}
        }
        last += 1;
    }
    (first, last)
}
