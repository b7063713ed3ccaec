//! Semantic colours: the meaning of each word, which a grammar of patterns does not know.

use super::marks::{Marks, What};
use super::view::View;
use crate::syntax::{TokenKind, tokens};
use lsp_types::{SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokensLegend};

/// Names of the types, in the order of their numbers.
const TYPES: [SemanticTokenType; 11] = [
    SemanticTokenType::KEYWORD,
    SemanticTokenType::CLASS,
    SemanticTokenType::VARIABLE,
    SemanticTokenType::NAMESPACE,
    SemanticTokenType::PROPERTY,
    SemanticTokenType::PARAMETER,
    SemanticTokenType::ENUM_MEMBER,
    SemanticTokenType::FUNCTION,
    SemanticTokenType::NUMBER,
    SemanticTokenType::STRING,
    SemanticTokenType::COMMENT,
];

/// The type of units, which has no standard name in the protocol.
const UNIT: u32 = 11;

/// The legend for the client.
pub fn legend() -> SemanticTokensLegend {
    let types = TYPES.into_iter().chain([SemanticTokenType::new("unit")]).collect();
    SemanticTokensLegend { token_types: types, token_modifiers: vec![SemanticTokenModifier::DECLARATION] }
}

/// A coloured part of the text.
struct Part {
    start: usize,
    end: usize,
    kind: u32,
    declares: bool,
}

/// The colours of a text, each relative to the previous one, as the protocol requires.
pub fn colours(view: &View) -> Vec<SemanticToken> {
    let mut parts = of_marks(&view.marks);
    parts.extend(of_tokens(&view.text));
    parts.sort_by_key(|part| (part.start, part.end));
    let mut out: Vec<SemanticToken> = Vec::with_capacity(parts.len());
    let (mut line, mut column, mut end) = (0, 0, 0);
    for part in parts.iter().filter(|part| part.end > part.start) {
        // parts do not overlap in the protocol, and stay on one line
        let text = view.text.get(part.start..part.end);
        if part.start < end || text.is_none_or(|text| text.contains('\n')) {
            continue;
        }
        let range = view.lines.range(&view.text, part.start, part.end);
        let delta_line = range.start.line - line;
        out.push(SemanticToken {
            delta_line,
            delta_start: if delta_line == 0 { range.start.character - column } else { range.start.character },
            length: range.end.character - range.start.character,
            token_type: part.kind,
            token_modifiers_bitset: u32::from(part.declares),
        });
        (line, column, end) = (range.start.line, range.start.character, part.end);
    }
    out
}

fn of_marks(marks: &Marks) -> Vec<Part> {
    let part = |mark: &super::marks::Mark| {
        let kind = match mark.what {
            What::Kind(_) => 1,
            What::Declared(_) | What::Reference(_) | What::Transition(_) => 2,
            What::Module(_) => 3,
            What::Field(..) => 4,
            What::Argument(..) => 5,
            What::Word(_) | What::Rule(_) | What::Hole => 6,
            What::Function | What::Response(_) => 7,
            What::Number(_) => 8,
            What::Text => 9,
            What::Unit | What::Basis => UNIT,
        };
        let declares = matches!(mark.what, What::Declared(_) | What::Transition(true));
        Part { start: mark.span.start as usize, end: mark.span.end as usize, kind, declares }
    };
    marks.0.iter().map(part).collect()
}

/// Keywords and comments, which are not words of the tree.
fn of_tokens(text: &str) -> Vec<Part> {
    let all = tokens(text);
    let mut parts = Vec::new();
    let mut first = true;
    for token in &all {
        let kind = match token.kind {
            TokenKind::Comment => Some(10),
            TokenKind::Word if first && matches!(token.text(text), "use" | "let") => Some(0),
            TokenKind::Word if matches!(token.text(text), "per" | "as") => Some(0),
            _ => None,
        };
        first = token.kind == TokenKind::LineBreak || token.text(text) == ",";
        parts.extend(kind.map(|kind| Part { start: token.start, end: token.end, kind, declares: false }));
    }
    parts
}
