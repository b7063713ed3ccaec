//! Builds the values of the tree: the grammar gives precedence, this module gives spans and bounds.

use pest::iterators::Pair;

use super::builder::Builder;
use super::grammar::Rule;
use super::limits;
use super::tree::{Argument, BinaryOp, Comparison, Entry, UnitText, Value, ValueKind};
use crate::diag::{Code, Diagnostic, Fix, Span};

/// Reports already made on a list or on arguments.
#[derive(Default)]
pub(super) struct Told {
    /// `=` instead of `:`.
    pub equals: bool,
    /// `:` instead of `=`, or a missing `:`.
    pub colon: bool,
}

impl<'p> Builder<'p> {
    pub fn value(&mut self, pair: Pair<'p, Rule>) -> Value {
        // Most values use only one of the seven levels of precedence.
        let mut pair = pair;
        while let Rule::value | Rule::range | Rule::sum | Rule::product | Rule::factor | Rule::power = pair.as_rule() {
            let mut parts = pair.clone().into_inner();
            match (parts.next(), parts.next()) {
                (Some(only), None) => pair = only,
                _ => break,
            }
        }
        let span = self.span_of(&pair);
        match pair.as_rule() {
            Rule::value => self.comparison(pair),
            Rule::range => self.range(pair),
            Rule::sum | Rule::product => self.chain(pair),
            Rule::factor => self.signed(pair),
            Rule::power => self.power(pair),
            Rule::quantity => self.quantity(pair),
            Rule::text => Value { kind: self.quoted(pair), span },
            Rule::hole => {
                let at = pair.as_span();
                let known = self.prepared.is_poisoned(at.start(), at.end());
                Value { kind: if known { ValueKind::Error } else { ValueKind::Hole }, span }
            }
            Rule::list => self.list(pair),
            Rule::call => self.call(pair),
            Rule::object if self.holds_items(&pair) => Value { kind: ValueKind::Error, span },
            Rule::object => {
                let (mut base, mut fields) = (None, Vec::new());
                for part in pair.into_inner() {
                    match part.as_rule() {
                        Rule::path => base = Some(self.path(part)),
                        Rule::block => fields = self.block(part),
                        _ => {}
                    }
                }
                Value { kind: ValueKind::Object { base, fields }, span }
            }
            Rule::path => Value { kind: ValueKind::Path(self.path(pair)), span },
            Rule::group => self.group(pair),
            _ => Value { kind: ValueKind::Error, span },
        }
    }

    fn comparison(&mut self, pair: Pair<'p, Rule>) -> Value {
        let (mut operands, mut operators) = (Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match (part.as_rule(), part.as_str()) {
                (Rule::compare_op, "<") => operators.push(Comparison::Less),
                (Rule::compare_op, "<=") => operators.push(Comparison::LessOrEqual),
                (Rule::compare_op, ">") => operators.push(Comparison::Greater),
                (Rule::compare_op, _) => operators.push(Comparison::GreaterOrEqual),
                _ => operands.push(self.value(part)),
            }
        }
        let span = around(&operands).unwrap_or(self.span(0, 0));
        Value { kind: ValueKind::Compare { operands, operators }, span }
    }

