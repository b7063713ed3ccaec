//! Comparisons of responses: `17.6 kN m < max(rail_moment) < 17.7 kN m`.

use super::Checker;
use super::arithmetic::{Raw, shape};
use super::modules::ScopeId;
use super::value::{Number, Val};
use crate::diag::{Code, Diagnostic, Span, nearest::nearest, or_list};
use crate::scenario::response::{Expectation, Expression, Measure, Place, Reduction, Response};
use crate::syntax::tree::{Argument, BinaryOp, Item, Name, Path, Value, ValueKind};
use crate::units::{Dimension, parse_unit};

/// An expression with its dimension.
pub(super) type Typed = (Expression, Dimension);

/// What a value in a comparison may be of, with its factor to the value of one rail or seat.
const BASES: [(&str, f64); 7] = [
    ("seat", 1.0),
    ("sleeper", 0.5),
    ("rail", 1.0),
    ("track", 0.5),
    ("wheel", 1.0),
    ("wheelset", 0.5),
    ("bogie", 0.25),
];

/// Operands of one comparison, those of its lets counted wherever they are used.
const MOST_OPERANDS: usize = 10_000;

const REDUCTIONS: [(&str, Reduction); 4] = [
    ("max", Reduction::Max),
    ("min", Reduction::Min),
    ("mean", Reduction::Mean),
    ("place_of_max", Reduction::PlaceOfMax),
];

