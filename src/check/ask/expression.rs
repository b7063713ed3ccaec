//! Comparisons of responses: `17.6 kN m < max(rail_moment) < 17.7 kN m`.

use super::reader::Reader;
use crate::check::evaluate::number::{Number, Raw};
use crate::check::evaluate::offers;
use crate::check::evaluate::written::looks_like;
use crate::check::parts::traffic::{axle_count, whole};
use crate::check::text::scope::ScopeId;
use crate::diag::{Code, Diagnostic, Help, Span, or_list};
use crate::scenario::Measured;
use crate::scenario::response::{Expectation, Expression, Function, Measure, Place, Reduction, Response};
use crate::syntax::tree::{Argument, BinaryOp, Item, Name, Path, Value, ValueKind};
use crate::units::{Dimension, parse_unit};

/// An expression with its dimension.
pub type Typed = (Expression, Dimension);

/// Bases of a value in a comparison, each with its factor to the value of one rail or seat.
const BASES: [(&str, f64); 7] = [
    ("seat", 1.0),
    ("sleeper", 0.5),
    ("rail", 1.0),
    ("track", 0.5),
    ("wheel", 1.0),
    ("wheelset", 0.5),
    ("bogie", 0.25),
];

/// Operands of one comparison; operands of a `let` are counted at each use.
const MOST_OPERANDS: usize = 10_000;

impl Reader<'_, '_> {
    /// Reads a comparison; `None` if a diagnostic has been given.
    pub fn comparison(&mut self, value: &Value, scope: ScopeId) -> Option<Expectation> {
        let ValueKind::Compare { operands, operators } = &value.kind else {
            self.eval.findings.report(
                Diagnostic::new(Code::E0406, format!("expected a comparison, found {}", looks_like(&value.kind)))
                    .label(value.span, "not a comparison")
                    .help("write something like `max(settlement) < 3 mm`"),
            );
            return None;
        };
        *self.operands = 0;
        let typed: Vec<Option<Typed>> = operands.iter().map(|o| self.expression(o, scope)).collect();
        let typed: Vec<Typed> = typed.into_iter().collect::<Option<_>>()?;
        let first = typed[0].1;
        if let Some(i) = typed.iter().position(|(_, d)| *d != first) {
            let (place, help) = self.comparable(operands, &typed, scope).unzip();
            self.eval.findings.report(
                Diagnostic::new(Code::E0305, "a comparison needs values of the same dimension")
                    .label(operands[i].span, typed[i].1.describe())
                    .label(operands[0].span, first.describe())
                    .maybe_advise(place.unwrap_or(operands[i].span), help),
            );
            return None;
        }
        let unit = operands.iter().find_map(unit_of).unwrap_or_else(|| first.usual_unit());
        let size = parse_unit(&unit).map_or(1.0, |u| u.factor);
        Some(Expectation {
            text: self.eval.files.sources.text(value.span).to_string(),
            span: value.span,
            operands: typed.into_iter().map(|(e, _)| e).collect(),
            operators: operators.clone(),
            unit: (unit, size),
        })
    }

    /// Text to write instead of a plain value, so that it can be compared with the response beside it.
    fn comparable(&mut self, operands: &[Value], typed: &[Typed], scope: ScopeId) -> Option<(Span, Help)> {
        let (response, dimension) = typed.iter().find(|(e, _)| !matches!(e, Expression::Number(_)))?;
        let unit = shown_unit(*dimension, response);
        let other = operands.iter().zip(typed).find(|(_, (_, d))| d != dimension)?.0;
        let bare = if let ValueKind::Per(inner, _) = &other.kind { inner } else { other };
        let raw = self.eval.raw(other, scope)?;
        let help = offers::in_comparison(*dimension, &raw, self.eval.files.sources.text(bare.span), &unit)?;
        Some((other.span, help))
    }

