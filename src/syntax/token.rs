//! Cuts a text into tokens, including comments and line breaks, for tasks that need no grammar.
//!
//! `foreign` and `balance` check a text before it is parsed, `format` formats a text that can be parsed, and an editor
//! needs the token at a place in an unfinished text. Every byte belongs to a token or is a blank, and no text is
//! refused.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    LineBreak,
    /// `// to the line's end`
    Comment,
    /// `"..."`, perhaps without its closing quote.
    Text {
        closed: bool,
    },
    Number,
    /// Letters, digits and `_`, of any script: a name, a keyword or a part of a unit.
    Word,
    Open(char),
    Close(char),
    /// One sign, or one of `..  <=  >=` and of the pairs of signs that other languages have.
    Sign,
    /// `#`, `--`, `%`, `!` or `'` to the line's end, of other languages.
    ForeignComment,
    /// `/* ... */`, of other languages.
    BlockComment,
    /// `'...'` or text in typographic quotes, of other languages and word processors.
    OddText,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    pub kind: Kind,
    pub start: usize,
    pub end: usize,
}

impl Token {
    pub fn text<'a>(&self, text: &'a str) -> &'a str {
        &text[self.start..self.end]
    }

    pub fn is_comment(&self) -> bool {
        matches!(self.kind, Kind::Comment | Kind::ForeignComment | Kind::BlockComment)
    }
}

const PAIRS_OF_SIGNS: [&str; 15] =
    ["..", "<=", ">=", "=>", ":=", "==", "=<", "->", "<-", "!=", "<>", "::", "&&", "||", "**"];

/// All tokens of a text, in order.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut out: Vec<Token> = Vec::with_capacity(text.len() / 4);
    let mut at = 0;
    // The start of the current line in `out`: an unclosed text needs the brackets opened before it.
    let mut line = 0;
    while let Some(token) = next(text, at) {
        let mut end = token.end;
        if token.kind == (Kind::Text { closed: false }) {
            end = token.start + unclosed_length(token.text(text), &out[line..]);
        }
        if is_foreign_comment(text, &token, out.last()) {
            end = token.start + line_length(&text[token.start..]);
            out.push(Token { kind: Kind::ForeignComment, end, ..token });
        } else {
            out.push(Token { end, ..token });
        }
        at = end;
        if token.kind == Kind::LineBreak {
            line = out.len();
        }
    }
    out
}

/// Whether words follow a sign that begins a comment in other languages and that no value has.
fn is_foreign_comment(text: &str, token: &Token, before: Option<&Token>) -> bool {
    let rest = &text[token.start..];
    let words = |skip: usize| rest[skip..].trim_start_matches([' ', '\t']).starts_with(char::is_alphabetic);
    let first = before.is_none_or(|t| t.kind == Kind::LineBreak);
    let apart = |t: &Token| t.end < token.start && !matches!(t.kind, Kind::Open(_) | Kind::Sign);
    let behind = before.is_some_and(apart);
    if token.kind != Kind::Sign {
        return false;
    }
    match rest.as_bytes() {
        [b'-', b'-', ..] if first => words(2),
        [b'-', b'-', b' ', ..] => behind && words(2),
        [b'%', ..] => words(1) && (first || behind && before.is_some_and(|t| t.kind == Kind::Close('}'))),
        [b'!', next, ..] => *next != b'=' && words(1) && (first || behind),
        [b'\'', ..] => words(1) && behind,
        _ => false,
    }
}

