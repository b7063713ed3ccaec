//! Headers of declarations in the spelling of other languages, on one line: `train "ore" {`, `train.ore {`,
//! `trackform stiff(open) {`, `train(speed = 70 km/h)`. Each is reported once and replaced by the right header.

use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic, Fix};

const EXTENDS: [&str; 6] = ["extends", "inherits", "from", "is", "based_on", "of"];

pub(super) fn mend(draft: &mut Draft, tokens: &mut [Token]) {
    // open brackets: in unformatted text a field may also begin its line
    let mut depth = 0_usize;
    for i in 0..tokens.len() {
        match tokens[i].kind {
            Kind::Open(_) => depth += 1,
            Kind::Close(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
        let at = tokens[i].start;
        let starts_line = at == 0 || draft.original.as_bytes()[at - 1] == b'\n';
        if depth == 0 && starts_line && tokens[i].kind == Kind::Word {
            match tokens[i].text(draft.original) {
                "use" => {}
                "let" => digit_first(draft, tokens, i + 1, "let "),
                _ => header(draft, tokens, i),
            }
        }
    }
}

fn header(draft: &mut Draft, tokens: &mut [Token], i: usize) {
    let text = draft.original;
    let end = tokens[i..].iter().position(|t| t.kind == Kind::LineBreak).map_or(tokens.len(), |n| i + n);
    let open = (i..end).find(|k| tokens[*k].kind == Kind::Open('{'));
    if open.is_none() {
        return arguments(draft, tokens, i, end);
    }
    let open = open.unwrap_or(end);
    let head = &tokens[i..open];
    let kinds: Vec<Kind> = head.iter().map(|t| t.kind).collect();
    let words: Vec<&str> = head.iter().map(|t| t.text(text)).collect();
    let kind = words[0];
    const W: Kind = Kind::Word;
    // the text to write over the tokens behind the kind, and the right header
    let (over, written): (Vec<(usize, String)>, String) = match (kinds.as_slice(), words.as_slice()) {
        ([W, Kind::Text { closed: true }], [_, name]) => {
            let inner = name.trim_matches('"');
            let plain = inner.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            if !plain || !inner.starts_with(|c: char| c.is_ascii_alphabetic()) {
                return;
            }
            tokens[i + 1].kind = W;
            (vec![(1, format!(" {inner}"))], format!("{kind} {inner}"))
        }
        ([W, Kind::Sign, W], [_, ".", name]) => (vec![(1, String::new())], format!("{kind} {name}")),
        ([W, W, Kind::Sign], [_, name, ","]) => (vec![(2, String::new())], format!("{kind} {name}")),
        ([W, W, Kind::Open('('), W, Kind::Close(')')], [_, name, _, base, _]) => {
            tokens[i + 2].kind = Kind::Sign;
            tokens[i + 4].kind = Kind::Comment;
            (vec![(2, ":".to_owned()), (4, String::new())], format!("{kind} {name} : {base}"))
        }
        ([W, W, W, rest @ ..], [_, name, word, base @ ..]) if EXTENDS.contains(word) && !rest.is_empty() => {
            (vec![(2, ":".to_owned())], format!("{kind} {name} : {}", base.concat()))
        }
        ([W, W, Kind::Sign, W], [_, name, "<", base]) => (vec![(2, ":".to_owned())], format!("{kind} {name} : {base}")),
        ([W, W, Kind::Sign, Kind::Number], [_, name, "-", rest]) => {
            draft.bytes[tokens[i + 2].start] = b'_';
            (Vec::new(), format!("{kind} {name}_{rest}"))
        }
        ([W, W, Kind::Number], [_, name, number]) => {
            for at in tokens[i + 1].end..tokens[i + 2].start {
                draft.bytes[at] = b'_';
            }
            (Vec::new(), format!("{kind} {name}_{number}"))
        }
        ([W, Kind::Number, ..], _) => return digit_first(draft, tokens, i + 1, &format!("{kind} ")),
        _ => return,
    };
    let wrong = match over.first() {
        Some((n, _)) => tokens[i + n],
        None => tokens[i + 2],
    };
    let mistake = Diagnostic::new(Code::E0105, "a declaration is `kind name : base { field = value }`");
    let place = draft.span(tokens[i].start, tokens[open].start);
    let mistake = mistake.label(draft.span(wrong.start, wrong.end), "").help(format!("write `{written} {{`"));
    draft.report(mistake.fix(Fix::replace(place, format!("{written} "))));
    for (n, new) in over {
        let token = tokens[i + n];
        draft.overwrite(&token, &new);
        if new.is_empty() {
            tokens[i + n].kind = Kind::Comment;
        }
    }
}

/// `train(speed = 70 km/h)`, and `ore = train(speed = 70 km/h)`, on one line.
fn arguments(draft: &mut Draft, tokens: &mut [Token], i: usize, end: usize) {
    let text = draft.original;
    let sign = |k: usize| tokens.get(k).filter(|_| k < end).map_or("", |t| t.text(text));
    let word = |k: usize| k < end && tokens.get(k).is_some_and(|t| t.kind == Kind::Word);
    let (kind, named) = match word(i + 2) && sign(i + 1) == "=" && sign(i + 3) == "(" {
        true => (i + 2, true),
        false => (i, false),
    };
    let open = kind + 1;
    let first_field = word(open + 1) && sign(open + 2) == "=";
    let close = (open..end).rev().find(|k| !tokens[*k].is_comment()).filter(|k| sign(*k) == ")");
    let (Some(close), true) = (close, sign(open) == "(" && first_field) else { return };
    let fields = text[tokens[open].end..tokens[close].start].trim();
    let header = match named {
        true => format!("{} {}", sign(kind), sign(i)),
        false => sign(i).to_owned(),
    };
    let mistake = Diagnostic::new(Code::E0105, "the fields of a declaration need braces");
    let at = draft.span(tokens[open].start, tokens[open].end);
    let whole = draft.span(tokens[i].start, tokens[close].end);
    draft.report(mistake.label(at, "").write(whole, format!("{header} {{ {fields} }}")));
    if named {
        // the two names are swapped: both are words, and blanks have no meaning
        let (name, kind_text) = (sign(i).to_owned(), sign(kind).to_owned());
        let whole = Token { start: tokens[i].start, end: tokens[kind].end, ..tokens[i] };
        draft.overwrite(&whole, &format!("{kind_text} {name}"));
        tokens[i + 1].kind = Kind::Comment;
    }
    draft.overwrite(&tokens[open], "{");
    draft.overwrite(&tokens[close], "}");
    tokens[open].kind = Kind::Open('{');
    tokens[close].kind = Kind::Close('}');
}

/// `let 2k = 5 mm`: a name that begins with a digit.
fn digit_first(draft: &mut Draft, tokens: &mut [Token], i: usize, before: &str) {
    let text = draft.original;
    let (Some(number), Some(word)) = (tokens.get(i).copied(), tokens.get(i + 1).copied()) else { return };
    if number.kind != Kind::Number || word.kind != Kind::Word || number.end != word.start {
        return;
    }
    let (digits, letters) = (number.text(text), word.text(text));
    let mistake = Diagnostic::new(Code::E0101, format!("a name must begin with a letter, not with `{digits}`"));
    let at = draft.span(number.start, word.end);
    let help = format!("write `{before}{letters}{digits}`");
    draft.report(mistake.label(at, "").help(help).fix(Fix::replace(at, format!("{letters}{digits}"))));
    draft.overwrite(&number, "");
    tokens[i].kind = Kind::Comment;
}
