//! Formats a text: the same tokens, comments included, with standard blanks and line breaks.
//!
//! A bracket that is broken over lines stays broken, another bracket stays on its line. The writer chooses the number
//! of items per line. Only indentation, blanks, commas at line ends and alignment change ([`super::layout`]).

use pest::Parser;

use super::grammar::{Grammar, Rule};
use super::layout::{self, Line};
use super::parse::parse;
use super::token::{Kind, tokens};
use crate::diag::{Diagnostic, FileId, has_errors};

/// The text in standard layout; or its mistakes, if it cannot be read. Line ends become `\n`.
pub fn format(text: &str) -> Result<String, Vec<Diagnostic>> {
    let (_, diagnostics) = parse(FileId(0), text);
    if has_errors(&diagnostics) {
        return Err(diagnostics);
    }
    let mut atoms = atoms(text);
    join(&mut atoms);
    drop_commas(&mut atoms);
    Ok(layout::assemble(lines(&split(atoms))))
}

/// A unit of the layout: a token, or several tokens that stay together.
#[derive(Debug, Clone, PartialEq)]
enum Atom {
    Word(String),
    Number(String),
    Unit(String),
    Text(String),
    Open(char),
    Close(char),
    Sign(String),
    Comment(String),
    /// One or more line breaks; `blank` if a line between them was empty.
    Break {
        blank: bool,
    },
}

impl Atom {
    fn is_sign(&self, sign: &str) -> bool {
        matches!(self, Atom::Sign(s) if s == sign)
    }

    fn is_break(&self) -> bool {
        matches!(self, Atom::Break { .. })
    }

    /// Whether a line may continue after it.
    fn goes_on(&self) -> bool {
        matches!(self, Atom::Sign(s) if !matches!(s.as_str(), "," | "?" | "."))
    }
}

fn atoms(text: &str) -> Vec<Atom> {
    let mut out: Vec<Atom> = Vec::new();
    let mut until = 0;
    for token in tokens(text) {
        if token.start < until {
            continue;
        }
        let words = token.text(text).to_owned();
        let atom = match token.kind {
            Kind::LineBreak => {
                match out.last_mut() {
                    Some(Atom::Break { blank }) => *blank = true,
                    _ => out.push(Atom::Break { blank: false }),
                }
                continue;
            }
            Kind::Comment => Atom::Comment(words.trim_end().to_owned()),
            Kind::Text { .. } => Atom::Text(words),
            Kind::Number => Atom::Number(words),
            Kind::Word => Atom::Word(words),
            Kind::Open(c) => Atom::Open(c),
            Kind::Close(c) => Atom::Close(c),
            // Foreign kinds have been refused before.
            _ => Atom::Sign(words),
        };
        let takes_unit = matches!(atom, Atom::Number(_) | Atom::Close(']'));
        out.push(atom);
        if takes_unit {
            let rest = &text[token.end..];
            let start = rest.len() - rest.trim_start_matches([' ', '\t']).len();
            if let Some(unit) = Grammar::parse(Rule::unit, &rest[start..]).ok().and_then(|mut pairs| pairs.next()) {
                out.push(Atom::Unit(unit.as_str().split_whitespace().collect::<Vec<_>>().join(" ")));
                until = token.end + start + unit.as_span().end();
            }
        }
    }
    out
}

/// Removes the line breaks inside an item: behind a sign, and before the `{` of a declaration.
fn join(atoms: &mut Vec<Atom>) {
    let mut depth = 0_usize;
    let mut kept: Vec<Atom> = Vec::with_capacity(atoms.len());
    let mut rest = std::mem::take(atoms).into_iter().peekable();
    while let Some(atom) = rest.next() {
        match atom {
            Atom::Open(_) => depth += 1,
            Atom::Close(_) => depth = depth.saturating_sub(1),
            Atom::Break { .. } => {
                let header = depth == 0
                    && rest.peek() == Some(&Atom::Open('{'))
                    && !matches!(kept.last(), None | Some(Atom::Comment(_)));
                if header || kept.last().is_some_and(Atom::goes_on) && !matches!(rest.peek(), Some(Atom::Comment(_))) {
                    continue;
                }
            }
            _ => {}
        }
        kept.push(atom);
    }
    *atoms = kept;
}

/// Keeps commas only between two items of one line.
fn drop_commas(atoms: &mut Vec<Atom>) {
    let mut kept: Vec<Atom> = Vec::with_capacity(atoms.len());
    let mut rest = std::mem::take(atoms).into_iter().peekable();
    while let Some(atom) = rest.next() {
        let ends = |a: Option<&Atom>| matches!(a, None | Some(Atom::Break { .. } | Atom::Comment(_)));
        if atom.is_sign(",") {
            let before = kept.last();
            let after = rest.peek();
            let useless = ends(before)
                || matches!(before, Some(Atom::Open(_)))
                || ends(after)
                || matches!(after, Some(Atom::Close(_)))
                || after.is_some_and(|a| a.is_sign(","));
            if useless {
                continue;
            }
        }
        // Removing a comma may leave two breaks side by side.
        if let (Atom::Break { blank: second }, Some(Atom::Break { blank: first })) = (&atom, kept.last_mut()) {
            *first |= *second;
            continue;
        }
        kept.push(atom);
    }
    *atoms = kept;
}

