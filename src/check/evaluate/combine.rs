//! Arithmetic with profiles: `2 * k` with a profile `k`, `k / 2`, `k + 1 mm`, and sums of profiles on the same places.
//!
//! It is done on the syntax tree, before values are evaluated: arithmetic on a profile is moved to every value in it.
//! Each value is then evaluated and checked against the field like any other value.

use super::evaluator::Evaluator;
use super::written::{bare, is_profile, with_unit};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::{Code, Diagnostic, Span};
use crate::syntax::tree::{Argument, BinaryOp, Entry, Item, Path, UnitText, Value, ValueKind};

/// Largest number of parts, and of nested parts, that are searched for a profile. A larger value is taken as a number,
/// and arithmetic refuses it.
const MOST_PARTS: usize = 10_000;
const DEEPEST: usize = 400;

/// Parts that have been searched.
#[derive(Default)]
struct Seen {
    parts: usize,
    depth: usize,
}

/// An operation on a value of a profile.
type Act<'a> = &'a dyn Fn(Value) -> Value;

impl Evaluator<'_> {
    /// Whether a value varies along the track: a profile, the name of a profile, or arithmetic with a profile.
    pub fn varies(&self, value: &Value, scope: ScopeId) -> bool {
        self.varies_within(value, scope, &mut Seen::default())
    }

    fn varies_within(&self, value: &Value, scope: ScopeId, seen: &mut Seen) -> bool {
        seen.parts += 1;
        if seen.parts > MOST_PARTS || seen.depth > DEEPEST {
            return false;
        }
        seen.depth += 1;
        let varies = match &bare(value).0.kind {
            ValueKind::Binary(left, op, right) if *op != BinaryOp::Power => {
                self.varies_within(left, scope, seen) || self.varies_within(right, scope, seen)
            }
            ValueKind::Negate(inner) => self.varies_within(inner, scope, seen),
            // a circle of names is found when the names are evaluated
            ValueKind::Path(path) => {
                self.bound(path, scope).is_some_and(|(_, binding)| self.varies_within(binding, scope, seen))
            }
            _ => is_profile(value),
        };
        seen.depth -= 1;
        varies
    }

    /// The value of a `let` of this file.
    fn bound(&self, path: &Path, scope: ScopeId) -> Option<(ItemId, &Value)> {
        let [name] = path.names.as_slice() else { return None };
        let item = *self.scopes[scope].names.get(&name.text)?;
        match &self.scopes[scope].tree.items[item] {
            Item::Let(binding) => Some((ItemId { scope, item }, &binding.value)),
            _ => None,
        }
    }

    /// A value that varies, with its arithmetic moved inside: only a word or a list of places remains.
    pub(super) fn worked(&mut self, value: &Value, scope: ScopeId) -> Option<Value> {
        self.deeper(1, value.span, |c| c.worked_out(value, scope))
    }

    fn worked_out(&mut self, value: &Value, scope: ScopeId) -> Option<Value> {
        let span = value.span;
        match &value.kind {
            ValueKind::Per(inner, name) => {
                let inner = self.worked(inner, scope)?;
                self.each(inner, &|of| boxed(ValueKind::Per(Box::new(of), name.clone()), span))
            }
            ValueKind::Negate(inner) => {
                let inner = self.worked(inner, scope)?;
                self.each(inner, &|of| boxed(ValueKind::Negate(Box::new(of)), span))
            }
            ValueKind::Binary(left, op, right) => self.combined(left, *op, right, span, scope),
            ValueKind::Path(path) => {
                let (id, binding) = self.bound(path, scope).map(|(id, binding)| (id, binding.clone()))?;
                self.within(id, path.span, |c| c.worked(&binding, scope))
            }
            _ => Some(value.clone()),
        }
    }

    fn combined(&mut self, left: &Value, op: BinaryOp, right: &Value, span: Span, scope: ScopeId) -> Option<Value> {
        let binary = |a: Value, b: Value| boxed(ValueKind::Binary(Box::new(a), op, Box::new(b)), span);
        match (self.varies(left, scope), self.varies(right, scope)) {
            (true, true) => {
                let (a, b) = (self.worked(left, scope), self.worked(right, scope));
                let (a, b) = (a?, b?);
                match op {
                    BinaryOp::Add | BinaryOp::Subtract => self.added(a, op, b, span),
                    _ => self.multiplied(a, op, b, span),
                }
            }
            (true, false) => {
                let profile = self.worked(left, scope)?;
                self.scales_only(&profile, op, span)?;
                self.each(profile, &|of| binary(of, right.clone()))
            }
            (false, true) if op == BinaryOp::Divide => {
                self.not_combined(span, "a number is divided by a profile", [left.span, right.span]);
                None
            }
            (false, true) => {
                let profile = self.worked(right, scope)?;
                self.scales_only(&profile, op, span)?;
                self.each(profile, &|of| binary(left.clone(), of))
            }
            (false, false) => Some(binary(left.clone(), right.clone())),
        }
    }

    /// Refuses sums with a random profile: a shifted mean would change the meaning of `cov`.
    fn scales_only(&mut self, profile: &Value, op: BinaryOp, span: Span) -> Option<()> {
        let scatters = matches!(&profile.kind, ValueKind::Call { word, .. } if word.text == "random");
        if scatters && matches!(op, BinaryOp::Add | BinaryOp::Subtract) {
            self.not_combined(span, "a value is added to a random profile", [profile.span, span]);
            return None;
        }
        Some(())
    }

    /// Applies an operation to each value of a profile. A mistake of the arithmetic points at the profile, so that it
    /// is reported once.
    fn each(&mut self, profile: Value, act: Act<'_>) -> Option<Value> {
        let span = profile.span;
        let act: Act<'_> = &|of| act(Value { span, ..of });
        let kind = match profile.kind {
            ValueKind::Call { word, .. } if word.text == "file" => {
                self.not_combined(span, "a data file takes part in arithmetic", [word.span, span]);
                return None;
            }
            ValueKind::Call { word, arguments } => {
                let scatters = word.text == "random";
                let acted = |(i, argument): (usize, Argument)| {
                    let deviation = scatters && argument.name.as_ref().is_some_and(|name| name.text == "sd");
                    let value = if i == 0 && argument.name.is_none() || deviation {
                        of_ends(argument.value, act)
                    } else {
                        argument.value
                    };
                    Argument { value, ..argument }
                };
                ValueKind::Call { word, arguments: arguments.into_iter().enumerate().map(acted).collect() }
            }
            ValueKind::List { entries, unit } => {
                let mut acted = Vec::new();
                for entry in entries {
                    let value = with_unit(&entry.value, unit.as_ref());
                    let value = if is_profile(&value) { self.each(value, act)? } else { of_ends(value, act) };
                    acted.push(Entry { value, ..entry });
                }
                ValueKind::List { entries: acted, unit: None }
            }
            other => other,
        };
        Some(Value { kind, span })
    }

    /// The sum of two profiles of the same form on the same places.
    fn added(&mut self, a: Value, op: BinaryOp, b: Value, span: Span) -> Option<Value> {
        let spans = [a.span, b.span];
        let sum = |a: Value, b: Value| boxed(ValueKind::Binary(Box::new(a), op, Box::new(b)), span);
        let kind = match (a.kind, b.kind) {
            (ValueKind::Call { word, arguments }, ValueKind::Call { word: other, arguments: others })
                if word.text == other.text && matches!(word.text.as_str(), "ramp" | "smooth") =>
            {
                let same = arguments.len() == others.len()
                    && arguments.iter().zip(&others).skip(1).all(|(a, b)| self.same_text(&a.value, &b.value));
                if !same {
                    self.not_combined(span, "the two run over different spans", spans);
                    return None;
                }
                ValueKind::Call { arguments: sum_of_ends(arguments, others, &sum), word }
            }
            (ValueKind::List { entries, unit }, ValueKind::List { entries: others, unit: other }) => {
                let keys = |a: &Entry, b: &Entry| match (&a.key, &b.key) {
                    (Some(a), Some(b)) => self.same_text(a, b),
                    _ => false,
                };
                if entries.len() != others.len() || !entries.iter().zip(&others).all(|(a, b)| keys(a, b)) {
                    self.not_combined(span, "the two have different places", spans);
                    return None;
                }
                ValueKind::List {
                    entries: self.sum_of_entries((entries, unit), (others, other), op, span)?,
                    unit: None,
                }
            }
            _ => {
                self.not_combined(span, "the two have different forms", spans);
                return None;
            }
        };
        Some(Value { kind, span })
    }

    /// The product or quotient of two lists of the same spans, exact since one of the two is constant in each piece.
    fn multiplied(&mut self, a: Value, op: BinaryOp, b: Value, span: Span) -> Option<Value> {
        let spans = [a.span, b.span];
        let (ValueKind::List { entries, unit }, ValueKind::List { entries: others, unit: other }) = (a.kind, b.kind)
        else {
            self.not_combined(span, "both vary at the same place in a product or quotient", spans);
            return None;
        };
        let by_spans = |e: &Entry| matches!(e.key.as_ref().map(|k| &k.kind), Some(ValueKind::Range(..)));
        let same = |(a, b): (&Entry, &Entry)| matches!((&a.key, &b.key), (Some(a), Some(b)) if self.same_text(a, b));
        if entries.len() != others.len() || !entries.iter().zip(&others).all(same) {
            self.not_combined(span, "the two have different places", spans);
            return None;
        }
        if !entries.iter().any(by_spans) {
            self.not_combined(span, "both vary between places in a product or quotient", spans);
            return None;
        }
        let entries = self.sum_of_entries((entries, unit), (others, other), op, span)?;
        Some(Value { kind: ValueKind::List { entries, unit: None }, span })
    }

    /// Two lists entry by entry, added or multiplied.
    fn sum_of_entries(
        &mut self,
        (entries, unit): (Vec<Entry>, Option<UnitText>),
        (others, other): (Vec<Entry>, Option<UnitText>),
        op: BinaryOp,
        span: Span,
    ) -> Option<Vec<Entry>> {
        let mut sums = Vec::new();
        for (a, b) in entries.into_iter().zip(others) {
            let (left, right) = (with_unit(&a.value, unit.as_ref()), with_unit(&b.value, other.as_ref()));
            let value = match (is_profile(&left), is_profile(&right)) {
                (true, true) if matches!(op, BinaryOp::Add | BinaryOp::Subtract) => {
                    self.added(left, op, right, span)?
                }
                (true, true) => self.multiplied(left, op, right, span)?,
                (false, true) if op == BinaryOp::Divide => {
                    self.not_combined(span, "a number is divided by a profile", [left.span, right.span]);
                    return None;
                }
                (true, false) => self.each(left, &|of| binary(of, op, right.clone(), span))?,
                (false, true) => self.each(right, &|of| binary(left.clone(), op, of, span))?,
                (false, false) => binary(left, op, right, span),
            };
            sums.push(Entry { key: a.key, value });
        }
        Some(sums)
    }

    /// Whether two values are written in the same way.
    fn same_text(&self, a: &Value, b: &Value) -> bool {
        let words = |value: &Value| self.files.sources.text(value.span).split_whitespace().collect::<String>();
        words(a) == words(b)
    }

    fn not_combined(&mut self, span: Span, why: &str, parts: [Span; 2]) {
        let mut mistake = Diagnostic::new(Code::E0428, format!("these profiles do not combine: {why}"))
            .label(span, "cannot be calculated");
        for part in parts.into_iter().filter(|part| *part != span) {
            mistake = mistake.label(part, "this one");
        }
        self.findings.report(mistake.help(
            "multiply or divide a profile by a number, or add a number; add two profiles if both are `ramp`, both \
             `smooth`, or lists of the same places; multiply two lists of the same spans if one of the two is a \
             number on each span",
        ));
    }
}

