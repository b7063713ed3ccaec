//! The context at the cursor, from the words before it. It needs no syntax tree, so it works in incomplete text.

use super::forms::{argument, follow, item_form, object_kind, pair_forms, word_of};
use crate::schema::{self, Field, Form, Kind, Role, Word};
use crate::syntax::{Token, TokenKind, tokens};

/// The kind of text that may stand at the cursor.
#[derive(Debug, Clone)]
pub enum Stand {
    /// The beginning of an item of the file.
    Item,
    /// Names of a module so far, after `use`.
    Module(Vec<String>),
    /// The base of a declaration, after the first names of its path.
    Base(&'static Kind, Vec<String>),
    /// A field, after the first names of its path, and the fields that the block already gives.
    Field(&'static Kind, Vec<String>, Vec<String>),
    /// A value, after the first names of its path.
    Value(Wanted, Vec<String>),
    /// The unit after a number.
    Unit(Wanted),
    /// The basis after `per`.
    Basis(Wanted),
    /// A value, or the name of an argument of a word.
    Argument(&'static Word, Wanted),
    /// A path of the scene, after its first names.
    ScenePath(Vec<String>),
    Nothing,
}

/// The expected form and field of a value.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted {
    pub form: Option<&'static Form>,
    /// The form, also of an item of a list that is written without brackets.
    pub field: Option<&'static Field>,
}

/// The kind of text that may stand at the cursor, and the range that it replaces.
#[derive(Debug, Clone)]
pub struct Context {
    pub stand: Stand,
    pub start: usize,
    pub end: usize,
}

/// A bracket around the cursor: the tokens before it in its item, and the number of items in it so far.
#[derive(Debug, Clone)]
struct Around {
    bracket: char,
    before: Vec<Token>,
    items: usize,
}

/// The words before the cursor.
struct Before<'t> {
    text: &'t str,
    around: Vec<Around>,
    item: Vec<Token>,
    /// The previous item; a bracket on a separate line may belong to it.
    previous: Vec<Token>,
    items: usize,
    /// Names of the given fields of each block, the outermost first.
    given: Vec<Vec<String>>,
}

/// The context at an offset.
pub fn context(text: &str, cursor: usize) -> Context {
    let all = tokens(text);
    let touching = all.iter().find(|t| t.start < cursor && cursor <= t.end);
    let inside_text = |t: &Token| matches!(t.kind, TokenKind::Text { .. } | TokenKind::OddText) && cursor < t.end;
    if touching.is_some_and(|t| t.is_comment() || inside_text(t) || t.kind == (TokenKind::Text { closed: false })) {
        return Context { stand: Stand::Nothing, start: cursor, end: cursor };
    }
    let word = all.iter().find(|t| t.kind == TokenKind::Word && t.start <= cursor && cursor <= t.end);
    let (start, end) = word.map_or((cursor, cursor), |t| (t.start, t.end));
    let mut before = Before::new(text);
    for (i, token) in all.iter().enumerate().take_while(|(_, t)| t.end <= start) {
        before.take(*token, &all[i..]);
    }
    before.take_word(word, &all);
    let stand = before.stand();
    let start = match stand {
        Stand::Unit(_) => before.unit_start().unwrap_or(start).min(start),
        _ => start,
    };
    Context { stand, start, end }
}

impl<'t> Before<'t> {
    fn new(text: &'t str) -> Self {
        let (around, item, previous) = (Vec::new(), Vec::new(), Vec::new());
        Before { text, around, item, previous, items: 0, given: vec![Vec::new()] }
    }

    fn said(&self, token: &Token) -> &'t str {
        token.text(self.text)
    }

    /// Reads one token; `rest` begins with it.
    fn take(&mut self, token: Token, rest: &[Token]) {
        if token.is_comment() {
            return;
        }
        if self.begins_item_of_file(&token, rest) {
            self.around.clear();
            self.given.truncate(1);
            self.end_item();
        }
        match token.kind {
            TokenKind::LineBreak if self.goes_on() => {}
            TokenKind::LineBreak => self.end_item(),
            TokenKind::Sign if self.said(&token) == "," => self.end_item(),
            TokenKind::Open(bracket) => {
                if self.item.is_empty() && bracket == '{' && self.around.is_empty() {
                    self.item = std::mem::take(&mut self.previous);
                }
                let before = std::mem::take(&mut self.item);
                self.around.push(Around { bracket, before, items: self.items });
                self.items = 0;
                self.given.push(Vec::new());
            }
            TokenKind::Close(_) => {
                if let Some(around) = self.around.pop() {
                    (self.item, self.items) = (around.before, around.items);
                    self.given.pop();
                }
                self.item.push(token);
            }
            _ => self.item.push(token),
        }
    }