impl Checker<'_> {
    pub fn comparison(&mut self, value: &Value, scope: ScopeId) -> Option<Expectation> {
        let ValueKind::Compare { operands, operators } = &value.kind else {
            self.report(
                Diagnostic::new(Code::E0406, format!("expected a comparison, found {}", shape(&value.kind)))
                    .at(value.span, "compares nothing")
                    .help("write something like `max(settlement) < 3 mm`"),
            );
            return None;
        };
        self.operands = 0;
        let typed: Vec<Option<Typed>> = operands.iter().map(|o| self.expression(o, scope)).collect();
        let typed: Vec<Typed> = typed.into_iter().collect::<Option<_>>()?;
        let first = typed[0].1;
        if let Some(i) = typed.iter().position(|(_, d)| *d != first) {
            self.report(
                Diagnostic::new(Code::E0305, "a comparison needs values of the same dimension")
                    .at(operands[i].span, typed[i].1.describe())
                    .at(operands[0].span, first.describe()),
            );
            return None;
        }
        let unit = operands.iter().find_map(unit_of).unwrap_or_else(|| first.usual_unit());
        let size = parse_unit(&unit).map_or(1.0, |u| u.factor);
        Some(Expectation {
            text: self.loader.sources.text(value.span).to_string(),
            span: value.span,
            operands: typed.into_iter().map(|(e, _)| e).collect(),
            operators: operators.clone(),
            unit: (unit, size),
        })
    }

    pub(super) fn expression(&mut self, value: &Value, scope: ScopeId) -> Option<Typed> {
        self.operands += 1;
        if self.operands > MOST_OPERANDS {
            if self.operands == MOST_OPERANDS + 1 {
                self.report(
                    Diagnostic::new(Code::E0103, format!("a comparison of more than {MOST_OPERANDS} operands"))
                        .at(value.span, "given up here"),
                );
            }
            return None;
        }
        self.deeper(1, value.span, |c| c.expression_of(value, scope))
    }

    fn expression_of(&mut self, value: &Value, scope: ScopeId) -> Option<Typed> {
        match &value.kind {
            ValueKind::Call { word, arguments } if REDUCTIONS.iter().any(|(n, _)| *n == word.text) => {
                self.measure(word, arguments, scope)
            }
            ValueKind::Binary(left, op, right) if *op != BinaryOp::Power => {
                let (a, b) = (self.expression(left, scope), self.expression(right, scope));
                self.combine(a?, *op, b?, left.span, right.span)
            }
            ValueKind::Negate(inner) => {
                let (e, d) = self.expression(inner, scope)?;
                Some((Expression::Negate(Box::new(e)), d))
            }
            ValueKind::Path(path) => self.expression_path(path, value, scope),
            _ => {
                let raw = self.raw(value, scope)?;
                let value = self.of_rail(&raw)?;
                Some((Expression::Number(value), raw.dimension))
            }
        }
    }

    fn expression_path(&mut self, path: &Path, value: &Value, scope: ScopeId) -> Option<Typed> {
        if let [name] = path.names.as_slice()
            && let Some(response) = Response::of_name(&name.text)
        {
            if response.place() == Place::Scene {
                let measure = Measure { reduction: Reduction::Itself, response, over: None, after: None };
                return Some((Expression::Measure(measure), Dimension::of(response.unit())));
            }
            self.report(
                Diagnostic::new(Code::E0406, format!("`{}` has a value at many places", name.text))
                    .at(name.span, "not one number")
                    .help(format!("write `max({})`, or `min`, `mean` or `place_of_max` of it", name.text)),
            );
            return None;
        }
        let names: Vec<&str> = Response::ALL.iter().map(|r| r.name()).collect();
        let target = self.resolve(path, scope, &names)?;
        if target.is_let {
            let tree = self.scopes[target.id.scope].tree.clone();
            let Item::Let(binding) = &tree.items[target.id.item] else { return None };
            return self.within(target.id, path.span, |c| c.expression(&binding.value, target.id.scope));
        }
        let raw = self.raw(value, scope)?;
        let value = self.of_rail(&raw)?;
        Some((Expression::Number(value), raw.dimension))
    }

    fn combine(&mut self, a: Typed, op: BinaryOp, b: Typed, left: Span, right: Span) -> Option<Typed> {
        let dimension = match op {
            BinaryOp::Multiply => a.1 * b.1,
            BinaryOp::Divide => a.1 / b.1,
            _ if a.1 == b.1 => a.1,
            _ => {
                self.report(
                    Diagnostic::new(Code::E0305, format!("`{}` needs two values of the same dimension", op.symbol()))
                        .at(left, a.1.describe())
                        .at(right, b.1.describe()),
                );
                return None;
            }
        };
        Some((Expression::Binary(Box::new(a.0), op, Box::new(b.0)), dimension))
    }

    /// `max(contact_force, over = -20 .. -1 sleepers, after = 100 axles)`
    fn measure(&mut self, word: &Name, arguments: &[Argument], scope: ScopeId) -> Option<Typed> {
        let reduction = REDUCTIONS.iter().find(|(n, _)| *n == word.text)?.1;
        let response = match arguments.first().map(|a| (&a.name, &a.value.kind)) {
            Some((None, ValueKind::Path(path))) if path.names.len() == 1 => self.response(&path.names[0])?,
            _ => {
                self.report(
                    Diagnostic::new(Code::E0406, format!("`{}` needs a response", word.text))
                        .at(word.span, "of what?")
                        .help(format!("write something like `{}(settlement)`", word.text)),
                );
                return None;
            }
        };
        let mut measure = Measure { reduction, response, over: None, after: None };
        let named = |wanted: &str| {
            arguments.iter().skip(1).find(|a| a.name.as_ref().is_some_and(|n| n.text == wanted)).map(|a| &a.value)
        };
        let transition = match named("from").map(|v| (&v.kind, v.span)) {
            Some((ValueKind::Path(path), span)) if path.names.len() == 1 => Some((path.text(), span)),
            Some((other, span)) => {
                self.report(
                    Diagnostic::new(Code::E0406, format!("expected the name of a transition, found {}", shape(other)))
                        .at(span, "not a transition"),
                );
                return None;
            }
            None => None,
        };
        for argument in &arguments[1..] {
            let name = argument.name.as_ref().map_or("", |n| n.text.as_str());
            match (name, &argument.value.kind) {
                ("over", ValueKind::Range(from, to)) => {
                    let Val::Range(a, b) = self.span(from, to, scope)? else { return None };
                    if self.seat_places.is_none() {
                        continue; // the track is not understood, and the scene not made
                    }
                    let counted = transition.as_ref().map(|(name, span)| (name.as_str(), *span));
                    measure.over = Some(self.chainages(a, b, counted, argument.value.span)?);
                }
                ("from", _) => {}
                ("after", _) => measure.after = Some(self.count(&argument.value, scope)?),
                _ => {
                    let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
                    let near = nearest(name, ["over", "from", "after"]).map(|n| format!("did you mean `{n}`?"));
                    self.report(
                        Diagnostic::new(Code::E0402, format!("`{}` has no such argument", word.text))
                            .at(place, "unknown argument")
                            .help(near.unwrap_or_else(|| {
                                "it takes `over = span`, `from = transition` and `after = axles`".into()
                            })),
                    );
                    return None;
                }
            }
        }
        let unit = if reduction == Reduction::PlaceOfMax { "m" } else { response.unit() };
        Some((Expression::Measure(measure), Dimension::of(unit)))
    }

    /// Values in a comparison are of one rail or one seat, as responses are.
    fn of_rail(&mut self, raw: &Raw) -> Option<f64> {
        let Some((name, span)) = &raw.basis else { return Some(raw.value) };
        match BASES.iter().find(|(basis, _)| basis == name) {
            Some((_, factor)) => Some(raw.value * factor),
            None => {
                let names: Vec<String> = BASES.iter().map(|(basis, _)| format!("`per {basis}`")).collect();
                self.report(
                    Diagnostic::new(Code::E0304, format!("expected {}, found `per {name}`", or_list(&names)))
                        .at(*span, "not of this"),
                );
                None
            }
        }
    }

    /// An axle count; in a scene of loads a number of cycles.
    fn count(&mut self, value: &Value, scope: ScopeId) -> Option<u64> {
        let raw = self.raw(value, scope)?;
        if raw.dimension == Dimension::CYCLES && !self.asked.traffic {
            return self.whole(raw.value, "cycles", raw.span);
        }
        if ![Dimension::AXLES, Dimension::MASS, Dimension::CYCLES].contains(&raw.dimension) {
            let text = format!("expected a number of axles or the mass carried, found {}", raw.dimension.describe());
            self.report(Diagnostic::new(Code::E0302, text).at(raw.span, "not counted"));
            return None;
        }
        let count = Number { value: raw.value, dimension: raw.dimension, basis: None, factor: 1.0 };
        self.axle_count(count, raw.span, false)
    }

    /// The chainages of a span whose ends may be sleepers; geometry is known before any expectation is read.
    fn chainages(&mut self, a: Number, b: Number, from: Option<(&str, Span)>, span: Span) -> Option<(f64, f64)> {
        let seats = self.seat_places.clone();
        super::geometry::span(self, &seats, a, b, from, span)
    }
}

/// The first unit written in an operand.
pub(super) fn unit_of(value: &Value) -> Option<String> {
    match &value.kind {
        ValueKind::Number { unit: Some(unit), .. } => Some(unit.text.clone()),
        ValueKind::Negate(inner) | ValueKind::Per(inner, _) => unit_of(inner),
        _ => None,
    }
}
