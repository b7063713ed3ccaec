//! Numbers: literals with units, arithmetic with checked dimensions, and the paths that lead to numbers.

use super::evaluator::Evaluator;
use super::number::Raw;
use super::unit_mistakes::unit_mistake;
use super::value::Val;
use super::written::looks_like;
use crate::check::text::scope::ScopeId;
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::syntax::tree::{Argument, BinaryOp, Name, Path, UnitText, Value, ValueKind};
use crate::units::{Dimension, parse_unit};

impl Evaluator<'_> {
    /// Evaluates arithmetic; `None` if a diagnostic has been given.
    pub fn raw(&mut self, value: &Value, scope: ScopeId) -> Option<Raw> {
        self.deeper(1, value.span, |c| c.raw_of(value, scope))
    }

    fn raw_of(&mut self, value: &Value, scope: ScopeId) -> Option<Raw> {
        let span = value.span;
        match &value.kind {
            ValueKind::Number { value, unit } => self.literal(*value, unit.as_ref(), span),
            ValueKind::Negate(inner) => {
                let inner = self.raw(inner, scope)?;
                Some(Raw { value: -inner.value, span, ..inner })
            }
            ValueKind::Per(inner, basis) => {
                let raw = self.raw(inner, scope)?;
                Some(Raw { basis: Some((basis.text.clone(), basis.span)), ..raw })
            }
            ValueKind::Binary(left, op, right) => self.binary(left, *op, right, span, scope),
            ValueKind::Path(path) => self.raw_path(path, scope),
            ValueKind::Call { word, arguments } => self.function(word, arguments, span, scope),
            ValueKind::Error => None,
            ValueKind::Hole => {
                self.findings
                    .report(Diagnostic::new(Code::E0410, "`?` cannot take part in arithmetic").label(span, "a hole"));
                None
            }
            other => {
                let unquoted = match other {
                    ValueKind::Text(text) => Some(Help::write(text).and(", without quotes")),
                    _ => None,
                };
                self.findings.report(
                    Diagnostic::new(Code::E0406, format!("expected a number, found {}", looks_like(other)))
                        .label(span, "not a number")
                        .maybe_advise(span, unquoted),
                );
                None
            }
        }
    }

    /// Reads the units of an unused value.
    pub fn units_in(&mut self, value: &Value) {
        match &value.kind {
            ValueKind::Number { value: number, unit } => {
                self.literal(*number, unit.as_ref(), value.span);
            }
            ValueKind::Negate(inner) | ValueKind::Per(inner, _) => self.units_in(inner),
            ValueKind::Binary(left, _, right) | ValueKind::Range(left, right) => {
                self.units_in(left);
                self.units_in(right);
            }
            ValueKind::List { entries, .. } => entries.iter().for_each(|e| self.units_in(&e.value)),
            _ => {}
        }
    }

    fn literal(&mut self, value: f64, unit: Option<&UnitText>, span: Span) -> Option<Raw> {
        let Some(unit) = unit else {
            return Some(Raw { value, dimension: Dimension::NONE, basis: None, span, bare: true });
        };
        match parse_unit(&unit.text) {
            Ok(u) => Some(Raw { value: value * u.factor, dimension: u.dimension, basis: None, span, bare: false }),
            Err(error) => {
                let help = self.of_trains(unit);
                let whole = self.files.sources.text(span).to_owned();
                let mut mistake = unit_mistake(unit, &error, &whole);
                if let Some((place, help)) = help {
                    mistake.fixes.clear();
                    mistake = mistake.advise(place, help);
                }
                self.findings.report(mistake);
                None
            }
        }
    }

    fn raw_path(&mut self, path: &Path, scope: ScopeId) -> Option<Raw> {
        let target = self.resolve(path, scope, &[])?;
        if target.is_let {
            if let Some(known) = self.numbers.get(&target.id) {
                self.used.insert(target.id);
                return known.clone();
            }
            let tree = self.scopes[target.id.scope].tree.clone();
            let crate::syntax::tree::Item::Let(binding) = &tree.items[target.id.item] else { return None };
            let raw = self.within(target.id, path.span, |c| c.raw(&binding.value, target.id.scope));
            self.numbers.insert(target.id, raw.clone());
            return raw;
        }
        let slot = self.slot_at(&target, path)?;
        match slot.value {
            Val::Number(n) => Some(Raw {
                value: n.value,
                dimension: n.dimension,
                basis: n.basis.map(|b| (b.to_string(), path.span)),
                span: path.span,
                bare: false,
            }),
            Val::Error | Val::Hole => None,
            _ => {
                self.findings.report(
                    Diagnostic::new(Code::E0406, format!("expected a number, but `{}` is not a number", path.text()))
                        .label(path.span, "not a number"),
                );
                None
            }
        }
    }

    fn binary(&mut self, left: &Value, op: BinaryOp, right: &Value, span: Span, scope: ScopeId) -> Option<Raw> {
        if let Some(unit) = dashed_unit(self.files.sources.text(span)).filter(|_| op == BinaryOp::Subtract) {
            self.findings.report(
                Diagnostic::new(Code::E0305, "`-` subtracts values; it does not join the factors of a unit")
                    .label(span, "")
                    .advise(span, Help::write(unit).after("separate the factors of a unit by a blank: ")),
            );
            return None;
        }
        let (a, b) = (self.raw(left, scope), self.raw(right, scope));
        let (a, b) = (a?, b?);
        let basis = |a: &Raw, b: &Raw| match (&a.basis, &b.basis) {
            (Some(x), None) | (None, Some(x)) => Some(x.clone()),
            (Some(x), Some(y)) if x.0 == y.0 => Some(x.clone()),
            _ => None,
        };
        let raw = |value: f64, dimension: Dimension, basis| Raw { value, dimension, basis, span, bare: false };
        let result = match op {
            BinaryOp::Add | BinaryOp::Subtract => {
                let bases_differ = matches!((&a.basis, &b.basis), (Some(x), Some(y)) if x.0 != y.0);
                if a.dimension != b.dimension || bases_differ {
                    let same = if a.dimension == b.dimension { "basis" } else { "dimension" };
                    let help = self.instead_of_sum(left, op, right, [a.bare, b.bare]);
                    self.findings.report(
                        Diagnostic::new(Code::E0305, format!("`{}` needs two values of the same {same}", op.symbol()))
                            .label(left.span, a.describe())
                            .label(right.span, b.describe())
                            .maybe_help(help),
                    );
                    return None;
                }
                let value = if op == BinaryOp::Add { a.value + b.value } else { a.value - b.value };
                let bare = a.bare && b.bare;
                Raw { bare, ..raw(value, a.dimension, basis(&a, &b)) }
            }
            BinaryOp::Multiply => raw(a.value * b.value, a.dimension * b.dimension, basis(&a, &b)),
            BinaryOp::Divide => {
                // a ratio of two values with the same basis has no basis
                let both = matches!((&a.basis, &b.basis), (Some(x), Some(y)) if x.0 == y.0);
                let of = if both { None } else { basis(&a, &b) };
                raw(a.value / b.value, a.dimension / b.dimension, of)
            }
            BinaryOp::Power => {
                let hundredths = (b.value * 100.0).round();
                let plain =
                    b.dimension.is_none() && (hundredths - b.value * 100.0).abs() < 1e-9 && b.value.abs() <= 9.0;
                let dimension = if plain { a.dimension.power(hundredths as i32) } else { None };
                let Some(dimension) = dimension else {
                    self.findings.report(
                        Diagnostic::new(Code::E0305, "an exponent is a plain number from -9 to 9")
                            .label(right.span, b.dimension.describe())
                            .advise(span, self.power_of_ten(span)),
                    );
                    return None;
                };
                Raw { bare: a.bare, ..raw(a.value.powf(b.value), dimension, None) }
            }
        };
        self.finite(result, span)
    }

    /// Help for a sum of a value and a number without a unit.
    fn instead_of_sum(&self, left: &Value, op: BinaryOp, right: &Value, bare: [bool; 2]) -> Option<String> {
        let [a, b] = [left.span, right.span].map(|span| self.files.sources.text(span));
        // behind a `let` the two may be anywhere
        let follows = left.span.file == right.span.file && left.span.end <= right.span.start;
        let between = Span { start: left.span.end, end: right.span.start, ..left.span };
        let between = if follows { self.files.sources.text(between) } else { return None };
        let several = matches!(&left.kind, ValueKind::Binary(_, BinaryOp::Add | BinaryOp::Subtract, _));
        match (bare, op) {
            // `kg m-3`
            ([false, true], BinaryOp::Subtract) if between == "-" && a.ends_with(|c: char| c.is_alphabetic()) => {
                Some(format!("a negative power is written `{a}^-{b}`"))
            }
            ([true, false], _) if several => Some("write several values in brackets, separated by commas".to_owned()),
            ([true, false], BinaryOp::Subtract) => Some(format!("a range is written `{a} .. {b}`")),
            ([true, false], _) => Some(format!("give `{a}` its unit too")),
            ([false, true], _) => Some(format!("give `{b}` its unit too")),
            _ => None,
        }
    }

    /// `10^-4 s` in the right form, or help on powers of ten.
    fn power_of_ten(&self, span: Span) -> Help {
        let before = self.files.sources.get(span.file).text[..span.start as usize].trim_end();
        let power = self.files.sources.text(span).strip_prefix("10^").filter(|_| !before.ends_with('*'));
        match power.filter(|p| p.split(' ').next().is_some_and(|n| n.parse::<i32>().is_ok())) {
            Some(power) => Help::write(format!("1e{power}")),
            None => Help::say("write powers of ten in the number: `40e6 N/m`"),
        }
    }

    fn finite(&mut self, raw: Raw, span: Span) -> Option<Raw> {
        if raw.value.is_finite() {
            return Some(raw);
        }
        self.findings.report(
            Diagnostic::new(Code::E0405, "the result is not a finite number")
                .label(span, "divides by zero or overflows"),
        );
        None
    }

    /// `sqrt`, `abs`, `min` and `max` of numbers.
    fn function(&mut self, word: &Name, arguments: &[Argument], span: Span, scope: ScopeId) -> Option<Raw> {
        if !matches!(word.text.as_str(), "sqrt" | "abs" | "min" | "max") {
            let near = crate::diag::nearest::nearest(&word.text, ["sqrt", "abs", "min", "max"]);
            self.findings.report(
                Diagnostic::new(Code::E0408, format!("expected a number, found the word `{}`", word.text))
                    .label(word.span, "not a function of numbers")
                    .help("functions of numbers are `sqrt`, `abs`, `min` and `max`")
                    .maybe_meant(word.span, near),
            );
            return None;
        }
        let values: Vec<Option<Raw>> = arguments.iter().map(|a| self.raw(&a.value, scope)).collect();
        let values: Vec<Raw> = values.into_iter().collect::<Option<_>>()?;
        let one = matches!(word.text.as_str(), "sqrt" | "abs");
        let Some(first) = values.first().filter(|_| !one || values.len() == 1) else {
            let count = if one { "one value" } else { "at least one value" };
            self.findings.report(
                Diagnostic::new(Code::E0406, format!("`{}` takes {count}, found {}", word.text, values.len()))
                    .label(span, "here"),
            );
            return None;
        };
        let basis = values.iter().find_map(|v| v.basis.clone());
        let of = basis.as_ref().map(|(name, _)| name.as_str());
        let unlike = |v: &&Raw| v.dimension != first.dimension || v.basis_name().is_some_and(|name| Some(name) != of);
        if let Some(other) = values.iter().find(unlike) {
            let same = if other.dimension == first.dimension { "basis" } else { "dimension" };
            self.findings.report(
                Diagnostic::new(Code::E0305, format!("`{}` needs values of the same {same}", word.text))
                    .label(other.span, other.describe())
                    .label(first.span, first.describe()),
            );
            return None;
        }
        let numbers = values.iter().map(|v| v.value);
        let (value, dimension) = match word.text.as_str() {
            "sqrt" => (first.value.sqrt(), first.dimension.power(50)?),
            "abs" => (first.value.abs(), first.dimension),
            "min" => (numbers.fold(f64::INFINITY, f64::min), first.dimension),
            _ => (numbers.fold(f64::NEG_INFINITY, f64::max), first.dimension),
        };
        self.finite(Raw { value, dimension, basis, span, bare: values.iter().all(|v| v.bare) }, span)
    }
}

/// `5 kN-s/m` with a blank instead of the dash, if this is a number with a unit.
fn dashed_unit(text: &str) -> Option<String> {
    let letter = |c: Option<char>| c.is_some_and(char::is_alphabetic);
    let dash = text
        .match_indices('-')
        .map(|(at, _)| at)
        .find(|at| letter(text[..*at].chars().next_back()) && letter(text[at + 1..].chars().next()))?;
    let written = format!("{} {}", &text[..dash], &text[dash + 1..]);
    let (number, unit) = written.split_once(' ')?;
    (number.parse::<f64>().is_ok() && parse_unit(unit).is_ok()).then_some(written)
}