    /// `a .. b per basis`, or only one of the two parts.
    fn range(&mut self, pair: Pair<'p, Rule>) -> Value {
        let (start, mut bounds, mut dots, mut basis) = (pair.as_span().start(), Vec::new(), None, None);
        let mut ends = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::dots | Rule::kw_per => {}
                Rule::wrong_dots => dots = Some(part),
                Rule::name => basis = Some(self.name(part)),
                _ => {
                    ends.push(part.as_str().trim());
                    bounds.push(self.value(part));
                }
            }
        }
        if let (Some(dots), [from, to]) = (dots, ends.as_slice()) {
            let message = format!("`{}` between the ends of a range", dots.as_str());
            let mistake = Diagnostic::new(Code::E0105, message).label(self.span_of(&dots), "expected `..`");
            let fix = Fix::replace(self.span_of(&dots), "..");
            self.report(mistake.help(format!("write `{from} .. {to}`")).fix(fix));
        }
        let mut bounds = bounds.into_iter();
        let first = bounds.next().unwrap_or(Value { kind: ValueKind::Error, span: self.span(start, start) });
        let value = match bounds.next() {
            Some(last) => {
                let span = first.span.to(last.span);
                Value { kind: ValueKind::Range(Box::new(first), Box::new(last)), span }
            }
            None => first,
        };
        match basis {
            Some(basis) => {
                let span = value.span.to(basis.span);
                Value { kind: ValueKind::Per(Box::new(value), basis), span }
            }
            None => value,
        }
    }

    /// `a + b - c` or `a * b / c`, from the left. The depth of the tree grows with the length of the chain, so the
    /// length has a bound.
    fn chain(&mut self, pair: Pair<'p, Rule>) -> Value {
        let own = pair.clone().into_inner().count() / 2;
        let span = self.span_of(&pair);
        if self.operations + own > limits::OPERATIONS {
            let message = format!("more than {} operations inside each other", limits::OPERATIONS);
            self.report(
                Diagnostic::new(Code::E0103, message).label(span, "").help("give parts of the value names with `let`"),
            );
            return Value { kind: ValueKind::Error, span };
        }
        self.operations += own;
        let mut left: Option<Value> = None;
        let mut operator = BinaryOp::Add;
        for part in pair.into_inner() {
            match (part.as_rule(), part.as_str()) {
                (Rule::add_op, "+") => operator = BinaryOp::Add,
                (Rule::add_op, _) => operator = BinaryOp::Subtract,
                (Rule::multiply_op, "*") => operator = BinaryOp::Multiply,
                (Rule::multiply_op, _) => operator = BinaryOp::Divide,
                _ => {
                    let right = self.value(part);
                    left = Some(match left {
                        Some(left) => binary(left, operator, right),
                        None => right,
                    });
                }
            }
        }
        self.operations -= own;
        left.unwrap_or(Value { kind: ValueKind::Error, span })
    }

    /// A sign in front: `-` makes a negation, `+` has no effect but belongs to the place.
    fn signed(&mut self, pair: Pair<'p, Rule>) -> Value {
        let start = self.span(pair.as_span().start(), pair.as_span().start());
        let mut negative = false;
        let mut value = Value { kind: ValueKind::Error, span: start };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::sign => negative = part.as_str() == "-",
                _ => value = self.value(part),
            }
        }
        let span = start.to(value.span);
        match negative {
            true => Value { kind: ValueKind::Negate(Box::new(value)), span },
            false => Value { span, ..value },
        }
    }

    fn power(&mut self, pair: Pair<'p, Rule>) -> Value {
        let span = self.span_of(&pair);
        let mut operands = pair.into_inner().filter(|p| p.as_rule() != Rule::caret);
        let (Some(base), Some(exponent)) = (operands.next(), operands.next()) else {
            return Value { kind: ValueKind::Error, span };
        };
        let (base, exponent) = (self.value(base), self.value(exponent));
        let literal = match &exponent.kind {
            ValueKind::Negate(inner) => &inner.kind,
            kind => kind,
        };
        if let ValueKind::Number { value, .. } = literal
            && *value > limits::EXPONENT
        {
            self.exponent_beyond(exponent.span);
            return Value { kind: ValueKind::Error, span: base.span.to(exponent.span) };
        }
        binary(base, BinaryOp::Power, exponent)
    }

    fn exponent_beyond(&mut self, span: Span) {
        let mistake = Diagnostic::new(Code::E0103, "exponent beyond -9 .. 9");
        self.report(mistake.label(span, ""));
    }

    fn quantity(&mut self, pair: Pair<'p, Rule>) -> Value {
        let mut parts = pair.into_inner();
        let Some(number) = parts.next() else { return Value { kind: ValueKind::Error, span: self.span(0, 0) } };
        let mut span = self.span_of(&number);
        let unit = match parts.next().map(|u| self.unit(u)) {
            Some(Ok(unit)) => Some(unit),
            Some(Err(beyond)) => return Value { kind: ValueKind::Error, span: span.to(beyond) },
            None => None,
        };
        if let Some(unit) = &unit {
            span = span.to(unit.span);
        }
        let digits = number.as_str().replace('_', "");
        if number.as_rule() == Rule::wrong_number {
            let right = match number.as_str() {
                text if text.starts_with('.') => format!("0{text}"),
                text => text.replacen('.', ".0", 1),
            };
            let right = match &unit {
                Some(unit) => format!("{right} {}", unit.text),
                None => right,
            };
            let mistake = Diagnostic::new(Code::E0105, "a decimal point has digits on both sides");
            self.report(mistake.label(span, "").write(span, right));
        }
        let value: f64 = digits.parse().unwrap_or(f64::NAN);
        if !value.is_finite() {
            let mistake = Diagnostic::new(Code::E0103, "number too large");
            self.report(mistake.label(span, "the largest is about 1.8e308"));
            return Value { kind: ValueKind::Error, span };
        }
        Value { kind: ValueKind::Number { value, unit }, span }
    }

    /// A unit as written; its words are looked up later, its exponents are bounded here.
    fn unit(&mut self, pair: Pair<'p, Rule>) -> Result<UnitText, Span> {
        let span = self.span_of(&pair);
        let text = pair.as_str();
        for exponent in text.split('^').skip(1) {
            let exponent = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
            let length = exponent.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(exponent.len());
            if exponent[..length].parse::<f64>().is_ok_and(|e| e > limits::EXPONENT) {
                self.exponent_beyond(span);
                return Err(span);
            }
        }
        Ok(UnitText { text: text.to_owned(), span })
    }

    fn quoted(&mut self, pair: Pair<'p, Rule>) -> ValueKind {
        let start = pair.as_span().start();
        let raw = pair.as_str();
        let mut text = String::with_capacity(raw.len());
        let mut inner = raw.get(1..raw.len().saturating_sub(1)).unwrap_or("").char_indices();
        while let Some((i, c)) = inner.next() {
            if c != '\\' {
                text.push(c);
                continue;
            }
            match inner.next() {
                Some((_, c @ ('"' | '\\'))) => text.push(c),
                other => {
                    let c = other.map_or(String::new(), |(_, c)| c.to_string());
                    let at = self.span(start + 1 + i, start + 2 + i + c.len());
                    let mistake = Diagnostic::new(Code::E0101, format!("`\\{c}` in a text"));
                    let whole = raw.trim_matches('"');
                    let help = match (whole.contains(":\\"), whole.ends_with(".csv") || whole.ends_with(".stl")) {
                        (true, true) => {
                            "a file lies below the main file's folder: copy it there and name it from there, \
                                         with `/` between folders"
                                .to_owned()
                        }
                        (false, true) => format!("write `{}`", whole.replace('\\', "/")),
                        _ if whole.contains("\\\\") => format!("write `\\\\{c}`"),
                        _ => format!("write `\"{}\"`", whole.replace('\\', "\\\\")),
                    };
                    self.report(mistake.label(at, "only `\\\"` and `\\\\` are known").help(help));
                    return ValueKind::Error;
                }
            }
        }
        ValueKind::Text(text)
    }

    fn list(&mut self, pair: Pair<'p, Rule>) -> Value {
        let start = pair.as_span().start();
        let mut span = self.span(start, start);
        let (mut entries, mut unit) = (Vec::<Entry>::new(), None);
        // a habit repeats along a list and is reported once
        let mut told = Told::default();
        let in_groups = self.pairs_in_groups(&pair);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::entry => {
                    let (at, end) = (part.as_span().start(), part.as_span().end());
                    let entry = if in_groups { self.group_as_pair(part) } else { self.entry(part, &mut told) };
                    // `[soil: 0,3 m]`: a pair, then a bare number directly behind its comma.
                    if let Some(previous) = entries.last_mut()
                        && previous.key.is_some()
                        && entry.key.is_none()
                        && self.decimal_comma(at).is_some()
                    {
                        previous.value.kind = ValueKind::Error;
                        self.report_decimal_comma(at, end);
                        continue;
                    }
                    entries.push(entry);
                }
                Rule::close_bracket => span = span.to(self.span_of(&part)),
                Rule::unit => match self.unit(part) {
                    Ok(text) => {
                        span = span.to(text.span);
                        unit = Some(text);
                    }
                    Err(beyond) => return Value { kind: ValueKind::Error, span: span.to(beyond) },
                },
                _ => {}
            }
        }
        Value { kind: ValueKind::List { entries, unit }, span }
    }

    pub fn entry(&mut self, pair: Pair<'p, Rule>, told: &mut Told) -> Entry {
        let start = pair.as_span().start();
        let parts = pair.into_inner();
        let (mut values, mut sign, mut bad) = (Vec::new(), None, None);
        let mut texts = Vec::new();
        for part in parts {
            match part.as_rule() {
                Rule::equals | Rule::colon => sign = Some(part),
                Rule::missing => {
                    let at = sign.as_ref().map_or(start, |s| s.as_span().end());
                    let (shown, found) = (self.text(at - 1, at), self.found(at));
                    let message = format!("expected a value after `{shown}`, found {found}");
                    self.report(Diagnostic::new(Code::E0101, message).label(self.span(at - 1, at), ""));
                    values.push(Value { kind: ValueKind::Error, span: self.span(at, at) });
                    sign = None;
                }
                Rule::junk | Rule::bad_entry => {
                    let at = part.as_span();
                    let read = values.last().is_some_and(|value| matches!(value.kind, ValueKind::Path(_)));
                    let reported = values.last().is_some_and(|value| value.kind == ValueKind::Error);
                    // `[open 42 m, stiff 24 m]`
                    let alike = read && at.as_str().starts_with(|c: char| c.is_ascii_digit());
                    if !(reported || alike && told.colon) {
                        self.explain(Rule::exact_entry, start, at.start(), at.end());
                    }
                    told.colon |= alike;
                    bad = Some(self.span(at.start(), at.end()));
                }
                _ => {
                    texts.push(part.as_str().trim());
                    values.push(self.value(part));
                }
            }
        }
        if let (Some(sign), [key, value], None) = (&sign, texts.as_slice(), bad)
            && sign.as_rule() == Rule::equals
            && !std::mem::replace(&mut told.equals, true)
        {
            let mistake =
                Diagnostic::new(Code::E0105, "a pair in a list has `:`, not `=`").label(self.span_of(sign), "");
            let fix = Fix::replace(self.span_of(sign), ":");
            self.report(mistake.help(format!("write `{key}: {value}`")).fix(fix));
        }
        let mut values = values.into_iter();
        let (first, second) = (values.next(), values.next());
        let (key, value) = match second {
            Some(value) => (first, Some(value)),
            None => (None, first),
        };
        let value = match (value, bad) {
            (Some(value), None) => value,
            (Some(value), Some(bad)) => Value { kind: ValueKind::Error, span: value.span.to(bad) },
            (None, bad) => Value { kind: ValueKind::Error, span: bad.unwrap_or(self.span(start, start)) },
        };
        Entry { key, value }
    }

    fn call(&mut self, pair: Pair<'p, Rule>) -> Value {
        let span = self.span_of(&pair);
        let mut parts = pair.into_inner();
        let Some(word) = parts.next() else { return Value { kind: ValueKind::Error, span } };
        let word = self.name(word);
        let mut told = Told::default();
        let arguments = parts.map(|p| self.argument(p, &mut told)).collect();
        Value { kind: ValueKind::Call { word, arguments }, span }
    }

    fn argument(&mut self, pair: Pair<'p, Rule>, told: &mut Told) -> Argument {
        let start = pair.as_span().start();
        let mut parts = pair.into_inner();
        let named = parts.peek().is_some_and(|p| p.as_rule() == Rule::name);
        let name = if named { parts.next().map(|p| self.name(p)) } else { None };
        let sign = parts.peek();
        if let Some(bad) = sign.as_ref().filter(|p| p.as_rule() == Rule::bad_entry) {
            let at = bad.as_span();
            self.explain(Rule::exact_argument, start, at.start(), at.end());
            return Argument { name, value: Value { kind: ValueKind::Error, span: self.span(at.start(), at.end()) } };
        }
        let text = parts.clone().find(|p| p.as_rule() == Rule::value).map_or("", |p| p.as_str().trim());
        let (value, sound) =
            self.given(&mut parts).unwrap_or((Value { kind: ValueKind::Error, span: self.span(start, start) }, true));
        if let (Some(name), Some(sign)) = (&name, sign)
            && sign.as_rule() == Rule::colon
            && sound
            && !std::mem::replace(&mut told.colon, true)
        {
            let mistake = Diagnostic::new(Code::E0105, "an argument is given with `=`").label(self.span_of(&sign), "");
            let fix = Fix::replace(self.span_of(&sign), " =");
            self.report(mistake.help(format!("write `{} = {text}`", name.text)).fix(fix));
        }
        Argument { name, value }
    }

    /// Parentheses hold one value.
    fn group(&mut self, pair: Pair<'p, Rule>) -> Value {
        let span = self.span_of(&pair);
        let (start, end) = (pair.as_span().start(), pair.as_span().end());
        let second = pair.clone().into_inner().nth(1).map(|p| p.as_span().start());
        if let Some(fields) = self.group_of_fields(&pair) {
            return fields;
        }
        let mut told = Told::default();
        let mut entries: Vec<Entry> = pair.into_inner().map(|p| self.entry(p, &mut told)).collect();
        if entries.len() == 1 && entries[0].key.is_none() {
            return Value { span, ..entries.remove(0).value };
        }
        if self.prepared.is_poisoned(start, end) {
            return Value { kind: ValueKind::Error, span };
        }
        if let Some(at) = second
            && self.decimal_comma(at).is_some()
        {
            self.report_decimal_comma(at, end - 1);
            return Value { kind: ValueKind::Error, span };
        }
        let found = match entries.len() {
            0 => "nothing".to_owned(),
            1 => "a pair".to_owned(),
            n => format!("{n}"),
        };
        let mistake = Diagnostic::new(Code::E0101, format!("expected one value in parentheses, found {found}"));
        let help = match entries.len() {
            0 => "write a value between them, or remove them",
            _ => "put lists in `[ ]`",
        };
        self.report(mistake.label(span, "").help(help));
        Value { kind: ValueKind::Error, span }
    }
}

fn around(values: &[Value]) -> Option<Span> {
    Some(values.first()?.span.to(values.last()?.span))
}

fn binary(left: Value, operator: BinaryOp, right: Value) -> Value {
    let span = left.span.to(right.span);
    Value { kind: ValueKind::Binary(Box::new(left), operator, Box::new(right)), span }
}