    /// Reads the word at the cursor. It may begin an item of the file, which ends an open block.
    fn take_word(&mut self, word: Option<&Token>, all: &[Token]) {
        let Some(word) = word else { return };
        let rest = &all[all.iter().position(|t| t.start == word.start).unwrap_or(0)..];
        if self.begins_item_of_file(word, rest) {
            self.around.clear();
            self.given.truncate(1);
            self.end_item();
        }
    }

    /// Whether a token is the header of a known kind at the left margin, which does not occur inside a block.
    fn begins_item_of_file(&self, token: &Token, rest: &[Token]) -> bool {
        let margin = token.start == 0 || self.text.as_bytes()[token.start - 1] == b'\n';
        if self.around.is_empty() || token.kind != TokenKind::Word || !margin {
            return false;
        }
        let next = rest.get(1).map(|t| (t.kind, self.said(t)));
        let header = matches!(next, Some((TokenKind::Word, _) | (TokenKind::Open('{'), _) | (TokenKind::Sign, ":")));
        let word = self.said(token);
        header && (matches!(word, "use" | "let") || schema::kind(word).is_some_and(|k| k.role != Role::Nested))
    }

    /// Whether the item continues in the next line.
    fn goes_on(&self) -> bool {
        self.item.last().is_some_and(|t| t.kind == TokenKind::Sign && !matches!(self.said(t), "?" | "."))
    }

    fn end_item(&mut self) {
        if self.item.is_empty() {
            return;
        }
        let name = self.path(&self.item);
        if let (Some(given), Some(equals)) = (self.given.last_mut(), name.filter(|(_, n)| *n < self.item.len())) {
            given.push(equals.0.join("."));
        }
        self.previous = std::mem::take(&mut self.item);
        self.items += 1;
    }

    /// The names joined by dots at the beginning of an item, and the number of their tokens.
    fn path(&self, item: &[Token]) -> Option<(Vec<String>, usize)> {
        let mut names = Vec::new();
        for (i, token) in item.iter().enumerate() {
            let word = token.kind == TokenKind::Word;
            match (i % 2 == 0, word) {
                (true, true) => names.push(self.said(token).to_owned()),
                (false, false) if self.said(token) == "." => {}
                _ => return Some((names, i)),
            }
        }
        Some((names, item.len()))
    }

    /// The names of a path that ends with a dot right before the cursor: `rails.` and `base.open.`.
    fn path_before(&self) -> Vec<String> {
        let mut names = Vec::new();
        let mut rest = self.item.as_slice();
        while let [head @ .., word, dot] = rest
            && self.said(dot) == "."
            && word.kind == TokenKind::Word
        {
            names.insert(0, self.said(word).to_owned());
            rest = head;
        }
        names
    }

    fn stand(&self) -> Stand {
        let mut here = Inside::File;
        for around in &self.around {
            here = self.inside(here, around);
        }
        match here {
            Inside::File => self.in_file(),
            Inside::Fields(kind) => self.in_fields(kind),
            Inside::Items(key, value) => self.in_items(key, value),
            Inside::Axes => self.in_axes(),
            Inside::Arguments(word, wanted) => self.in_arguments(word, wanted),
            Inside::Unknown => self.value(&self.item, Wanted::default()),
        }
    }

