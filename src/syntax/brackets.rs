//! Brackets of the wrong kind, or missing brackets: fields in parentheses, items in braces, lists without brackets.
//! Each is reported once, with the right text.

use pest::Parser;
use pest::iterators::Pair;

use super::builder::{Builder, first_line};
use super::grammar::{Grammar, Rule};
use super::token::{self, Kind};
use super::tree::{Entry, Field, Value, ValueKind};
use super::value::Told;
use crate::diag::{Code, Diagnostic, Fix};

impl<'p> Builder<'p> {
    /// Whether part of a block only goes on with the list that the field before it, at `before`, began without
    /// brackets: `at = -1, -2 m`.
    pub fn goes_on(&mut self, before: (usize, usize), part: &Pair<'p, Rule>, field: &mut Field) -> bool {
        let (start, end) = (part.as_span().start(), part.as_span().end());
        let comma = self.text(before.1, start).trim_matches([' ', '\t']) == ",";
        let pair = part.as_rule() == Rule::wrong_colon;
        if !comma || !pair && part.as_rule() != Rule::bad_field || self.decimal_comma(start).is_some() {
            return false;
        }
        let text = self.text(start, end);
        let reported = field.value.kind == ValueKind::Error;
        if pair {
            // `sections = open: 42 m, stiff: 24 m` was reported at its first pair
            return reported && self.text(before.0, before.1).contains(':');
        }
        if Grammar::parse(Rule::exact_value, text).is_err() {
            return false;
        }
        if !reported {
            let (path, first) = self.text(before.0, before.1).split_once('=').unwrap_or_default();
            let items = self.items_of_line(start);
            let list = format!("{} = {}", path.trim(), listed(first.trim(), items));
            let last = start + items.trim_end().len();
            let mistake = Diagnostic::new(Code::E0101, "several values need brackets")
                .label(self.span(start, last), "a field is expected here");
            let whole = self.span(before.0, last);
            self.report(mistake.write(whole, list));
        }
        field.value.kind = ValueKind::Error;
        true
    }

