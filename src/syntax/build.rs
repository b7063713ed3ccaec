//! Makes the tree from the matches of the grammar, and reports each match of a fallback rule.

use pest::iterators::{Pair, Pairs};

use super::builder::{Builder, first_line};
use super::explain::Explained;
use super::grammar::Rule;
use super::limits;
use super::tree::{Declaration, Field, Item, Let, Name, Path, Use, Value, ValueKind};
use crate::diag::{Code, Diagnostic, Fix, Span};

impl<'p> Builder<'p> {
    pub fn file(&mut self, pairs: Pairs<'p, Rule>) -> Vec<Item> {
        let mut items = Vec::new();
        let mut declarations = 0;
        for pair in pairs.flat_map(Pair::into_inner) {
            let start = pair.as_span().start();
            if matches!(pair.as_rule(), Rule::declaration | Rule::wrong_declaration | Rule::let_item | Rule::wrong_let)
            {
                declarations += 1;
                if declarations > limits::DECLARATIONS {
                    let mistake = Diagnostic::new(Code::E0103, "more than 100000 declarations and `let`s in one file");
                    self.report(mistake.label(self.span(start, start), "").help("divide the file into modules"));
                    break;
                }
            }
            match pair.as_rule() {
                Rule::use_item => items.extend(self.use_item(pair).map(Item::Use)),
                Rule::let_item => items.extend(self.let_item(pair).map(Item::Let)),
                Rule::wrong_let => items.extend(self.wrong_let(pair).map(|binding| self.as_declared(binding))),
                Rule::declaration => items.extend(self.declaration(pair).map(Item::Declaration)),
                Rule::wrong_declaration => items.extend(self.wrong_declaration(pair).map(Item::Declaration)),
                Rule::bad_item => {
                    if let Explained::DecimalComma = self.explain_pair(Rule::exact_item, &pair)
                        && let Some(Item::Let(previous)) = items.last_mut()
                    {
                        previous.value.kind = ValueKind::Error;
                    }
                }
                _ => {}
            }
        }
        items
    }

    fn use_item(&mut self, pair: Pair<'p, Rule>) -> Option<Use> {
        let start = pair.as_span().start();
        let (mut path, mut alias, mut end) = (None, None, start);
        for part in pair.into_inner() {
            let part_end = part.as_span().end();
            match part.as_rule() {
                Rule::path => path = Some(self.path(part)),
                Rule::name => alias = Some(self.name(part)),
                Rule::junk => {
                    self.explain(Rule::exact_item, start, part.as_span().start(), part_end);
                    continue;
                }
                _ => {}
            }
            end = part_end;
        }
        Some(Use { path: path?, alias, span: self.span(start, end) })
    }

    fn let_item(&mut self, pair: Pair<'p, Rule>) -> Option<Let> {
        let docs = self.docs(pair.as_span().start());
        let start = pair.as_span().start();
        let mut parts = pair.into_inner();
        parts.next();
        let name = self.name(parts.next()?);
        let value = self.given(&mut parts)?.0;
        let span = self.span(start, start).to(value.span);
        Some(Let { name, value, docs, span })
    }

    /// `name = value` outside of a block.
    fn wrong_let(&mut self, pair: Pair<'p, Rule>) -> Option<Let> {
        let docs = self.docs(pair.as_span().start());
        let (start, end) = (pair.as_span().start(), pair.as_span().end());
        let mut parts = pair.into_inner();
        let path = self.path(parts.next()?);
        let known = self.diagnostics.len();
        let value = self.given(&mut parts)?.0;
        if self.diagnostics.len() == known {
            let text = first_line(self.text(start, end));
            let mut declared = None;
            let (message, help) = if let ValueKind::Object { base: Some(kind), .. } = &value.kind
                && let ([name], [kind]) = (path.names.as_slice(), kind.names.as_slice())
            {
                let header = format!("{} {}", kind.text, name.text);
                let help = format!("write `{header} {{`");
                declared = Some(Fix::replace(name.span.to(kind.span), header).titled(help.as_str()));
                ("`=` in the header of a declaration", help)
            } else if let (ValueKind::Object { base: None, .. }, [name]) = (&value.kind, path.names.as_slice()) {
                ("`=` in the header of a declaration", format!("write `{} {{`, without `=`", name.text))
            } else if path.names.len() == 1 {
                ("a value outside of a declaration needs `let`", format!("write `let {text}`"))
            } else {
                ("a field outside of a declaration", "put it into the braces of its declaration".to_owned())
            };
            let mistake = Diagnostic::new(Code::E0105, message).label(path.span, "");
            let before = Span { end: path.span.start, ..path.span };
            let fix = Fix::replace(before, "let ").titled(help.as_str());
            let fix = declared.or_else(|| help.starts_with("write `let ").then_some(fix));
            self.report(mistake.maybe_fix(fix).help(help));
        }
        let span = path.span.to(value.span);
        let name = path.names.into_iter().next()?;
        Some(Let { name, value, docs, span })
    }

