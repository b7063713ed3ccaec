//! Finds brackets without a partner, and adds the partner at its most likely place. The grammar then always reads
//! balanced brackets, and a forgotten `}` does not hide the declarations behind it.
//!
//! A balanced file is not changed. In an unbalanced file three habits of writers show where a bracket should close: an
//! item starts at column 0, no entry of a list starts with `name =`, and a closing bracket at the start of a line is
//! aligned with the line that opened it.

use super::draft::Draft;
use super::limits;
use super::token::{Kind, Token, partner};
use crate::diag::{Code, Diagnostic, Fix};

/// The known state at the end of the line of an opening bracket.
#[derive(Clone, Copy, PartialEq)]
enum LineEnd {
    NotReached,
    /// The item continues in the next line, or begins there.
    GoesOn,
    /// The item could also have ended behind the token that ends here.
    At(usize),
}

struct Opener {
    bracket: char,
    token: Token,
    /// Column of the first token of its line.
    indent: usize,
    line: usize,
    line_end: LineEnd,
    /// `^` seen in the current item inside it.
    powers: usize,
}

/// Balances the brackets of a draft if they do not match; refuses a draft that nests beyond the bounds.
pub(super) fn balance(draft: &mut Draft, tokens: &[Token], trusting: bool) -> Result<(), Diagnostic> {
    let mut scan = Scan { draft, tokens, trusting, stack: Vec::new(), powers: 0, last: None, indent: 0, line: 0 };
    for i in 0..tokens.len() {
        scan.step(i)?;
    }
    scan.finish();
    Ok(())
}

/// Whether each bracket has its partner and no token inside brackets certainly starts an item.
pub(super) fn is_balanced(text: &str, tokens: &[Token]) -> bool {
    let mut stack = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        match token.kind {
            Kind::Open(c) => stack.push(c),
            Kind::Close(c) if stack.pop() != Some(partner(c)) => {
                return false;
            }
            Kind::Word if !stack.is_empty() && starts_item(text, tokens, i) == Some(Certainty::Certain) => {
                return false;
            }
            _ => {}
        }
    }
    stack.is_empty()
}

#[derive(PartialEq)]
enum Certainty {
    /// Never right inside brackets.
    Certain,
    /// Could also be an object in a list that is not indented.
    Likely,
}

/// Whether the token starts an item at column 0.
fn starts_item(text: &str, tokens: &[Token], i: usize) -> Option<Certainty> {
    let first = &tokens[i];
    if first.kind != Kind::Word || !(first.start == 0 || text.as_bytes()[first.start - 1] == b'\n') {
        return None;
    }
    let kind = |k: usize| tokens.get(k).map(|t| t.kind);
    let sign = |k: usize| tokens.get(k).map_or("", |t| t.text(text));
    let named = kind(i + 1) == Some(Kind::Word);
    if matches!(first.text(text), "use" | "let") && named {
        return Some(Certainty::Certain);
    }
    let mut next = i + 1 + usize::from(named);
    if sign(next) == ":" {
        if named {
            return Some(Certainty::Certain);
        }
        next += 1;
        while kind(next) == Some(Kind::Word) {
            next += if sign(next + 1) == "." { 2 } else { 1 };
        }
    }
    if kind(next) == Some(Kind::LineBreak) {
        next += 1;
    }
    match (kind(next), named) {
        (Some(Kind::Open('{')), true) => Some(Certainty::Certain),
        (Some(Kind::Open('{')), false) => Some(Certainty::Likely),
        _ => None,
    }
}

/// Whether the tokens from here on are `path =`, in any spelling.
pub(super) fn starts_field(text: &str, tokens: &[Token], mut i: usize) -> bool {
    while tokens.get(i).is_some_and(|t| t.kind == Kind::Word) {
        match tokens.get(i + 1).map_or("", |t| t.text(text)) {
            "." => i += 2,
            sign => return matches!(sign, "=" | ":=" | "=>" | "->"),
        }
    }
    false
}

struct Scan<'s, 'a> {
    draft: &'s mut Draft<'a>,
    tokens: &'s [Token],
    /// The file is balanced: no repair is needed.
    trusting: bool,
    stack: Vec<Opener>,
    /// `^` in the items around the current place.
    powers: usize,
    /// The last token that is neither comment nor line break.
    last: Option<Token>,
    indent: usize,
    line: usize,
}

