//! Explains text that could not be read: the part is parsed again alone with the exact rule; the mistake is at the
//! place where this fails.

use pest::Parser;
use pest::error::{Error, ErrorVariant, InputLocation};
use pest::iterators::Pair;

use super::builder::{Builder, first_line};
use super::grammar::{Grammar, Rule};
use super::token::{self, Kind, Token};
use super::tree::{Name, Path};
use crate::diag::{Code, Diagnostic, Fix, Help};

/// Help for an unreadable part.
pub(super) enum Way {
    Say(String),
    /// The reason, and the text to write instead of its first line.
    Write(&'static str, String),
    /// The help, the bytes of the part that are wrong, and the texts of which one is to be written instead.
    Offer(String, usize, Vec<String>),
}

/// The kind of an unreadable part.
pub(super) enum Explained {
    /// The rest of a number that was cut at its decimal comma: the value before it is wrong.
    DecimalComma,
    /// Something else, perhaps with a path in front that names a field.
    Other(Option<Path>),
}

impl<'p> Builder<'p> {
    pub fn explain_pair(&mut self, rule: Rule, pair: &Pair<'p, Rule>) -> Explained {
        self.explain(rule, pair.as_span().start(), pair.as_span().start(), pair.as_span().end())
    }

    /// Reports why the rule `exact` cannot read the text from `start` to `end`; everything before `junk` is right.
    pub fn explain(&mut self, exact: Rule, start: usize, junk: usize, end: usize) -> Explained {
        let text: &'p str = &self.prepared.text;
        let path = self.leading_path(start, end);
        if self.is_full() || self.prepared.is_poisoned(start, end) {
            return Explained::Other(path);
        }
        if junk == start && self.decimal_comma(start).is_some() {
            self.report_decimal_comma(start, end);
            return Explained::DecimalComma;
        }
        let (at, expected) = match Grammar::parse(exact, &text[start..end]) {
            Err(error) => ((start + offset(&error)).max(junk), expected(&error)),
            Ok(_) => (junk, Vec::new()),
        };
        let at = self.past_trivia(at);
        let Some(found) = token::next(text, at).filter(|t| t.kind != Kind::LineBreak) else {
            let mistake = Diagnostic::new(Code::E0101, message(&expected, &self.found(at)));
            let last = start + text[start..end.min(at.max(start))].trim_end().len();
            let mistake = mistake.label(self.span(last, last), "");
            self.report(self.shown(mistake, self.way_out(exact, start, junk, end, None), start, end));
            return Explained::Other(path);
        };
        let found = self.whole_word(found);
        if self.prepared.is_inserted(found.start) {
            return Explained::Other(path);
        }
        let mistake = match self.swallowed(junk) {
            Some(next) => {
                let before = text[..junk].trim_end_matches([' ', '\t']);
                let next_start = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
                let message = format!("expected a comma or a line break before `{}`", next.text());
                let mistake = Diagnostic::new(Code::E0101, message).label(next.span, "a new field starts here");
                let gap = text[..next_start].trim_end_matches([' ', '\t']).len();
                let fix = Fix::replace(self.span(gap, next_start), ", ").titled("write a comma");
                self.report(mistake.help(format!("write `, {}`", next.text())).fix(fix));
                return Explained::Other(path);
            }
            None => {
                let what = self.found(found.start);
                Diagnostic::new(Code::E0101, message(&expected, &what)).label(self.span(found.start, found.end), "")
            }
        };
        self.report(self.shown(mistake, self.way_out(exact, start, junk, end, Some(found)), start, end));
        Explained::Other(path)
    }

    /// A mistake with the way out; one that is an edit takes the place of the first line of the part that begins at
    /// `start`.
    fn shown(&self, mistake: Diagnostic, way: Option<Way>, start: usize, end: usize) -> Diagnostic {
        match way {
            Some(Way::Say(help)) => mistake.help(help),
            Some(Way::Write(why, written)) => {
                let part = first_line(&self.prepared.text[start..end]);
                let fix = Fix::replace(self.span(start, start + part.len()), written.as_str());
                mistake.help(format!("{why}write `{written}`")).fix(fix)
            }
            Some(Way::Offer(said, length, writes)) => {
                mistake.advise(self.span(start, start + length), Help { said, writes })
            }
            None => mistake,
        }
    }