    /// `name = kind { ... }` is read as a declaration.
    fn as_declared(&self, binding: Let) -> Item {
        match binding.value.kind {
            ValueKind::Object { base: Some(Path { mut names, .. }), fields } if names.len() == 1 => {
                let (kind, name) = (names.remove(0), Some(binding.name));
                Item::Declaration(Declaration {
                    kind,
                    name,
                    base: None,
                    fields,
                    docs: binding.docs,
                    span: binding.span,
                })
            }
            _ => Item::Let(binding),
        }
    }

    /// `def kind name {`, and `kind name : kind base {`: a word of another language, or a repeated word, is skipped.
    fn word_too_many(&mut self, names: &mut Vec<Name>, base: &mut Option<Path>, junk: &Pair<'p, Rule>) -> bool {
        const OPENERS: [&str; 8] = ["def", "class", "new", "define", "declare", "create", "object", "type"];
        let (start, text) = (junk.as_span().start(), junk.as_str().trim_end());
        if !text.starts_with(|c: char| c.is_ascii_alphabetic())
            || text.contains(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        {
            return false;
        }
        let word = Name { text: text.to_owned(), span: self.span(start, start + text.len()) };
        // the word that is too many, and where what follows it begins
        let (extra, next, help) = match (names.as_slice(), &base) {
            ([first, kind], None) if OPENERS.contains(&first.text.as_str()) => {
                let (help, next) = (format!("write `{} {text} {{`", kind.text), kind.span.start);
                let extra = names.remove(0);
                names.push(word);
                (extra, next, help)
            }
            ([kind, name], Some(said)) if said.names.len() == 1 && said.names[0].text == kind.text => {
                let help = format!("write `{} {} : {text} {{`", kind.text, name.text);
                let (said, next) = (said.names[0].clone(), word.span.start);
                *base = Some(Path { span: word.span, names: vec![word] });
                (said, next, help)
            }
            _ => return false,
        };
        let message = format!("`{}` is not allowed in the header of a declaration", extra.text);
        let fix = Fix::replace(Span { end: next, ..extra.span }, "").titled(format!("remove `{}`", extra.text));
        self.report(Diagnostic::new(Code::E0105, message).label(extra.span, "").help(help).fix(fix));
        true
    }

    fn declaration(&mut self, pair: Pair<'p, Rule>) -> Option<Declaration> {
        let docs = self.docs(pair.as_span().start());
        let start = pair.as_span().start();
        let (mut names, mut base, mut fields, mut colon, mut end) = (Vec::new(), None, Vec::new(), start, start);
        for part in pair.into_inner() {
            let (part_start, part_end) = (part.as_span().start(), part.as_span().end());
            match part.as_rule() {
                Rule::name => names.push(self.name(part)),
                Rule::colon => colon = part_start,
                Rule::base => base = part.into_inner().next().map(|p| self.path(p)),
                Rule::missing => {
                    let mistake = Diagnostic::new(Code::E0101, "expected a name after `:`, found `{`");
                    let (help, place) = ("write the name of the base, or remove the `:`", self.span(colon, colon + 1));
                    let fix = Fix::replace(place, "").titled("remove the `:`");
                    self.report(mistake.label(place, "").help(help).fix(fix));
                    continue;
                }
                Rule::block => fields = self.block(part),
                Rule::header_junk if self.word_too_many(&mut names, &mut base, &part) => {}
                Rule::header_junk | Rule::junk => {
                    self.explain(Rule::exact_item, start, part_start, part_end);
                    continue;
                }
                _ => {}
            }
            end = end.max(part_end);
        }
        let span = self.span(start, self.trimmed(start, end));
        let mut names = names.into_iter();
        Some(Declaration { kind: names.next()?, name: names.next(), base, fields, docs, span })
    }

    /// `kind name = base`, also with a block behind, and `kind name = { ... }`.
    fn wrong_declaration(&mut self, pair: Pair<'p, Rule>) -> Option<Declaration> {
        let docs = self.docs(pair.as_span().start());
        let start = pair.as_span().start();
        let mut parts = pair.into_inner();
        let kind = self.name(parts.next()?);
        let name = self.name(parts.next()?);
        let equals = parts.next()?;
        let value_start = parts.peek()?.as_span().start();
        let (value, sound) = self.given(&mut parts)?;
        let span = self.span(start, start).to(value.span);
        let header = format!("{} {}", kind.text, name.text);
        let (base, fields, help) = match value.kind {
            ValueKind::Path(base) => {
                let help = format!("write `{header} : {}`", base.text());
                (Some(base), Vec::new(), help)
            }
            ValueKind::Object { base, fields } => {
                let help = match &base {
                    Some(base) => format!("write `{header} : {} {{`", base.text()),
                    None => format!("write `{header} {{`, without `=`"),
                };
                (base, fields, help)
            }
            _ => {
                let value = first_line(self.text(value_start, self.prepared.text.len()));
                (None, Vec::new(), format!("write `let {} = {value}` to name a value", name.text))
            }
        };
        if sound {
            let mistake = Diagnostic::new(Code::E0105, "`=` in the header of a declaration");
            let sign = self.span_of(&equals);
            let text = if base.is_some() { ":" } else { "" };
            // a word of another language in the place of `let`, or `=` in the place of `:`
            let fix = match help.contains("`let ") {
                true => Fix::replace(kind.span, "let"),
                false => Fix::replace(sign, text),
            };
            self.report(mistake.label(sign, "").fix(fix.titled(help.as_str())).help(help));
        }
        Some(Declaration { kind, name: Some(name), base, fields, docs, span })
    }

    pub fn block(&mut self, pair: Pair<'p, Rule>) -> Vec<Field> {
        let mut fields: Vec<Field> = Vec::new();
        let mut previous = None;
        for part in pair.into_inner() {
            let place = (part.as_span().start(), part.as_span().end());
            let before = previous.replace(place);
            if let Some(field) = fields.last_mut()
                && before.is_some_and(|before| self.goes_on(before, &part, field))
            {
                continue;
            }
            match part.as_rule() {
                Rule::field | Rule::wrong_colon => self.field(part, &mut fields),
                Rule::wrong_block => fields.extend(self.wrong_block(part)),
                Rule::wrong_nested => self.wrong_nested(part, &mut fields),
                Rule::bad_field => match self.explain_pair(Rule::exact_field, &part) {
                    Explained::DecimalComma => {
                        if let Some(previous) = fields.last_mut() {
                            previous.value.kind = ValueKind::Error;
                        }
                    }
                    Explained::Other(path) => fields.extend(path.map(|p| self.unreadable(p))),
                },
                _ => {}
            }
        }
        fields
    }

    /// A given field with an unknown value.
    fn unreadable(&self, path: Path) -> Field {
        let span = path.span;
        Field { path, value: Value { kind: ValueKind::Error, span }, docs: Vec::new(), span }
    }

    /// `path = value`, or `path : value`.
    fn field(&mut self, pair: Pair<'p, Rule>, fields: &mut Vec<Field>) {
        let docs = self.docs(pair.as_span().start());
        let end = pair.as_span().end();
        let wrong = pair.as_rule() == Rule::wrong_colon;
        let mut parts = pair.into_inner();
        let Some(path) = parts.next() else { return };
        let path_end = path.as_span().end();
        let path = self.path(path);
        let mut junk = parts.clone().filter(|p| p.as_rule() == Rule::junk);
        let swallowed = junk.next().and_then(|j| self.swallowed(j.as_span().start()));
        let colon = parts.peek().map(|p| self.span_of(&p)).unwrap_or(path.span);
        let Some((value, sound)) = self.given(&mut parts) else { return };
        if wrong && sound {
            let rest = self.text(path_end, end).trim_start().trim_start_matches(':').trim_start();
            let help = format!("write `{} = {}`", path.text(), first_line(rest));
            let mistake = Diagnostic::new(Code::E0105, "a field is given with `=`").label(colon, "").help(help);
            self.report(mistake.fix(Fix::replace(colon, " =")));
        }
        let span = path.span.to(value.span);
        fields.push(Field { path, value, docs, span });
        fields.extend(swallowed.map(|path| self.unreadable(path)));
    }

    /// `field { ... }` without `=`.
    fn wrong_block(&mut self, pair: Pair<'p, Rule>) -> Option<Field> {
        let docs = self.docs(pair.as_span().start());
        let start = pair.as_span().start();
        let mut parts = pair.into_inner();
        let path = self.path(parts.next()?);
        let block = parts.next()?;
        let span = self.span_of(&block);
        let object = ValueKind::Object { base: None, fields: self.block(block.clone()) };
        let mut value = Value { kind: object, span };
        let help = format!("write `{} = {}`", path.text(), first_line(block.as_str()));
        let mistake = Diagnostic::new(Code::E0105, "a field is given with `=`").label(path.span, "").help(help);
        let behind = Span { start: path.span.end, ..path.span };
        self.report(mistake.fix(Fix::replace(behind, " =").titled("write `=`")));
        if let Some(junk) = parts.next() {
            self.explain(Rule::exact_field, start, junk.as_span().start(), junk.as_span().end());
            value.kind = ValueKind::Error;
        }
        let span = path.span.to(span);
        Some(Field { path, value, docs, span })
    }

    /// `kind name { ... }` inside a block.
    fn wrong_nested(&mut self, pair: Pair<'p, Rule>, fields: &mut Vec<Field>) {
        let (mut names, mut base) = (Vec::new(), None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => names.push(self.name(part)),
                Rule::base => base = part.into_inner().next().map(|p| self.path(p)),
                Rule::block => {
                    // Its mistakes are reported, but its fields are dropped.
                    self.block(part);
                }
                Rule::junk => {
                    self.explain(
                        Rule::exact_field,
                        part.as_span().start(),
                        part.as_span().start(),
                        part.as_span().end(),
                    );
                }
                _ => {}
            }
        }
        let [kind, name] = names.as_slice() else { return };
        let base = base.map_or(String::new(), |b| format!("{} ", b.text()));
        let mistake = Diagnostic::new(Code::E0101, "declaration inside a block")
            .label(kind.span.to(name.span), "a block contains only fields")
            .help(format!("write `{} = {base}{{`, or move the declaration out of the block", kind.text));
        self.report(mistake);
        let path = Path { names: vec![kind.clone()], span: kind.span };
        fields.push(self.unreadable(path));
    }