    /// The items from here to the end of the line or of the surrounding bracket, up to the first field.
    pub fn items_of_line(&self, start: usize) -> &'p str {
        let text: &'p str = &self.prepared.text;
        let (mut depth, mut at, mut end, mut item) = (0, start, start, start);
        while let Some(token) = token::next(text, at) {
            match token.kind {
                Kind::LineBreak | Kind::Comment => break,
                Kind::Open(_) => depth += 1,
                Kind::Close(_) if depth == 0 => break,
                Kind::Close(_) => depth -= 1,
                Kind::Sign if depth == 0 && token.text(text) == "," => item = token.start,
                Kind::Sign if depth == 0 && token.text(text) == "=" => return &text[start..item],
                _ => {}
            }
            end = token.end;
            at = token.end;
        }
        &text[start..end]
    }

    /// Reports braces around items that are not fields: `{-20, -5} sleepers`, `geometric{4 axles, 0.2}`, `{k}`.
    pub fn holds_items(&mut self, object: &Pair<'p, Rule>) -> bool {
        let Some(block) = object.clone().into_inner().find(|p| p.as_rule() == Rule::block) else { return false };
        let mut items = block.clone().into_inner().filter(|p| p.as_rule() != Rule::close_brace).peekable();
        let bad = |p: &Pair<Rule>| {
            p.as_rule() == Rule::bad_field && Grammar::parse(Rule::exact_entry, p.as_str().trim_end()).is_ok()
        };
        if items.peek().is_none() || !items.clone().all(|p| bad(&p)) {
            return false;
        }
        let (count, pairs) = (items.clone().count(), items.any(|p| p.as_str().contains(':')));
        let base = object.clone().into_inner().find(|p| p.as_rule() == Rule::path);
        let whole = block.as_str();
        let inner = whole[1..whole.len() - usize::from(whole.ends_with('}'))].split_whitespace();
        let inner = inner.collect::<Vec<_>>().join(" ");
        let at = self.span_of(&block);
        let (message, written, place) = match base {
            Some(word) => {
                let written = format!("{}({inner})", word.as_str());
                ("the arguments of a word need parentheses", written, self.span_of(&word).to(at))
            }
            None if pairs && inner.starts_with('"') => (
                "names have no quotes, and fields are given with `=`",
                format!("{{ {} }}", inner.replace("\": ", " = ").replace('"', "")),
                at,
            ),
            None if count == 1 && !pairs => ("braces hold fields, `name = value`", inner, at),
            None => ("braces hold fields, brackets hold items", format!("[{inner}]"), at),
        };
        self.report(Diagnostic::new(Code::E0101, message).label(at, "").write(place, written));
        true
    }

    /// `(stiffness = 40 MN/m)`: an object in the brackets of arguments.
    pub fn group_of_fields(&mut self, group: &Pair<'p, Rule>) -> Option<Value> {
        let has_sign = |entry: Pair<'p, Rule>| entry.into_inner().any(|p| p.as_rule() == Rule::equals);
        if !group.clone().into_inner().any(has_sign) {
            return None;
        }
        let span = self.span_of(group);
        let whole = group.as_str();
        let inner = first_line(whole.trim_start_matches('(').trim_start()).trim_end_matches(')').trim_end();
        let close = if whole.contains('\n') { "" } else { " }" };
        let mistake = Diagnostic::new(Code::E0105, "fields need braces").label(span, "");
        let fix = Fix::replace(span, format!("{{ {inner} }}"));
        self.report(mistake.help(format!("write `{{ {inner}{close}`")).maybe_fix((!close.is_empty()).then_some(fix)));
        let mut told = Told { equals: true, colon: false };
        let mut fields = Vec::new();
        for entry in group.clone().into_inner() {
            let Entry { key: Some(Value { kind: ValueKind::Path(path), .. }), value } = self.entry(entry, &mut told)
            else {
                return Some(Value { kind: ValueKind::Error, span });
            };
            let span = path.span.to(value.span);
            fields.push(Field { path, value, docs: Vec::new(), span });
        }
        Some(Value { kind: ValueKind::Object { base: None, fields }, span })
    }

    /// Reports a list whose entries are all `(key, value)`.
    pub fn pairs_in_groups(&mut self, list: &Pair<'p, Rule>) -> bool {
        let entries: Vec<_> = list.clone().into_inner().filter(|p| p.as_rule() == Rule::entry).collect();
        let pairs: Option<Vec<String>> = entries.iter().map(|entry| Some(in_group(entry)?.1)).collect();
        let Some(pairs) = pairs.filter(|pairs| !pairs.is_empty()) else { return false };
        let at = self.span_of(list);
        let mistake =
            Diagnostic::new(Code::E0105, "a pair in a list is `key: value`").label(at, "pairs in parentheses");
        self.report(mistake.write(at, format!("[{}]", pairs.join(", "))));
        true
    }

    pub fn group_as_pair(&mut self, entry: Pair<'p, Rule>) -> Entry {
        let span = self.span_of(&entry);
        let mut told = Told::default();
        let halves = in_group(&entry).map(|(halves, _)| halves).unwrap_or_default();
        let mut halves = halves.into_iter().map(|half| self.entry(half, &mut told).value);
        let (key, value) = (halves.next(), halves.next());
        Entry { key, value: value.unwrap_or(Value { kind: ValueKind::Error, span }) }
    }
}

/// The two halves of an entry that is `(key, value)`, and the right pair.
fn in_group<'p>(entry: &Pair<'p, Rule>) -> Option<(Vec<Pair<'p, Rule>>, String)> {
    let mut pair = entry.clone();
    while pair.as_rule() != Rule::group {
        let mut parts = pair.into_inner();
        pair = parts.next().filter(|_| parts.next().is_none())?;
    }
    let halves: Vec<_> = pair.into_inner().collect();
    let [key, value] = halves.as_slice() else { return None };
    let written = format!("{}: {}", key.as_str().trim(), value.as_str().trim());
    let plain =
        |p: &Pair<Rule>| !p.clone().into_inner().any(|part| matches!(part.as_rule(), Rule::equals | Rule::colon));
    (plain(key) && plain(value)).then_some((halves, written))
}

/// `[-20, -5] sleepers` of `-20` and `-5 sleepers`: the unit of the last item is moved behind the list if the others
/// have none.
fn listed(first: &str, rest: &str) -> String {
    let items: Vec<&str> = std::iter::once(first).chain(rest.split(',').map(str::trim)).collect();
    let bare = |text: &str| {
        !text.is_empty() && text.trim_start_matches(['+', '-']).chars().all(|c| c.is_ascii_digit() || c == '.')
    };
    if let Some((last, before)) = items.split_last()
        && let Some((number, unit)) = last.split_once(' ')
        && bare(number)
        && before.iter().all(|item| bare(item))
    {
        return format!("[{}, {number}] {unit}", before.join(", "));
    }
    format!("[{}]", items.join(", "))
}
