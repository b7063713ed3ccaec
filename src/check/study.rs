//! Studies: `minimise = max(settlement)`, and what must agree within one study. What varies is read in `vary`.

use super::Checker;
use super::modules::ScopeId;
use super::value::{Record, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::response::{Expectation, Expression, Reduction};
use crate::scenario::{Axis, Goal, Measured, Objective, Sampling, Study, Values};
use crate::syntax::tree::Value;
use crate::units::{Dimension, parse_unit};

/// Points of one study.
const MOST_POINTS: usize = 100_000;
/// Axes of a Sobol sequence: as many as it has direction numbers.
pub(super) const MOST_SOBOL_AXES: usize = 21;

impl Checker<'_> {
    /// An expression of responses.
    pub(super) fn measured(&mut self, value: &Value, scope: ScopeId) -> Option<Measured> {
        self.operands = 0;
        let (expression, dimension) = self.expression(value, scope)?;
        let unit = shown_unit(dimension, &expression);
        let size = parse_unit(&unit).map_or(1.0, |u| u.factor);
        let text = one_line(self.loader.sources.text(value.span));
        Some(Measured { text, expression, unit: (unit, size) })
    }

    /// Every study of the main file that has no mistake.
    pub(super) fn studies(&mut self, main: ScopeId) -> Vec<Study> {
        let records = self.all(main, "study");
        records.iter().filter_map(|record| self.study(record, main)).collect()
    }

    fn study(&mut self, record: &Record, main: ScopeId) -> Option<Study> {
        let goals = [(Goal::Minimise, "minimise"), (Goal::Maximise, "maximise")];
        if !record.partial
            && !goals.iter().any(|(_, name)| record.get(name).is_some())
            && record.get("report").is_none()
        {
            self.report(
                Diagnostic::new(Code::E0403, format!("study `{}` asks for nothing", record.name))
                    .at(record.span, "needs `minimise`, `maximise` or `report`")
                    .help("write something like `minimise = differential_settlement`"),
            );
        }
        let Some(Val::Axes(axes)) = record.get("vary").map(|slot| &slot.value) else { return None };
        let set = match record.get("set").map(|slot| &slot.value) {
            Some(Val::Settings(settings)) => settings.to_vec(),
            None => Vec::new(),
            Some(_) => return None,
        };
        let sampling = sampling(record)?;
        let own = axes.iter().map(|a| (&a.path, a.span)).chain(set.iter().map(|s| (&s.path, s.span)));
        let own: Vec<(String, Span)> = own.map(|(path, span)| (path.clone(), span)).collect();
        let apart = self.varied_once(&own) & self.of_this_file(&own, main);
        if !self.sampled(sampling, axes, record) || !apart {
            return None;
        }
        let objectives = goals
            .iter()
            .flat_map(|(goal, name)| measured(record, name).into_iter().map(|of| Objective { goal: *goal, of }));
        let budget = record.number("budget").map(|b| b.value).zip(record.get("budget").map(|slot| slot.span));
        Some(Study {
            name: record.name.clone(),
            span: record.span,
            axes: axes.to_vec(),
            sampling,
            set,
            repeats: record.number("repeats")?.value as u32,
            budget,
            objectives: objectives.collect(),
            report: measured(record, "report"),
            constraints: comparisons(record),
        })
    }

    /// No value varies twice, and none inside another.
    fn varied_once(&mut self, paths: &[(String, Span)]) -> bool {
        let inside = |a: &str, b: &str| a == b || b.strip_prefix(a).is_some_and(|rest| rest.starts_with('.'));
        let mut once = true;
        for (i, (later, span)) in paths.iter().enumerate() {
            let Some((first, place)) = paths[..i].iter().find(|(p, _)| inside(p, later) || inside(later, p)) else {
                continue;
            };
            once = false;
            let message = if first == later {
                format!("`{later}` is varied twice")
            } else {
                format!("`{first}` and `{later}` overlap")
            };
            self.report(
                Diagnostic::new(Code::E0707, message)
                    .at(*span, "again here")
                    .at(*place, "first here")
                    .help("keep one of the two; values that belong together vary as entries of one list"),
            );
        }
        once
    }

    /// A study that comes from a module varies what this file declares.
    fn of_this_file(&mut self, paths: &[(String, Span)], main: ScopeId) -> bool {
        let mut known = true;
        for (path, span) in paths {
            let first = path.split('.').next().unwrap_or(path);
            if !self.scopes[main].names.contains_key(first) {
                known = false;
                self.report(
                    Diagnostic::new(Code::E0704, format!("this file declares nothing called `{first}` to vary"))
                        .at(*span, "varied here")
                        .help(format!("declare `{first}` in the main file; it may extend what a module has")),
                );
            }
        }
        known
    }

    fn sampled(&mut self, sampling: Sampling, axes: &[Axis], record: &Record) -> bool {
        let place = record.get("sampling").map_or(record.span, |slot| slot.span);
        let mistake = match sampling {
            Sampling::Grid => {
                let spread = axes.iter().find(|a| matches!(a.values, Values::Spread(_)));
                let points = axes.iter().fold(1_usize, |n, a| n.saturating_mul(levels(a)));
                match spread {
                    Some(axis) => Diagnostic::new(
                        Code::E0706,
                        format!("a grid needs lists or steps, and `{}` has neither", axis.path),
                    )
                    .at(axis.span, "has every value between two ends")
                    .help("write `steps(a .. b, count = 5)`, or `sampling = sobol(32)`"),
                    None if points > MOST_POINTS => {
                        Diagnostic::new(Code::E0706, format!("the grid has more than {MOST_POINTS} points"))
                            .at(record.span, "too many combinations")
                            .help("write `sampling = sobol(64)`, which spreads so many points over all of them")
                    }
                    None => return true,
                }
            }
            Sampling::Sobol { .. } if axes.len() > MOST_SOBOL_AXES => Diagnostic::new(
                Code::E0706,
                format!("`sobol` spreads over {MOST_SOBOL_AXES} values at most, found {}", axes.len()),
            )
            .at(place, "too many values vary")
            .help("write `latin_hypercube`"),
            _ => return true,
        };
        self.report(mistake);
        false
    }
}