    /// The value after `=` or `:`, and whether it could be read; the sign itself is skipped.
    pub fn given(&mut self, parts: &mut Pairs<'p, Rule>) -> Option<(Value, bool)> {
        let mut part = parts.next()?;
        let mut sign = None;
        if matches!(part.as_rule(), Rule::equals | Rule::colon) {
            sign = Some(part);
            part = parts.next()?;
        }
        let (start, end) = (part.as_span().start(), part.as_span().end());
        match part.as_rule() {
            Rule::missing => {
                let at = sign.map_or(start, |s| s.as_span().end());
                let sign = self.text(at.saturating_sub(1), at);
                if !self.prepared.is_poisoned(at, end) {
                    let found = self.found(at);
                    let message = format!("expected a value after `{sign}`, found {found}");
                    let help = "write a value behind it, or remove the line";
                    let mistake = Diagnostic::new(Code::E0101, message).label(self.span(at.saturating_sub(1), at), "");
                    self.report(mistake.help(help));
                }
                Some((Value { kind: ValueKind::Error, span: self.span(at, at) }, false))
            }
            Rule::bad_value => {
                self.explain(Rule::exact_value, start, start, end);
                Some((Value { kind: ValueKind::Error, span: self.span(start, end) }, false))
            }
            _ => {
                let value = self.value(part);
                match parts.next() {
                    Some(junk) => {
                        let (junk_start, junk_end) = (junk.as_span().start(), junk.as_span().end());
                        // a reported value includes the text that depends on it
                        if value.kind != ValueKind::Error {
                            self.explain(Rule::exact_value, start, junk_start, junk_end);
                        }
                        let span = value.span.to(self.span(junk_start, junk_end));
                        Some((Value { kind: ValueKind::Error, span }, false))
                    }
                    None => Some((value, true)),
                }
            }
        }
    }