impl Scan<'_, '_> {
    fn step(&mut self, i: usize) -> Result<(), Diagnostic> {
        let token = self.tokens[i];
        let text = self.draft.original;
        let first_of_line = i == 0 || self.tokens[i - 1].kind == Kind::LineBreak;
        if first_of_line && token.kind != Kind::LineBreak {
            self.indent = token.start - text[..token.start].rfind('\n').map_or(0, |n| n + 1);
            self.line += 1;
            if !self.trusting && !self.stack.is_empty() {
                self.close_before(i);
            }
        }
        match token.kind {
            Kind::LineBreak => {
                self.end_line();
                self.end_item();
                return Ok(());
            }
            _ if token.is_comment() => return Ok(()),
            Kind::Open(bracket) => {
                if self.stack.len() == limits::DEPTH {
                    return Err(Diagnostic::new(Code::E0103, "more than 64 brackets inside each other")
                        .label(self.draft.span(token.start, token.end), "the 65th")
                        .help("give the inner values names with `let`, or declare the inner objects"));
                }
                let Scan { indent, line, .. } = *self;
                self.stack.push(Opener { bracket, token, indent, line, line_end: LineEnd::NotReached, powers: 0 });
            }
            Kind::Close(bracket) => self.close(i, bracket, first_of_line),
            Kind::Sign => self.sign(token)?,
            _ => {}
        }
        self.last = Some(token);
        Ok(())
    }

    /// Counts powers of powers, because each needs one more nested call of the parser.
    fn sign(&mut self, token: Token) -> Result<(), Diagnostic> {
        match token.text(self.draft.original) {
            "^" => {
                self.powers += 1;
                if let Some(top) = self.stack.last_mut() {
                    top.powers += 1;
                }
                if self.powers > limits::POWERS {
                    return Err(Diagnostic::new(Code::E0103, "more than 64 powers in one value")
                        .label(self.draft.span(token.start, token.end), "the 65th"));
                }
            }
            "+" | "-" | "*" | "/" if self.last.is_none_or(|t| t.text(self.draft.original) != "^") => self.end_item(),
            "," | ";" => self.end_item(),
            _ => {}
        }
        Ok(())
    }

    fn end_item(&mut self) {
        let own = match self.stack.last_mut() {
            Some(top) => std::mem::take(&mut top.powers),
            None => self.powers,
        };
        self.powers -= own.min(self.powers);
    }

    /// Notes the possible end of the item around the innermost bracket.
    fn end_line(&mut self) {
        let (Some(top), Some(last)) = (self.stack.last_mut(), self.last) else { return };
        // Only the line that opened the bracket counts.
        if top.line_end == LineEnd::NotReached {
            let goes_on = last.kind == Kind::Sign && !matches!(last.text(self.draft.original), "?" | "%");
            let opens = last.start == top.token.start;
            top.line_end = if goes_on || opens { LineEnd::GoesOn } else { LineEnd::At(last.end) };
        }
    }

    /// Closes brackets that must be closed before the first token of a line.
    fn close_before(&mut self, i: usize) {
        let text = self.draft.original;
        if starts_item(text, self.tokens, i).is_some() {
            while let Some(opener) = self.stack.pop() {
                let at = self.end_of_last();
                self.report_unclosed(&opener, at, Some(self.tokens[i]));
            }
            self.powers = 0;
        } else if starts_field(text, self.tokens, i) {
            // A field never starts inside a list; named arguments look the same, but then their `)` follows.
            let is_call = |o: &Opener| o.bracket == '(' && matches!(o.line_end, LineEnd::At(_));
            let ahead = self.is_closed_ahead(i);
            while let Some(opener) = self.stack.pop_if(|o| o.bracket == '[' || !ahead && is_call(o)) {
                let at = self.end_of_last();
                self.report_unclosed(&opener, at, Some(self.tokens[i]));
            }
        }
    }

    /// Whether a `)` follows soon that closes a bracket that is open now.
    fn is_closed_ahead(&self, i: usize) -> bool {
        let mut open = Vec::new();
        for token in self.tokens[i..].iter().take(200) {
            match token.kind {
                Kind::Open(c) => open.push(c),
                Kind::Close(c) => match open.pop() {
                    None => return c == ')',
                    Some(opener) if opener != partner(c) => return false,
                    Some(_) => {}
                },
                _ => {}
            }
        }
        false
    }

    fn close(&mut self, i: usize, bracket: char, first_of_line: bool) {
        let token = self.tokens[i];
        let open = partner(bracket);
        let Some(matching) = self.stack.iter().rposition(|o| o.bracket == open) else {
            return self.close_nothing(i, bracket);
        };
        let above = matching + 1..self.stack.len();
        let mut target = matching;
        if !self.trusting && first_of_line && above.is_empty() && self.stack[matching].indent > self.indent {
            // It is aligned with the opening line of an outer bracket.
            let under = self.stack.iter().rposition(|o| o.bracket == open && o.indent == self.indent);
            target = under.unwrap_or(matching);
        }
        if !self.trusting && self.closes_too_early(i, target, first_of_line) {
            return self.report_extra(token, bracket);
        }
        while self.stack.len() > target + 1 {
            if let Some(opener) = self.stack.pop() {
                let at = self.likely_end(&opener);
                self.report_unclosed(&opener, at, Some(token));
            }
        }
        self.end_item();
        self.stack.pop();
    }