fn levels(axis: &Axis) -> usize {
    match &axis.values {
        Values::Listed(choices) => choices.len(),
        Values::Spread(_) => 1,
    }
}

fn sampling(record: &Record) -> Option<Sampling> {
    let Some(Val::Word { word, arguments }) = record.get("sampling").map(|slot| &slot.value) else { return None };
    let points = || match arguments.get("points")?.value {
        Val::Number(n) => Some(n.value as u32),
        _ => None,
    };
    match word.name {
        "sobol" => Some(Sampling::Sobol { points: points()? }),
        "latin_hypercube" => Some(Sampling::LatinHypercube { points: points()? }),
        _ => Some(Sampling::Grid),
    }
}

fn measured(record: &Record, field: &str) -> Vec<Measured> {
    let Some(Val::List(slots)) = record.get(field).map(|slot| &slot.value) else { return Vec::new() };
    let known = slots.iter().filter_map(|s| if let Val::Measured(m) = &s.value { Some(m.clone()) } else { None });
    known.collect()
}

fn comparisons(record: &Record) -> Vec<Expectation> {
    let Some(Val::List(slots)) = record.get("subject_to").map(|slot| &slot.value) else { return Vec::new() };
    let known = slots.iter().filter_map(|s| if let Val::Comparison(c) = &s.value { Some(c.clone()) } else { None });
    known.collect()
}

/// The unit in which engineers read such a value; a place stays in metres.
fn shown_unit(dimension: Dimension, expression: &Expression) -> String {
    let place = matches!(expression, Expression::Measure(m) if m.reduction == Reduction::PlaceOfMax);
    let small = ["mm", "mm/s", "kPa"].into_iter().find(|unit| Dimension::of(unit) == dimension);
    match small {
        Some("mm") if place => "m".to_string(),
        Some(unit) => unit.to_string(),
        None => dimension.usual_unit(),
    }
}

/// The text of a value that may go over several lines.
pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