/// The first token at or after an offset.
pub(super) fn next(text: &str, from: usize) -> Option<Token> {
    let rest = text.get(from..)?;
    let start = from + rest.find(|c| !matches!(c, ' ' | '\t' | '\r'))?;
    let rest = &text[start..];
    let c = rest.chars().next()?;
    let (kind, length) = match c {
        '\n' => (Kind::LineBreak, 1),
        '"' => quoted(rest, '"', usize::MAX).map_or_else(
            || (Kind::Text { closed: false }, rest[..line_length(rest)].trim_end().len()),
            |length| (Kind::Text { closed: true }, length),
        ),
        '\'' | '“' | '”' | '„' | '‘' | '’' | '‚' | '`' | '«' | '»' | '「' | '『' => {
            odd_text(rest, c).map_or((Kind::Sign, c.len_utf8()), |n| (Kind::OddText, n))
        }
        '#' => (Kind::ForeignComment, line_length(rest)),
        '/' if rest.starts_with("//") => (Kind::Comment, line_length(rest)),
        '/' if rest.starts_with("/*") => (Kind::BlockComment, block_comment_length(rest)),
        '(' | '[' | '{' => (Kind::Open(c), 1),
        ')' | ']' | '}' => (Kind::Close(c), 1),
        '0'..='9' => (Kind::Number, number_length(rest)),
        _ if c.is_alphabetic() || c == '_' => {
            (Kind::Word, rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len()))
        }
        _ => {
            let pair = PAIRS_OF_SIGNS.iter().find(|s| rest.starts_with(**s));
            (Kind::Sign, pair.map_or(c.len_utf8(), |s| s.len()))
        }
    };
    Some(Token { kind, start, end: start + length })
}

/// The length of the text that starts with a quote and ends with `close` on the same line, within `reach` characters.
fn quoted(rest: &str, close: char, reach: usize) -> Option<usize> {
    let mut chars = rest.char_indices().skip(1).take(reach);
    while let Some((i, c)) = chars.next() {
        match c {
            '\n' => return None,
            '\\' if close == '"' && chars.next().is_some_and(|(_, c)| c == '\n') => {
                return None;
            }
            _ if c == close => return Some(i + c.len_utf8()),
            _ => {}
        }
    }
    None
}

/// Limit of the search for the partner of a quote or comment mark, so that a file with many marks does not take too
/// long.
const TEXT_REACH: usize = 200;
const COMMENT_REACH: usize = 2000;

fn odd_text(rest: &str, open: char) -> Option<usize> {
    let closing: &[char] = match open {
        '\'' => &['\''],
        '‘' | '’' | '‚' => &['’', '‘'],
        '`' => &['`', '´', '\''],
        '«' => &['»'],
        '»' => &['«'],
        '「' => &['」'],
        '『' => &['』'],
        _ => &['”', '“'],
    };
    let close = rest.chars().skip(1).take(TEXT_REACH).find(|c| closing.contains(c))?;
    quoted(rest, close, TEXT_REACH)
}

fn block_comment_length(rest: &str) -> usize {
    let reach = rest.char_indices().nth(COMMENT_REACH).map_or(rest.len(), |(i, _)| i);
    rest[2..reach].find("*/").map_or_else(|| line_length(rest), |i| i + 4)
}

/// A text without its closing quote ends with the line, but closing brackets that the line had opened before it are not
/// part of it.
fn unclosed_length(text: &str, line: &[Token]) -> usize {
    let mut open = Vec::new();
    for token in line {
        match token.kind {
            Kind::Open(c) => open.push(c),
            Kind::Close(_) => {
                open.pop();
            }
            _ => {}
        }
    }
    // a closing or separating sign follows a quote whose opening quote is missing
    if text[1..].trim_start().is_empty() || text[1..].starts_with([')', ']', '}', ',']) {
        return 1;
    }
    if let (Some('('), Some(close)) = (open.last(), text.find(')')) {
        return text[..close].trim_end().len();
    }
    let mut kept = text;
    // The outermost bracket is the last on the line.
    for bracket in open {
        match kept.strip_suffix(partner(bracket)) {
            Some(shorter) if !shorter.is_empty() => kept = shorter.trim_end(),
            _ => break,
        }
    }
    kept.len()
}

/// The bracket on the other side.
pub(super) fn partner(bracket: char) -> char {
    match bracket {
        '(' => ')',
        '[' => ']',
        '{' => '}',
        ')' => '(',
        ']' => '[',
        _ => '{',
    }
}

fn line_length(rest: &str) -> usize {
    let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
    line.trim_end_matches('\r').len()
}

fn number_length(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let digits = |mut i: usize| {
        while bytes.get(i).is_some_and(|b| b.is_ascii_digit() || *b == b'_') {
            i += 1;
        }
        i
    };
    let is_digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    let mut i = digits(0);
    if bytes.get(i) == Some(&b'.') && is_digit(i + 1) {
        i = digits(i + 1);
    }
    if matches!(bytes.get(i), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(i + 1), Some(b'+' | b'-')));
        if is_digit(i + 1 + sign) {
            i = digits(i + 1 + sign);
        }
    }
    i
}