    /// A word with letters that no name has is cut before the first of them; this shows the whole word.
    fn whole_word(&self, found: Token) -> Token {
        if found.kind != Kind::Word {
            return found;
        }
        let before = &self.prepared.text[..found.start];
        Token { start: before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len(), ..found }
    }

    /// The grammar failed on the whole file.
    pub fn unread(&mut self, error: &Error<Rule>) {
        let at = self.past_trivia(offset(error));
        let message = message(&expected(error), &self.found(at));
        self.report(Diagnostic::new(Code::E0101, message).label(self.span(at, at), ""));
    }

    /// The text to write instead, if it can be guessed.
    fn way_out(&self, exact: Rule, start: usize, junk: usize, end: usize, found: Option<Token>) -> Option<Way> {
        let text: &'p str = &self.prepared.text;
        let part = first_line(&text[start..end]);
        let word = found.map_or("", |t| t.text(text));
        if let Some(way) = self.habit(exact, start, part, found) {
            return Some(way);
        }
        let say = |help: &str| Some(Way::Say(help.to_owned()));
        let opens = |sign: &str| matches!(sign, "+" | "*" | "/" | "^" | ".." | "<" | ">" | "<=" | ">=" | "per");
        if !word.is_ascii() && matches!(found?.kind, Kind::Word) {
            return say("names are made of ASCII letters, digits and `_`");
        }
        let line = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let first = start == junk && line > 0 && text[line..start].trim().is_empty();
        if word == "==" {
            return say("`=` gives a value, `<=` and `>=` compare");
        }
        if first && found.is_some_and(|t| t.start == start) && opens(word) {
            return say(&format!("a line continues after an operator: end the line above with `{word}`"));
        }
        if word == "." {
            return say("separate the factors of a unit by a blank: `kN s/m`");
        }
        let mut before = text[start..found.map_or(end, |t| t.start)].split_whitespace().rev();
        if let (Some(half), Some("per")) = (before.next(), before.next()) {
            return say(&format!("`per` takes one word: not `{half} {word}`, but for example `seat` or `sleeper`"));
        }
        match exact {
            Rule::exact_entry => {
                let key = leading(part);
                let rest = part[key.len()..].trim_start();
                if !key.is_empty() && part.chars().all(|c| c.is_ascii_alphabetic() || "_ ".contains(c)) {
                    let words: Vec<&str> = part.split_whitespace().collect();
                    let (name, items) = (words.join("_"), words.join(", "));
                    let said = format!("write `{items}` for several, `{name}` for one: a name has no blanks");
                    return Some(Way::Offer(said, part.len(), vec![items, name]));
                }
                let value = rest.starts_with(|c: char| c.is_alphanumeric());
                let rest = rest.strip_prefix("x ").unwrap_or(rest);
                let pair = !key.is_empty() && value && !rest.starts_with("per ");
                pair.then(|| Way::Write("", format!("{key}: {rest}")))
            }
            Rule::exact_field if matches!(first_word(part), "let" | "use") => {
                say(&format!("put `{}` outside of braces", first_word(part)))
            }
            Rule::exact_field => {
                let path = leading(part);
                let rest = part[path.len()..].trim_start();
                // two words before the sign are taken as one name
                let second = leading(rest);
                let after = rest[second.len()..].trim_start();
                if !path.is_empty() && !second.is_empty() && after.starts_with('=') && !after.starts_with("==") {
                    return Some(Way::Write("a name has no blanks: ", format!("{path}_{second} {after}")));
                }
                let value = rest.starts_with(|c: char| c.is_alphanumeric() || "\"([-?".contains(c));
                let written = (!path.is_empty() && value).then(|| Way::Write("", format!("{path} = {rest}")));
                written.or_else(|| say("a field is `name = value`"))
            }
            Rule::exact_item if first_word(part) == "let" => {
                let name = part["let".len()..].trim_start();
                let (first, rest) = name.split_at(leading(name).len());
                let second = leading(rest.trim_start());
                let after = rest.trim_start()[second.len()..].trim_start();
                match !first.is_empty() && !second.is_empty() && after.starts_with('=') {
                    true => Some(Way::Write("a name has no blanks: ", format!("let {first}_{second} {after}"))),
                    false => say("write `let name = value`"),
                }
            }
            Rule::exact_item if matches!(first_word(part), "import" | "include" | "using" | "require") => {
                let module = part[first_word(part).len()..].trim().trim_matches('"');
                Some(Way::Write("", format!("use {module}")))
            }
            Rule::exact_item if first_word(part) == "use" => say("write `use module` or `use module as name`"),
            Rule::exact_item if matches!(word, "extends" | "(" | "-" | "from" | "is") || found.is_some_and(is_text) => {
                say("a declaration is `kind name : base { field = value }`")
            }
            Rule::exact_item if start == junk => say("a declaration is `kind name { field = value }`"),
            Rule::exact_item => say("a declaration is `kind name : base { field = value }`"),
            _ => None,
        }
    }

