//! Values that vary along the track, as written: `ramp`, `smooth`, `random`, lists keyed by places or spans, data
//! files. `places` finds the chainages of their places when the track is laid out.

use super::evaluator::Evaluator;
use super::number::{Number, Raw};
use super::shape::{Random, Reach, Shape, ShapeKind};
use super::value::Val;
use super::written::{PROFILES, Per, bare, is_profile, looks_like, with_unit};
use crate::check::text::scope::{ItemId, ScopeId};
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Span};
use crate::schema::{Form, Measure, Names, Varies, called};
use crate::syntax::tree::{Argument, Entry, Item, Name, UnitText, Value, ValueKind};
use crate::units::Dimension;

impl Evaluator<'_> {
    /// A number, or a profile if the field may vary along the track.
    pub(super) fn number_or_profile(
        &mut self,
        measure: &'static Measure,
        value: &Value,
        scope: ScopeId,
    ) -> Option<Val> {
        if !self.varies(value, scope) {
            if measure.varies == Varies::Yes && self.misspelt_profile(value) {
                return None;
            }
            if let ValueKind::Range(..) | ValueKind::Text(_) | ValueKind::List { .. } = value.kind {
                if matches!(value.kind, ValueKind::Text(_)) || !self.misspelt_inside(value.span) {
                    self.wrong_form(&Form::Number(*measure), looks_like(&value.kind), value.span);
                }
                return None;
            }
            return self.number(measure, value, scope).map(Val::Number);
        }
        if measure.varies == Varies::Yes {
            return self.shape(measure, value, None, scope).map(|s| Val::Profile(std::rc::Rc::new(s)));
        }
        self.findings.report(
            Diagnostic::new(Code::E0406, "this value is one number; it cannot vary along the track")
                .label(value.span, "a profile"),
        );
        None
    }

    /// Whether a sign of another language has been reported inside a span, with its own help.
    fn misspelt_inside(&self, span: Span) -> bool {
        self.foreign.iter().any(|sign| sign.file == span.file && sign.start >= span.start && sign.end <= span.end)
    }

    /// Reports a word that is similar to the word of a profile.
    fn misspelt_profile(&mut self, value: &Value) -> bool {
        let ValueKind::Call { word, .. } = &bare(value).0.kind else { return false };
        if matches!(word.text.as_str(), "sqrt" | "abs" | "min" | "max") {
            return false;
        }
        let near = called(Names::Words, &word.text, PROFILES.into_iter()).or_else(|| nearest(&word.text, PROFILES));
        let Some(near) = near else { return false };
        self.findings.report(
            Diagnostic::new(Code::E0408, format!("expected a number or a profile, found the word `{}`", word.text))
                .label(word.span, "unknown word")
                .meant(word.span, near),
        );
        true
    }

    fn shape(&mut self, measure: &'static Measure, value: &Value, outer: Per, scope: ScopeId) -> Option<Shape> {
        self.deeper(1, value.span, |c| c.shape_of_value(measure, value, outer, scope))
    }

    fn shape_of_value(
        &mut self,
        measure: &'static Measure,
        value: &Value,
        outer: Per,
        scope: ScopeId,
    ) -> Option<Shape> {
        let (inner, per) = bare(value);
        let per = per.or(outer);
        let kind = match &inner.kind {
            ValueKind::Call { word, arguments } if matches!(word.text.as_str(), "ramp" | "smooth") => {
                self.ramp(measure, word, arguments, per, scope)?
            }
            ValueKind::Call { word, arguments } if word.text == "file" => {
                self.data_profile(measure, word, arguments, per, inner.span)?
            }
            ValueKind::Call { word, arguments } if word.text == "random" => {
                self.random(measure, word, arguments, per, scope)?
            }
            ValueKind::List { entries, unit } if is_profile(inner) => {
                self.keyed(measure, entries, unit.as_ref(), per, scope)?
            }
            ValueKind::Path(path) => {
                if let Some(shape) = self.named_shape(measure, path, &per, scope) {
                    return shape.map(|s| Shape { span: value.span, ..s });
                }
                ShapeKind::Constant(self.held(measure, inner, per, scope)?)
            }
            ValueKind::Binary(..) | ValueKind::Negate(_) if self.varies(inner, scope) => {
                let worked = self.worked(inner, scope)?;
                return self.shape(measure, &worked, per, scope).map(|s| Shape { span: value.span, ..s });
            }
            _ => ShapeKind::Constant(self.held(measure, inner, per, scope)?),
        };
        Some(Shape { kind, span: value.span, from: None, runs: None })
    }

    /// A profile behind a name; the outer `None` if the name is a number, or unknown.
    fn named_shape(
        &mut self,
        measure: &'static Measure,
        path: &crate::syntax::tree::Path,
        per: &Per,
        scope: ScopeId,
    ) -> Option<Option<Shape>> {
        // an unknown name is reported when its number is read
        let first = self.scopes[scope].names.get(&path.names[0].text).copied()?;
        let tree = self.scopes[scope].tree.clone();
        let Item::Let(binding) = &tree.items[first] else { return None };
        let leads_on = matches!(bare(&binding.value).0.kind, ValueKind::Path(_));
        if path.names.len() > 1 || !(is_profile(&binding.value) || leads_on) {
            return None;
        }
        let id = ItemId { scope, item: first };
        Some(self.within(id, path.span, |c| c.shape(measure, &binding.value, per.clone(), scope)))
    }

    fn held(&mut self, measure: &'static Measure, value: &Value, per: Per, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        self.hold(measure, Raw { basis: raw.basis.clone().or(per), ..raw })
    }

    /// `ramp(50 .. 80 MN/m, over = -8 .. 0 m)`
    fn ramp(
        &mut self,
        measure: &'static Measure,
        word: &Name,
        arguments: &[Argument],
        outer: Per,
        scope: ScopeId,
    ) -> Option<ShapeKind> {
        self.arguments_of(word, arguments, &["over"])?;
        let Some(first) = arguments.first().filter(|a| a.name.is_none()) else {
            self.findings.report(
                Diagnostic::new(Code::E0403, format!("`{}` needs its two values", word.text))
                    .label(word.span, "no values given")
                    .help(format!("write something like `{}(a .. b)`", word.text)),
            );
            return None;
        };
        let (range, per) = bare(&first.value);
        let ValueKind::Range(from, to) = &range.kind else {
            self.wrong_form(&Form::Interval(*measure), looks_like(&range.kind), first.value.span);
            return None;
        };
        let per = per.or(outer);
        let (a, b) = self.ends(from, to, scope)?;
        let a = Raw { basis: a.basis.clone().or(per.clone()), ..a };
        let b = Raw { basis: b.basis.clone().or(per), ..b };
        // both ends have the same wrong dimension, or lack the same `per`
        if a.dimension == b.dimension && b.dimension != Dimension::of_unit(measure.unit) {
            self.wrong_ends(&a, &b, measure, range.span);
            return None;
        }
        self.basis(measure, &Raw { span: range.span, ..a.clone() })?;
        let (a, b) = (self.hold(measure, a), self.hold(measure, b));
        let over = match arguments.iter().find(|a| a.name.is_some()) {
            Some(argument) => Some(self.reach(&argument.value, scope)?),
            None => None,
        };
        Some(ShapeKind::Ramp { from: a?, to: b?, smooth: word.text == "smooth", over })
    }

    /// Refuses arguments that a word does not have; it has one argument by place, and these by name.
    pub(super) fn arguments_of(&mut self, word: &Name, arguments: &[Argument], named: &[&str]) -> Option<()> {
        let mut seen: Vec<&str> = Vec::new();
        for (i, argument) in arguments.iter().enumerate() {
            let name = argument.name.as_ref().map_or("", |n| n.text.as_str());
            let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
            if seen.contains(&name) && !name.is_empty() {
                let message = format!("`{name}` of `{}` is given twice", word.text);
                self.findings.report(Diagnostic::new(Code::E0404, message).label(place, "again here"));
                return None;
            }
            if !(named.contains(&name) || name.is_empty() && i == 0) {
                self.findings.report(
                    Diagnostic::new(Code::E0402, format!("`{}` has no such argument", word.text))
                        .label(place, "unknown argument")
                        .help(format!("after its value it takes `{} = ...`", named.join(" = ...` and `"))),
                );
                return None;
            }
            seen.push(name);
        }
        Some(())
    }

    fn reach(&mut self, value: &Value, scope: ScopeId) -> Option<Reach> {
        let ValueKind::Range(from, to) = &value.kind else {
            if value.kind != ValueKind::Error {
                self.wrong_form(&Form::Span, looks_like(&value.kind), value.span);
            }
            return None;
        };
        let Val::Range(from, to) = self.span(from, to, scope)? else { return None };
        Some(Reach { from, to, span: value.span })
    }

    /// `[-20 m: 0 mm, 0 m: 4 mm]`, or `[-20 .. -6 m: 0 mm, -6 .. 0 m: ramp(0 .. 4 mm)]`
    fn keyed(
        &mut self,
        measure: &'static Measure,
        entries: &[Entry],
        unit: Option<&UnitText>,
        per: Per,
        scope: ScopeId,
    ) -> Option<ShapeKind> {
        let before = self.findings.diagnostics.len();
        let by_spans = entries.iter().any(|e| matches!(e.key.as_ref().map(|k| &k.kind), Some(ValueKind::Range(..))));
        let (mut points, mut spans) = (Vec::new(), Vec::new());
        let mut sound = true;
        for entry in entries {
            let Some(key) = &entry.key else {
                self.findings.report(
                    Diagnostic::new(Code::E0406, "expected a place and its value, found a value alone")
                        .label(entry.value.span, "no place given")
                        .help("write `[place: value]`"),
                );
                sound = false;
                continue;
            };
            let value = with_unit(&entry.value, unit);
            if by_spans {
                let (reach, shape) = (self.key_span(key, scope), self.shape(measure, &value, per.clone(), scope));
                sound &= reach.is_some() && shape.is_some();
                spans.extend(reach.zip(shape));
            } else {
                let place = self.place(key, scope);
                if is_profile(&value) {
                    self.findings.report(
                        Diagnostic::new(Code::E0406, "expected one value at a place, found a profile")
                            .label(value.span, "no span given")
                            .help("key the list by spans: `[-20 .. -6 m: ..., -6 .. 0 m: ...]`"),
                    );
                    sound = false;
                    continue;
                }
                let held = self.held_entry(measure, &value, per.clone(), scope);
                sound &= place.is_some() && held.is_some();
                points.extend(place.zip(held).map(|(place, held)| (place, key.span, held)));
            }
        }
        if !sound {
            self.one_missing_unit(before, entries);
            return None;
        }
        Some(if by_spans { ShapeKind::Spans(spans) } else { ShapeKind::Points(points) })
    }

    fn held_entry(&mut self, measure: &'static Measure, value: &Value, per: Per, scope: ScopeId) -> Option<Number> {
        let (inner, own) = bare(value);
        self.held(measure, inner, own.or(per), scope)
    }

    /// A span, or one sleeper.
    fn key_span(&mut self, key: &Value, scope: ScopeId) -> Option<Reach> {
        if let ValueKind::Range(..) = key.kind {
            return self.reach(key, scope);
        }
        let place = self.place(key, scope)?;
        if place.dimension != Dimension::SLEEPERS {
            self.findings.report(
                Diagnostic::new(Code::E0406, "expected a span, found a place")
                    .label(key.span, "a place among spans")
                    .help("key the whole list by spans, or the whole list by places"),
            );
            return None;
        }
        Some(Reach { from: place, to: place, span: key.span })
    }

    /// A profile read elsewhere, checked against another field.
    pub(super) fn rehold(&mut self, measure: &'static Measure, shape: &Shape, span: Span) -> Option<Shape> {
        let mut hold = |n: Number| {
            let basis = n.basis.map(|b| (b.to_string(), span));
            self.hold(measure, Raw { value: n.value, dimension: n.dimension, basis, span, bare: false })
        };
        let kind = match &shape.kind {
            ShapeKind::Constant(n) => ShapeKind::Constant(hold(*n)?),
            ShapeKind::Ramp { from, to, smooth, over } => {
                ShapeKind::Ramp { from: hold(*from)?, to: hold(*to)?, smooth: *smooth, over: *over }
            }
            ShapeKind::Points(points) => ShapeKind::Points(
                points.iter().map(|(place, at, n)| Some((*place, *at, hold(*n)?))).collect::<Option<_>>()?,
            ),
            ShapeKind::Table { column, rows, ends } => ShapeKind::Table {
                column: column.clone(),
                rows: rows.iter().map(|(x, n)| Some((*x, hold(*n)?))).collect::<Option<_>>()?,
                ends: *ends,
            },
            ShapeKind::Random(random) => {
                ShapeKind::Random(Random { mean: hold(random.mean)?, measure, ..random.clone() })
            }
            ShapeKind::Spans(spans) => {
                let held = spans.iter().map(|(reach, inner)| Some((*reach, self.rehold(measure, inner, span)?)));
                ShapeKind::Spans(held.collect::<Option<_>>()?)
            }
        };
        Some(Shape { kind, span, ..*shape })
    }
}