    /// A `}` behind other text that would end the declaration although more of its indented lines follow.
    fn closes_too_early(&self, i: usize, target: usize, first_of_line: bool) -> bool {
        let text = self.draft.original;
        if target != 0 || first_of_line || self.stack.len() != 1 || self.stack[0].line == self.line {
            return false;
        }
        let mut rest = self.tokens[i + 1..].iter().skip_while(|t| t.is_comment());
        if rest.next().is_none_or(|t| t.kind != Kind::LineBreak) {
            return false;
        }
        rest.find(|t| t.kind != Kind::LineBreak && !t.is_comment())
            .is_some_and(|t| t.start > 0 && text.as_bytes()[t.start - 1] != b'\n')
    }

    /// A closing bracket of a kind that is not open: a wrong bracket for an opener on this line, or an extra bracket.
    fn close_nothing(&mut self, i: usize, bracket: char) {
        let token = self.tokens[i];
        let Some(top) = self.stack.last().filter(|o| o.line == self.line) else {
            return self.report_extra(token, bracket);
        };
        let (open, right) = (top.bracket, partner(top.bracket));
        let mut depth = 0;
        let rest = self.tokens[i + 1..].iter().take_while(|t| t.kind != Kind::LineBreak);
        let closed_later = rest.into_iter().any(|t| {
            match t.kind {
                Kind::Open(_) => depth += 1,
                Kind::Close(c) if depth == 0 => return c == right,
                Kind::Close(_) => depth -= 1,
                _ => {}
            }
            false
        });
        if closed_later {
            return self.report_extra(token, bracket);
        }
        let mistake = Diagnostic::new(Code::E0104, format!("`{open}` is closed by `{bracket}`"))
            .label(self.draft.span(token.start, token.end), format!("expected `{right}`"))
            .label(self.draft.span(top.token.start, top.token.end), "opened here")
            .help(format!("write `{right}` instead of `{bracket}`"))
            .fix(Fix::replace(self.draft.span(token.start, token.end), right.to_string()));
        self.draft.report(mistake);
        self.draft.overwrite(&token, &right.to_string());
        self.end_item();
        self.stack.pop();
    }

    fn report_extra(&mut self, token: Token, bracket: char) {
        self.draft.overwrite(&token, "");
        let mistake = Diagnostic::new(Code::E0104, format!("`{bracket}` closes nothing"))
            .label(self.draft.span(token.start, token.end), format!("no `{}` is open here", partner(bracket)))
            .help("remove it, or open its partner before it")
            .fix(Fix::replace(self.draft.span(token.start, token.end), "").titled(format!("remove `{bracket}`")));
        self.draft.report(mistake);
    }

    fn end_of_last(&self) -> usize {
        self.last.map_or(0, |t| t.end)
    }

    /// Arguments and objects that began on their line most likely ended on it; other brackets end where the missing
    /// bracket is noticed.
    fn likely_end(&self, opener: &Opener) -> usize {
        match opener.line_end {
            LineEnd::At(end) if opener.bracket != '[' => end,
            _ => self.end_of_last(),
        }
    }

    fn report_unclosed(&mut self, opener: &Opener, at: usize, noticed: Option<Token>) {
        let Opener { bracket, token, .. } = opener;
        let right = partner(*bracket);
        self.draft.insertions.push((at, right));
        if self.draft.is_full() {
            return;
        }
        let line = self.draft.original[..at].matches('\n').count() + 1;
        let mut mistake = Diagnostic::new(Code::E0104, format!("`{bracket}` is never closed"))
            .label(self.draft.span(token.start, token.end), "opened here")
            .help(format!("add `{right}`, most likely after line {line}"));
        if line == self.draft.original[..token.start].matches('\n').count() + 1 {
            mistake = mistake.help(format!("add `{right}`, most likely at the end of line {line}"));
        }
        let text = if right == '}' { " }".to_owned() } else { right.to_string() };
        mistake = mistake.fix(Fix::replace(self.draft.span(at, at), text).titled(format!("add `{right}`")));
        if let Some(noticed) = noticed {
            mistake = mistake.label(self.draft.span(noticed.start, noticed.end), "still open here");
        }
        self.draft.report(mistake);
    }

    /// Reports all brackets that are open at the end of the file.
    fn finish(&mut self) {
        while let Some(opener) = self.stack.pop() {
            let at = self.likely_end(&opener);
            self.report_unclosed(&opener, at, None);
        }
    }
}