    /// The field behind a value without a comma between them: `a = 1 m b = 2`, with the junk from the second `=`.
    pub fn swallowed(&self, junk: usize) -> Option<Path> {
        let text = &self.prepared.text;
        if !text[junk..].starts_with('=') || text[junk..].starts_with("==") {
            return None;
        }
        let before = text[..junk].trim_end_matches([' ', '\t']);
        let start = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
        let name = &before[start..];
        let apart = before[..start].ends_with([' ', '\t']) && !before[..start].trim_end().ends_with(['=', '\n']);
        (apart && name.starts_with(|c: char| c.is_ascii_alphabetic())).then(|| self.path_at(start, name))
    }

    fn leading_path(&self, start: usize, end: usize) -> Option<Path> {
        let path = leading(&self.prepared.text[start..end]);
        (!path.is_empty() && !matches!(path, "use" | "let" | "as" | "per")).then(|| self.path_at(start, path))
    }

    fn path_at(&self, start: usize, path: &str) -> Path {
        let mut names = Vec::new();
        let mut at = start;
        for name in path.split('.') {
            names.push(Name { text: name.to_owned(), span: self.span(at, at + name.len()) });
            at += name.len() + 1;
        }
        Path { names, span: self.span(start, start + path.len()) }
    }

    /// The start of the number whose decimals start at `at`, behind a comma without a blank.
    pub fn decimal_comma(&self, at: usize) -> Option<usize> {
        let text = &self.prepared.text;
        let whole = text[..at].strip_suffix(',')?;
        let bare = whole.trim_end_matches(|c: char| c.is_ascii_digit() || "_.".contains(c)).len();
        // `40.000,5`: points between thousands
        let start = match whole[bare..].split('.').skip(1).all(|thousand| thousand.len() == 3) {
            true => bare,
            false => whole.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_').len(),
        };
        let before = whole[..start].chars().next_back();
        let alone = start < whole.len() && !before.is_some_and(|c| c == '.' || c.is_alphanumeric());
        (alone && text[at..].starts_with(|c: char| c.is_ascii_digit())).then_some(start)
    }

    pub fn report_decimal_comma(&mut self, at: usize, end: usize) {
        let Some(start) = self.decimal_comma(at) else { return };
        let (whole, decimals) = (&self.prepared.text[start..at - 1], first_line(self.text(at, end)));
        let digits = decimals.find(|c: char| !c.is_ascii_digit()).unwrap_or(decimals.len());
        let place = self.span(start, at + decimals.len());
        let mistake = Diagnostic::new(Code::E0105, "a decimal comma").label(place, "a comma separates items");
        let mistake = if whole.contains('.') {
            mistake.write(place, format!("{}.{decimals}", whole.replace('.', "")))
        } else if decimals[digits..].starts_with('.') {
            mistake.write(place, format!("{whole}{decimals}"))
        } else if digits == 3 {
            let (point, thousands) = (format!("{whole}.{decimals}"), format!("{whole}_{decimals}"));
            let help = format!("write `{point}`, or `{thousands}` if the comma separates thousands");
            mistake.help(help).fix(Fix::replace(place, point)).fix(Fix::replace(place, thousands))
        } else {
            mistake.write(place, format!("{whole}.{decimals}"))
        };
        self.report(mistake);
    }