    /// The context inside one more bracket.
    fn inside(&self, here: Inside, around: &Around) -> Inside {
        let item = around.before.as_slice();
        match here {
            Inside::File => {
                let kind = item.first().and_then(|t| meant(self.said(t)));
                match (kind, around.bracket) {
                    (Some(kind), '{') => Inside::Fields(kind),
                    _ => Inside::Unknown,
                }
            }
            Inside::Fields(kind) => {
                let Some((wanted, value)) = self.field_value(kind, item) else { return Inside::Unknown };
                self.opened(wanted, value, around.bracket)
            }
            Inside::Items(key, value) => {
                let colon = item.iter().position(|t| self.said(t) == ":");
                let (wanted, rest) = match colon {
                    Some(i) => (value, &item[i + 1..]),
                    None => (if key.form.is_some() { key } else { value }, item),
                };
                self.opened(wanted, rest, around.bracket)
            }
            Inside::Axes => {
                let colon = item.iter().position(|t| self.said(t) == ":");
                colon.map_or(Inside::Unknown, |i| self.opened(Wanted::default(), &item[i + 1..], around.bracket))
            }
            Inside::Arguments(word, wanted) => {
                let (wanted, rest) = self.argument(word, wanted, item, around.items);
                self.opened(wanted, rest, around.bracket)
            }
            Inside::Unknown => Inside::Unknown,
        }
    }

    /// The expected value of a field of a block, and the tokens of the value so far.
    fn field_value<'i>(&self, kind: &'static Kind, item: &'i [Token]) -> Option<(Wanted, &'i [Token])> {
        let (names, taken) = self.path(item)?;
        let sign = item.get(taken)?;
        let wanted = wanted(kind, &names).unwrap_or_default();
        match self.said(sign) {
            "=" | ":" | ":=" => Some((wanted, &item[taken + 1..])),
            // `pad { ...` without its `=`
            _ => None,
        }
    }

    /// The context inside a bracket that opens in a value.
    fn opened(&self, wanted: Wanted, value: &[Token], bracket: char) -> Inside {
        match bracket {
            '{' => wanted.form.and_then(object_kind).map_or(Inside::Unknown, Inside::Fields),
            '[' => match wanted.form {
                Some(Form::Axes | Form::Settings) => Inside::Axes,
                Some(form) => {
                    let with = |form| Wanted { form, ..wanted };
                    let (key, value) = pair_forms(form).map_or((None, None), |(key, value)| (Some(key), Some(value)));
                    Inside::Items(with(key), with(value.or(Some(item_form(form)))))
                }
                None => Inside::Unknown,
            },
            _ => match value.last().filter(|t| t.kind == TokenKind::Word) {
                Some(word) => match word_of(wanted.form, self.said(word)) {
                    Some(known) => Inside::Arguments(known, wanted),
                    None => Inside::Items(Wanted::default(), wanted),
                },
                None => Inside::Items(Wanted::default(), wanted),
            },
        }
    }

    fn in_file(&self) -> Stand {
        let words: Vec<&str> = self.item.iter().map(|t| self.said(t)).collect();
        match words.as_slice() {
            [] => Stand::Item,
            ["use", ..] => {
                let (names, taken) = self.path(&self.item[1..]).unwrap_or_default();
                let open = taken == 0 || words.last() == Some(&".");
                if open && taken + 1 == words.len() { Stand::Module(names) } else { Stand::Nothing }
            }
            ["let", _, "=", ..] => self.value(&self.item[3..], Wanted::default()),
            [kind, ..] => {
                let colon = words.iter().position(|word| *word == ":");
                match (meant(kind), colon) {
                    (Some(kind), Some(colon)) => {
                        let (names, taken) = self.path(&self.item[colon + 1..]).unwrap_or_default();
                        let open = taken == 0 || words.last() == Some(&".");
                        if open && colon + 1 + taken == words.len() { Stand::Base(kind, names) } else { Stand::Nothing }
                    }
                    _ => Stand::Nothing,
                }
            }
        }
    }

    fn in_fields(&self, kind: &'static Kind) -> Stand {
        if let Some((wanted, value)) = self.field_value(kind, &self.item) {
            return self.value(value, wanted);
        }
        let (names, taken) = self.path(&self.item).unwrap_or_default();
        let open = self.item.is_empty() || self.item.last().is_some_and(|t| self.said(t) == ".");
        let given = self.given.last().cloned().unwrap_or_default();
        if open && taken == self.item.len() { Stand::Field(kind, names, given) } else { Stand::Nothing }
    }

    fn in_items(&self, key: Wanted, value: Wanted) -> Stand {
        match self.item.iter().position(|t| self.said(t) == ":") {
            Some(colon) => self.value(&self.item[colon + 1..], value),
            None => self.value(&self.item, if key.form.is_some() { key } else { value }),
        }
    }

    fn in_axes(&self) -> Stand {
        let Some(colon) = self.item.iter().position(|t| self.said(t) == ":") else {
            return Stand::ScenePath(self.path_before());
        };
        self.value(&self.item[colon + 1..], Wanted::default())
    }

    fn in_arguments(&self, word: &'static Word, wanted: Wanted) -> Stand {
        let (inner, rest) = self.argument(word, wanted, &self.item, self.items);
        match self.value(rest, inner) {
            Stand::Value(wanted, names) if names.is_empty() && self.item.is_empty() => Stand::Argument(word, wanted),
            other => other,
        }
    }

    /// The expected value of an argument, by its name or its position, and the tokens of the value so far.
    fn argument<'i>(
        &self,
        word: &'static Word,
        wanted: Wanted,
        item: &'i [Token],
        place: usize,
    ) -> (Wanted, &'i [Token]) {
        let of = |field: &'static Field| Wanted { form: Some(&field.form), field: Some(field) };
        match item {
            [name, sign, rest @ ..] if matches!(self.said(sign), "=" | ":") => {
                let field = word.arguments.iter().find(|a| a.name == self.said(name));
                (field.map_or_else(Wanted::default, of), rest)
            }
            // the mean of a random value has the form of the field itself
            _ if word.name == schema::RANDOM.name => (wanted, item),
            _ => (word.arguments.get(place).map_or_else(Wanted::default, of), item),
        }
    }

    /// The context after these tokens of a value.
    fn value(&self, value: &[Token], wanted: Wanted) -> Stand {
        let Some(last) = value.last() else { return Stand::Value(wanted, Vec::new()) };
        if self.said(last) == "per" {
            return Stand::Basis(wanted);
        }
        if self.said(last) == "." {
            return Stand::Value(wanted, self.path_before());
        }
        if self.unit_tokens(value).is_some() {
            return Stand::Unit(wanted);
        }
        match last.kind {
            TokenKind::Sign if self.said(last) != "?" => Stand::Value(wanted, Vec::new()),
            TokenKind::Close(')' | ']') => Stand::Unit(wanted),
            _ => Stand::Nothing,
        }
    }

    /// Index of the first token of the unit after the last number of a value.
    fn unit_tokens(&self, value: &[Token]) -> Option<usize> {
        // an exponent is also a number: `N/mm^3`
        let number = (0..value.len())
            .rev()
            .find(|i| value[*i].kind == TokenKind::Number && !(*i > 0 && self.said(&value[*i - 1]) == "^"))?;
        let unit = &value[number + 1..];
        // operators of arithmetic have spaces around them
        let touches = |i: usize| i > 0 && unit[i - 1].end == unit[i].start;
        let part = |i: usize| match unit[i].kind {
            TokenKind::Word => self.said(&unit[i]) != "per",
            TokenKind::Number => true,
            TokenKind::Sign => self.said(&unit[i]) == "%" || "/*^·".contains(self.said(&unit[i])) && touches(i),
            _ => false,
        };
        (0..unit.len()).all(part).then_some(number + 1)
    }

    /// Offset of the start of the unit before the cursor.
    fn unit_start(&self) -> Option<usize> {
        let from = self.unit_tokens(&self.item)?;
        self.item.get(from).map(|t| t.start)
    }
}