    pub fn path(&mut self, pair: Pair<'p, Rule>) -> Path {
        let span = self.span_of(&pair);
        Path { names: pair.into_inner().map(|p| self.name(p)).collect(), span }
    }

    pub fn name(&mut self, pair: Pair<'p, Rule>) -> Name {
        let name = Name { text: pair.as_str().to_owned(), span: self.span_of(&pair) };
        if matches!(name.text.as_str(), "use" | "let" | "as" | "per") {
            let message = format!("`{}` is a word of the language and cannot be a name", name.text);
            self.report(Diagnostic::new(Code::E0207, message).label(name.span, "").help("choose another name"));
        }
        name
    }

    /// The `///` lines directly above the item that starts here, if it is the first on its line.
    fn docs(&self, start: usize) -> Vec<String> {
        let text = &self.prepared.text;
        let mut line = text[..start].trim_end_matches([' ', '\t', '\r', ',']).len();
        let mut docs = Vec::new();
        if !text[..line].ends_with('\n') {
            return docs;
        }
        while line > 0 {
            let above = text[..line - 1].rfind('\n').map_or(0, |i| i + 1);
            let content = text[above..line].trim();
            match content.strip_prefix("///") {
                // A line of commas leaves only its line break, which does not end a comment.
                None if !content.is_empty() && content.trim_start_matches([',', ' ', '\t']).is_empty() => {}
                Some(doc) if !doc.starts_with('/') => docs.push(doc.trim().to_owned()),
                _ => break,
            }
            line = above;
        }
        docs.reverse();
        docs
    }

    /// Without the blanks and comments that a rule with an optional end may have passed over.
    fn trimmed(&self, start: usize, end: usize) -> usize {
        start + self.text(start, end).trim_end().len()
    }
}