    fn past_trivia(&self, mut at: usize) -> usize {
        while let Some(token) = token::next(&self.prepared.text, at).filter(|t| t.kind == Kind::Comment) {
            at = token.end;
        }
        at
    }

    /// The token at an offset, in words.
    pub fn found(&self, at: usize) -> String {
        let text = &self.prepared.text;
        match token::next(text, self.past_trivia(at)) {
            None => "the end of the file".to_owned(),
            Some(token) if token.kind == Kind::LineBreak || self.prepared.is_inserted(token.start) => {
                "the end of the line".to_owned()
            }
            Some(token) => {
                let shown: String = token.text(text).chars().take(40).collect();
                let escaped = shown.chars().any(char::is_control);
                if escaped { format!("`{}`", shown.escape_debug()) } else { format!("`{shown}`") }
            }
        }
    }
}

/// The path that a text starts with, if any.
fn leading(text: &str) -> &str {
    let mut end = 0;
    loop {
        let rest = &text[end..];
        let length = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        if length == 0 || !rest.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return text[..end].trim_end_matches('.');
        }
        end += length;
        if !text[end..].starts_with('.') {
            return &text[..end];
        }
        end += 1;
    }
}

fn is_text(token: Token) -> bool {
    matches!(token.kind, Kind::Text { .. })
}

fn first_word(text: &str) -> &str {
    text.split_whitespace().next().unwrap_or("")
}

fn offset(error: &Error<Rule>) -> usize {
    match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    }
}

/// The parts that are allowed there, from the loosest to the tightest.
fn expected(error: &Error<Rule>) -> Vec<&'static str> {
    let ErrorVariant::ParsingError { positives, .. } = &error.variant else { return Vec::new() };
    const WORDS: [(&str, &[Rule]); 10] = [
        ("a field", &[Rule::exact_field]),
        ("a declaration", &[Rule::declaration, Rule::exact_item, Rule::use_item, Rule::let_item]),
        ("a name", &[Rule::name, Rule::path, Rule::base]),
        (
            "a value",
            &[
                Rule::value,
                Rule::range,
                Rule::sum,
                Rule::product,
                Rule::factor,
                Rule::power,
                Rule::quantity,
                Rule::number,
                Rule::wrong_number,
                Rule::text,
                Rule::list,
                Rule::group,
                Rule::hole,
                Rule::sign,
                Rule::object,
                Rule::call,
                Rule::exact_value,
                Rule::exact_entry,
                Rule::exact_argument,
            ],
        ),
        ("`:`", &[Rule::colon]),
        ("`=`", &[Rule::equals]),
        ("`as`", &[Rule::kw_as]),
        ("`{`", &[Rule::block]),
        ("an operator", &[Rule::add_op, Rule::multiply_op, Rule::compare_op, Rule::dots, Rule::caret]),
        ("the end of the line", &[Rule::EOI]),
    ];
    let has = |rules: &[Rule]| positives.iter().any(|p| rules.contains(p));
    let mut words: Vec<&str> = WORDS.iter().filter(|(_, rules)| has(rules)).map(|(word, _)| *word).collect();
    if words.contains(&"an operator") {
        words.retain(|w| *w != "`{`");
    }
    if words.contains(&"a value") {
        words.retain(|w| !matches!(*w, "a name" | "`{`"));
    }
    words
}

fn message(expected: &[&str], found: &str) -> String {
    match expected {
        [] => format!("{found} is not allowed here"),
        [only] => format!("expected {only}, found {found}"),
        [first @ .., last] => format!("expected {} or {last}, found {found}", first.join(", ")),
    }
}
