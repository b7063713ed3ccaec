//! Lines that load a module by the path of a file, as in other languages: `use "site.track"`, `use ../site/gravel`.
//! Each is reported once, with the right name of the module, and is not read.

use super::draft::Draft;
use super::token::{Kind, Token};
use crate::diag::{Code, Diagnostic, Fix};

pub(super) fn mend(draft: &mut Draft, tokens: &mut [Token]) {
    for i in 0..tokens.len() {
        let at = tokens[i].start;
        let starts_line = at == 0 || draft.original.as_bytes()[at - 1] == b'\n';
        if starts_line && tokens[i].kind == Kind::Word && tokens[i].text(draft.original) == "use" {
            by_file(draft, tokens, i);
        }
    }
}

fn by_file(draft: &mut Draft, tokens: &mut [Token], i: usize) {
    let line = draft.original[tokens[i].start..].lines().next().unwrap_or_default();
    let rest = line["use".len()..].split("//").next().unwrap_or_default();
    // `use http://x` is no comment
    let rest = if line.contains("://") { &line["use".len()..] } else { rest }.trim();
    let (path, alias) = match rest.rsplit_once(" as ") {
        Some((path, alias)) => (path.trim(), format!(" as {}", alias.trim())),
        None => (rest, String::new()),
    };
    if !path.contains(['"', '\'', '<', '\\', '/', '*']) && !path.starts_with('.') && !path.contains(":\\") {
        return;
    }
    let start = tokens[i].start;
    let end = start + line.trim_end().len();
    let plain = path.trim_matches(['"', '\'', '<', '>', ' ', ';']).replace('\\', "/");
    let outside = plain.starts_with('/') || plain.contains(":/") || plain.contains("..");
    let plain = plain.strip_suffix(".track").unwrap_or(&plain).trim_end_matches(".*");
    let parts: Vec<&str> = plain.split('/').filter(|part| !part.is_empty() && !part.starts_with('.')).collect();
    let name = match outside {
        true => parts.last().copied().unwrap_or_default().to_owned(),
        false => parts.join("."),
    };
    let help = match outside {
        true => format!("write `use {name}{alias}`: a module lies below the main file's folder, copy it there"),
        false => format!("write `use {name}{alias}`"),
    };
    let mistake = Diagnostic::new(Code::E0101, "write a module as names joined by dots, not as the path of a file");
    let place = draft.span(start, end);
    let fix = Fix::replace(place, format!("use {name}{alias}"));
    draft.report(mistake.label(place, "not the name of a module").help(help).fix(fix));
    for token in tokens[i..].iter_mut().take_while(|t| t.start < end) {
        if token.kind == Kind::LineBreak {
            break;
        }
        draft.overwrite(token, "");
        token.kind = Kind::Comment;
    }
}
