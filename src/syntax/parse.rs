//! Reads a whole file: one tree, and every mistake of the text.

use pest::Parser;

use super::builder::Builder;
use super::grammar::{Grammar, Rule};
use super::limits;
use super::prepare::prepare;
use super::tree::Tree;
use crate::diag::{self, Code, Diagnostic, FileId};

/// Deep brackets need a deep stack; the caller's stack may be small.
const STACK: usize = 32 << 20;
/// Deeper than people write, but safe for any stack.
const SHALLOW: usize = 12;

/// The tree of a file, and all mistakes of its text. Unreadable parts are left out of the tree, or are error values in
/// it, so that later stages report nothing twice.
pub fn parse(file: FileId, text: &str) -> (Tree, Vec<Diagnostic>) {
    if depth(text) <= SHALLOW {
        return parse_here(file, text);
    }
    let deep = std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK);
        thread.spawn_scoped(scope, || parse_here(file, text)).ok().and_then(|t| t.join().ok())
    });
    deep.unwrap_or_else(|| {
        let mistake = Diagnostic::new(Code::E0103, "brackets nest too deep for this machine's memory");
        (Tree { file, items: Vec::new() }, vec![mistake.label(diag::Span::new(file, 0, 0), "")])
    })
}

/// An upper bound of the depth of brackets.
fn depth(text: &str) -> usize {
    let (mut depth, mut deepest) = (0_usize, 0);
    for byte in text.bytes() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

fn parse_here(file: FileId, text: &str) -> (Tree, Vec<Diagnostic>) {
    let (prepared, mut diagnostics) = prepare(file, text);
    let Some(prepared) = prepared else { return (Tree { file, items: Vec::new() }, diagnostics) };
    let mut builder = Builder::new(&prepared, &mut diagnostics);
    let items = match Grammar::parse(Rule::file, &prepared.text) {
        Ok(pairs) => builder.file(pairs),
        // Every item has its own fallback; this handles a rule without a fallback.
        Err(error) => {
            builder.unread(&error);
            Vec::new()
        }
    };
    diag::sort(&mut diagnostics);
    if diagnostics.len() >= limits::DIAGNOSTICS {
        let last = diagnostics.last().and_then(|d| d.labels.first()).map(|l| l.span);
        let more = Diagnostic::new(Code::E0103, format!("more than {} mistakes in one file", limits::DIAGNOSTICS));
        diagnostics.push(match last {
            Some(span) => more.label(span, "the last one shown"),
            None => more,
        });
    }
    (Tree { file, items }, diagnostics)
}