    /// An expression of responses.
    pub fn measured(&mut self, value: &Value, scope: ScopeId) -> Option<Measured> {
        *self.operands = 0;
        let (expression, dimension) = self.expression(value, scope)?;
        let unit = shown_unit(dimension, &expression);
        let size = parse_unit(&unit).map_or(1.0, |u| u.factor);
        let text = one_line(self.eval.files.sources.text(value.span));
        Some(Measured { text, expression, unit: (unit, size) })
    }

    /// Reads an expression with its dimension; `None` if a diagnostic has been given.
    pub(super) fn expression(&mut self, value: &Value, scope: ScopeId) -> Option<Typed> {
        *self.operands += 1;
        if *self.operands > MOST_OPERANDS {
            if *self.operands == MOST_OPERANDS + 1 {
                self.eval.findings.report(
                    Diagnostic::new(Code::E0103, format!("the comparison has more than {MOST_OPERANDS} operands"))
                        .label(value.span, "too many operands"),
                );
            }
            return None;
        }
        let (counting, operands) = (self.counting, &mut *self.operands);
        self.eval.deeper(1, value.span, |eval| Reader { eval, counting, operands }.expression_of(value, scope))
    }

    fn expression_of(&mut self, value: &Value, scope: ScopeId) -> Option<Typed> {
        match &value.kind {
            ValueKind::Call { word, arguments } if self.reduces(word, arguments, scope) => {
                self.measure(word, arguments, scope)
            }
            ValueKind::Call { word, arguments } if function(word).is_some() => {
                self.function_of(word, arguments, value.span, scope)
            }
            ValueKind::Call { word, arguments } if self.foreign_reduction(word, arguments) => None,
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
                let raw = self.eval.raw(value, scope)?;
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
                let measure = Measure::new(Reduction::Itself, response);
                return Some((Expression::Measure(measure), Dimension::of_unit(response.unit())));
            }
            self.eval.findings.report(
                Diagnostic::new(Code::E0406, format!("`{}` has a value at many places", name.text))
                    .label(name.span, "not one number")
                    .advise(
                        name.span,
                        Help::write(format!("max({})", name.text))
                            .and(", or use `min`, `mean`, `rms`, `percentile` or `place_of_max`"),
                    ),
            );
            return None;
        }
        let names: Vec<&str> = Response::ALL.iter().map(|r| r.name()).collect();
        let target = self.eval.resolve(path, scope, &names)?;
        if target.is_let {
            let tree = self.eval.scopes[target.id.scope].tree.clone();
            let Item::Let(binding) = &tree.items[target.id.item] else { return None };
            let (counting, operands) = (self.counting, &mut *self.operands);
            return self.eval.within(target.id, path.span, |eval| {
                Reader { eval, counting, operands }.expression(&binding.value, target.id.scope)
            });
        }
        let raw = self.eval.raw(value, scope)?;
        let value = self.of_rail(&raw)?;
        Some((Expression::Number(value), raw.dimension))
    }

    /// `abs sqrt min max` of expressions.
    fn function_of(&mut self, word: &Name, arguments: &[Argument], span: Span, scope: ScopeId) -> Option<Typed> {
        let function = function(word)?;
        let one = matches!(function, Function::Abs | Function::Sqrt);
        let values: Vec<Option<Typed>> = arguments.iter().map(|a| self.expression(&a.value, scope)).collect();
        let values: Vec<Typed> = values.into_iter().collect::<Option<_>>()?;
        if values.is_empty() || one && values.len() != 1 {
            let count = if one { "one value" } else { "at least one value" };
            let text = format!("`{}` takes {count}, found {}", word.text, values.len());
            self.eval.findings.report(Diagnostic::new(Code::E0406, text).label(span, "here"));
            return None;
        }
        let first = values[0].1;
        if let Some(other) = values.iter().position(|(_, dimension)| *dimension != first) {
            self.eval.findings.report(
                Diagnostic::new(Code::E0305, format!("`{}` needs values of the same dimension", word.text))
                    .label(arguments[other].value.span, values[other].1.describe())
                    .label(arguments[0].value.span, first.describe()),
            );
            return None;
        }
        let dimension = if function == Function::Sqrt { first.power(50)? } else { first };
        Some((Expression::Function(function, values.into_iter().map(|(e, _)| e).collect()), dimension))
    }

    fn combine(&mut self, a: Typed, op: BinaryOp, b: Typed, left: Span, right: Span) -> Option<Typed> {
        let dimension = match op {
            BinaryOp::Multiply => a.1 * b.1,
            BinaryOp::Divide => a.1 / b.1,
            _ if a.1 == b.1 => a.1,
            _ => {
                self.eval.findings.report(
                    Diagnostic::new(Code::E0305, format!("`{}` needs two values of the same dimension", op.symbol()))
                        .label(left, a.1.describe())
                        .label(right, b.1.describe()),
                );
                return None;
            }
        };
        Some((Expression::Binary(Box::new(a.0), op, Box::new(b.0)), dimension))
    }

    /// Values in a comparison are for one rail or one seat, like responses.
    pub fn of_rail(&mut self, raw: &Raw) -> Option<f64> {
        let Some((name, span)) = &raw.basis else { return Some(raw.value) };
        match BASES.iter().find(|(basis, _)| basis == name) {
            Some((_, factor)) => Some(raw.value * factor),
            None => {
                let names: Vec<String> = BASES.iter().map(|(basis, _)| format!("`per {basis}`")).collect();
                self.eval.findings.report(
                    Diagnostic::new(Code::E0304, format!("expected {}, found `per {name}`", or_list(&names)))
                        .label(*span, "wrong basis"),
                );
                None
            }
        }
    }

    /// An axle count; in a scene of loads a number of cycles.
    pub fn count(&mut self, value: &Value, scope: ScopeId) -> Option<u64> {
        let raw = self.eval.raw(value, scope)?;
        if raw.dimension == Dimension::CYCLES && !self.counting.traffic {
            return whole(raw.value, "cycles", raw.span, &mut self.eval.findings);
        }
        if ![Dimension::AXLES, Dimension::MASS, Dimension::CYCLES].contains(&raw.dimension) {
            let text = format!("expected a number of axles or the mass carried, found {}", raw.dimension.describe());
            self.eval.findings.report(Diagnostic::new(Code::E0302, text).label(raw.span, "not a count"));
            return None;
        }
        let count = Number { value: raw.value, dimension: raw.dimension, basis: None, factor: 1.0 };
        axle_count(count, raw.span, false, self.counting.counted, &mut self.eval.findings)
    }
}

/// The function of that name.
fn function(word: &Name) -> Option<Function> {
    Some(match word.text.as_str() {
        "abs" => Function::Abs,
        "sqrt" => Function::Sqrt,
        "min" => Function::Min,
        "max" => Function::Max,
        _ => return None,
    })
}

/// The first unit written in an operand.
pub fn unit_of(value: &Value) -> Option<String> {
    match &value.kind {
        ValueKind::Number { unit: Some(unit), .. } => Some(unit.text.clone()),
        ValueKind::Negate(inner) | ValueKind::Per(inner, _) => unit_of(inner),
        _ => None,
    }
}

/// The unit in which engineers read such a value; a place stays in metres.
fn shown_unit(dimension: Dimension, expression: &Expression) -> String {
    let place = matches!(expression, Expression::Measure(m) if m.reduction == Reduction::PlaceOfMax);
    let small = ["mm", "mm/s", "kPa"].into_iter().find(|unit| Dimension::of_unit(unit) == dimension);
    match small {
        Some("mm") if place => "m".to_string(),
        Some(unit) => unit.to_string(),
        None => dimension.usual_unit(),
    }
}

/// The text of a value that may go over several lines.
pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