/// Puts line breaks inside both brackets of each pair that contains a line break.
fn split(atoms: Vec<Atom>) -> Vec<Atom> {
    let mut broken = vec![false; atoms.len()];
    let mut open = Vec::new();
    for (i, atom) in atoms.iter().enumerate() {
        match atom {
            Atom::Open(_) => open.push(i),
            Atom::Close(_) => {
                if let Some(opener) = open.pop() {
                    broken[i] = broken[opener];
                }
            }
            Atom::Break { .. } => {
                if let Some(opener) = open.last() {
                    broken[*opener] = true;
                }
            }
            _ => {}
        }
    }
    let mut out: Vec<Atom> = Vec::with_capacity(atoms.len());
    let mut rest = atoms.into_iter().enumerate().peekable();
    while let Some((i, atom)) = rest.next() {
        match atom {
            Atom::Open(_) if broken[i] => {
                out.push(atom);
                if !matches!(rest.peek(), Some((_, Atom::Break { .. } | Atom::Comment(_)))) {
                    out.push(Atom::Break { blank: false });
                }
            }
            Atom::Close(_) if broken[i] && !out.last().is_some_and(Atom::is_break) => {
                out.push(Atom::Break { blank: false });
                out.push(atom);
            }
            _ => out.push(atom),
        }
    }
    out
}

/// An open bracket while lines are laid out.
struct Bracket {
    kind: char,
    broken: bool,
}

fn lines(atoms: &[Atom]) -> Vec<Line> {
    let mut out: Vec<Line> = Vec::new();
    let mut brackets: Vec<Bracket> = Vec::new();
    let mut line = Line::default();
    // The start of the line's own brackets, and whether its first item may be aligned.
    let mut base = 0;
    let mut previous: Option<&Atom> = None;
    let mut unary = false;
    for (i, atom) in atoms.iter().enumerate() {
        let first = line.text.is_empty() && line.comment.is_none();
        if first && !atom.is_break() {
            let closing = usize::from(matches!(atom, Atom::Close(_)));
            let depth = brackets.iter().filter(|b| b.broken).count();
            line.indent = depth.saturating_sub(closing) + usize::from(previous.is_some_and(Atom::goes_on));
            base = brackets.len();
            line.fields = brackets.last().is_none_or(|b| b.kind == '{') && !previous.is_some_and(Atom::goes_on);
            line.is_closer = closing == 1;
        }
        match atom {
            Atom::Break { blank } => {
                if !line.is_empty() {
                    line.complete = brackets.len() == base;
                    out.push(std::mem::take(&mut line));
                }
                line.blank_before = *blank;
                continue;
            }
            Atom::Comment(text) => {
                line.comment = Some(text.clone());
                continue;
            }
            _ => {}
        }
        let is_unary = matches!(atom, Atom::Sign(s) if s == "-" || s == "+")
            && (first || previous.is_none_or(|p| matches!(p, Atom::Open(_)) || p.is_sign(",") || p.goes_on()));
        if !first && let Some(previous) = previous {
            // A `^` has blanks on both sides or on neither side.
            let apart = previous.is_sign("^") && line.text.ends_with(" ^");
            let tight = unary || !apart && is_tight(previous, atom, brackets.is_empty());
            line.text.push_str(if tight { "" } else { " " });
        }
        if brackets.len() == base {
            match atom {
                Atom::Sign(sign) if sign == "=" && line.equals.is_none() => line.equals = Some(line.text.len()),
                Atom::Sign(sign) if sign == "," => line.fields = false,
                _ => {}
            }
        }
        match atom {
            Atom::Open(kind) => {
                let broken = matches!(atoms.get(i + 1), Some(Atom::Break { .. } | Atom::Comment(_)));
                brackets.push(Bracket { kind: *kind, broken });
            }
            Atom::Close(_) => {
                brackets.pop();
                base = base.min(brackets.len());
            }
            _ => {}
        }
        match atom {
            Atom::Word(s) | Atom::Number(s) | Atom::Unit(s) | Atom::Text(s) | Atom::Sign(s) => line.text.push_str(s),
            Atom::Open(c) | Atom::Close(c) => line.text.push(*c),
            Atom::Comment(_) | Atom::Break { .. } => {}
        }
        unary = is_unary;
        previous = Some(atom);
    }
    if !line.is_empty() {
        line.complete = brackets.len() == base;
        out.push(line);
    }
    out
}

/// Whether two atoms of a line touch.
fn is_tight(left: &Atom, right: &Atom, header: bool) -> bool {
    match (left, right) {
        (Atom::Open('{'), Atom::Close('}')) => true,
        (Atom::Open('{'), _) | (_, Atom::Close('}')) => false,
        (Atom::Open(_), _) | (_, Atom::Close(_)) => true,
        (Atom::Word(_), Atom::Open('(')) => true,
        // `2 m^2` would be another unit.
        (Atom::Unit(_), Atom::Sign(s)) if s == "^" => false,
        (_, Atom::Sign(s)) if s == ":" => !header,
        (_, Atom::Sign(s)) => matches!(s.as_str(), "," | "." | "^"),
        (Atom::Sign(s), _) => matches!(s.as_str(), "." | "^"),
        _ => false,
    }
}