/// The content of a pair of brackets.
#[derive(Clone, Copy)]
enum Inside {
    File,
    Fields(&'static Kind),
    /// Items, or pairs of a key and a value.
    Items(Wanted, Wanted),
    /// Pairs of a path of the scene and values.
    Axes,
    Arguments(&'static Word, Wanted),
    Unknown,
}

/// The kind with a name, also if the name is misspelt.
fn meant(name: &str) -> Option<&'static Kind> {
    schema::kind(name).filter(|kind| kind.role != Role::Nested).or_else(|| schema::meant_kind(name))
}

/// The expected value of the field at a path; for a misspelt name, of the field that is meant.
fn wanted(kind: &'static Kind, names: &[String]) -> Option<Wanted> {
    let path: Vec<&str> = names.iter().map(String::as_str).collect();
    if let Some((_, field)) = follow(kind, &path) {
        return Some(Wanted { form: Some(&field.form), field: Some(field) });
    }
    let (last, outer) = path.split_last()?;
    let inner = match outer {
        [] => Some(kind),
        _ => follow(kind, outer).and_then(|(_, field)| object_kind(&field.form)),
    };
    let field = match inner {
        Some(inner) => inner.field(inner.meant(last)?)?,
        None => {
            let (_, field) = follow(kind, outer)?;
            match argument(&field.form, last) {
                Some((_, argument)) => argument,
                // a pair by the last name of its key
                None => {
                    return pair_forms(&field.form).map(|(_, form)| Wanted { form: Some(form), field: Some(field) });
                }
            }
        }
    };
    Some(Wanted { form: Some(&field.form), field: Some(field) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The context at `|` in a text.
    fn stand(text: &str) -> String {
        let cursor = text.find('|').unwrap();
        let text = text.replace('|', "");
        let found = context(&text, cursor);
        let place = &text[found.start..found.end];
        let said = |wanted: Wanted| wanted.field.map_or("?", |field| field.name);
        let stand = match found.stand {
            Stand::Item => "item".into(),
            Stand::Module(names) => format!("module {names:?}"),
            Stand::Base(kind, names) => format!("base {} {names:?}", kind.name),
            Stand::Field(kind, names, given) => format!("field {} {names:?} {given:?}", kind.name),
            Stand::Value(wanted, names) => format!("value {} {names:?}", said(wanted)),
            Stand::Unit(wanted) => format!("unit {}", said(wanted)),
            Stand::Basis(wanted) => format!("basis {}", said(wanted)),
            Stand::Argument(word, wanted) => format!("argument {} {}", word.name, said(wanted)),
            Stand::ScenePath(names) => format!("scene {names:?}"),
            Stand::Nothing => "nothing".into(),
        };
        format!("{stand} `{place}`")
    }

    #[test]
    fn half_typed_text_says_what_may_follow() {
        for (text, expected) in [
            ("|", "item ``"),
            ("use std\npa|", "item `pa`"),
            ("use st|", "module [] `st`"),
            ("use site.|", "module [\"site\"] ``"),
            ("pad na|", "nothing `na`"),
            ("pad soft : pads.me|", "base pad [\"pads\"] `me`"),
            ("pad soft { stiff|", "field pad [] [] `stiff`"),
            ("pad soft { stiffness = 40 MN/m, da|", "field pad [] [\"stiffness\"] `da`"),
            ("usp soft {\n  bedding_modulus = 0.1 N/|", "unit bedding_modulus `N/`"),
            ("usp soft {\n  bedding = 100 MN/|", "unit bedding_modulus `MN/`"),
            ("pad soft {\n  stiffness = 40 |", "unit stiffness ``"),
            ("support s {\n  stiffness = 40 MN/m per se|", "basis stiffness `se`"),
            ("trackform open { rail = rails.|", "value rail [\"rails\"] ``"),
            ("trackform open { pad = { stiff|", "field pad [] [] `stiff`"),
            ("trackform open { pad.da|", "field trackform [\"pad\"] [] `da`"),
            ("track line {\n  sections = [open: 42 |", "unit sections ``"),
            ("track line {\n  sections = [o|", "value sections [] `o`"),
            ("solve {\n  update_every = geometric(4 |", "unit first ``"),
            ("solve {\n  update_every = geometric(4 axles, ra|", "argument geometric ratio `ra`"),
            ("study s { vary = [open.pad.|", "scene [\"open\", \"pad\"] ``"),
            ("pad soft {\n  stiffness = 40\ntrack line {\n  se|", "field track [] [] `se`"),
            ("pad soft { stiffness = 2 * |", "value stiffness [] ``"),
            ("// pad |", "nothing ``"),
            ("scenario { title = \"pad |\" }", "nothing ``"),
        ] {
            assert_eq!(stand(text), expected, "{text}");
        }
    }

    proptest::proptest! {
        #[test]
        fn any_text_has_an_answer(text in "[a-z{}\\[\\]():=,. \n\"0-9µ]{0,60}", at in 0usize..80) {
            let at = (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap();
            let found = context(&text, at);
            proptest::prop_assert!(text.get(found.start..found.end).is_some());
        }
    }
}