fn boxed(kind: ValueKind, span: Span) -> Value {
    Value { kind, span }
}

fn binary(a: Value, op: BinaryOp, b: Value, span: Span) -> Value {
    boxed(ValueKind::Binary(Box::new(a), op, Box::new(b)), span)
}

/// Acts on a value, or on both ends of a range; a bare first end takes the unit of the second before.
fn of_ends(value: Value, act: Act<'_>) -> Value {
    match value.kind {
        ValueKind::Range(from, to) => {
            let from = with_unit(&from, unit_of(&to));
            boxed(ValueKind::Range(Box::new(act(from)), Box::new(act(*to))), value.span)
        }
        ValueKind::Per(inner, name) => {
            let per = |of: Value| {
                let span = of.span;
                act(boxed(ValueKind::Per(Box::new(of), name.clone()), span))
            };
            of_ends(*inner, &per)
        }
        kind => act(Value { kind, span: value.span }),
    }
}

/// The arguments of two ramps over the same span, their ends added.
fn sum_of_ends(mut a: Vec<Argument>, mut b: Vec<Argument>, sum: &dyn Fn(Value, Value) -> Value) -> Vec<Argument> {
    if let (Some(first), Some(second)) = (a.first_mut(), b.first_mut()) {
        let ends = |value: &Value| match of_ends(value.clone(), &|of| of).kind {
            ValueKind::Range(from, to) => Some((*from, *to)),
            _ => None,
        };
        if let (Some((from, to)), Some((other_from, other_to))) = (ends(&first.value), ends(&second.value)) {
            let kind = ValueKind::Range(Box::new(sum(from, other_from)), Box::new(sum(to, other_to)));
            first.value = boxed(kind, first.value.span);
        }
    }
    a
}

/// The unit of a literal, also behind a sign.
fn unit_of(value: &Value) -> Option<&UnitText> {
    match &value.kind {
        ValueKind::Number { unit, .. } => unit.as_ref(),
        ValueKind::Negate(inner) => unit_of(inner),
        _ => None,
    }
}
