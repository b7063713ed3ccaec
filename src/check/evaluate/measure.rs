//! Checks numbers against a measure: dimension, basis and range; intervals, places and spans.

use super::evaluator::Evaluator;
use super::number::{Number, Raw};
use super::offers;
use super::value::Val;
use super::written::looks_like;
use crate::check::text::scope::ScopeId;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Help, Span};
use crate::schema::{Basis, Form, Measure};
use crate::syntax::tree::{Value, ValueKind};
use crate::units::{Dimension, Quantity, number, parse_unit};

/// Other names that engineers use for the bases of a value.
const ALSO_CALLED: [(&str, &str); 13] = [
    ("axle", "wheelset"),
    ("half_sleeper", "seat"),
    ("rail_seat", "seat"),
    ("wagon", "vehicle"),
    ("car", "vehicle"),
    ("grain", "particle"),
    ("tie", "sleeper"),
    ("crosstie", "sleeper"),
    ("schwelle", "sleeper"),
    ("side", "seat"),
    ("axlebox", "wheel"),
    ("truck", "bogie"),
    ("line", "track"),
];

impl Evaluator<'_> {
    /// A number that a measure takes.
    pub fn number(&mut self, measure: &'static Measure, value: &Value, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        self.hold(measure, raw)
    }

    /// Checks dimension, basis and range.
    pub fn hold(&mut self, measure: &'static Measure, raw: Raw) -> Option<Number> {
        let expected = Dimension::of_unit(measure.unit);
        if raw.dimension != expected {
            self.wrong_dimension(&raw, &[measure], &format!("expected {}", Form::Number(*measure).describe()));
            return None;
        }
        let (basis, factor) = self.basis(measure, &raw)?;
        let unit = parse_unit(measure.unit).map_or(1.0, |u| u.factor);
        let range_factor = measure.basis.map_or(1.0, |b| b.names[0].1);
        let shown = raw.value * factor / range_factor / unit;
        let slack = 1e-9 * shown.abs();
        if shown < measure.min - slack || shown > measure.max + slack {
            let per = measure.basis.map_or(String::new(), |b| format!(" per {}", b.names[0].0));
            let unit = if measure.unit.is_empty() { String::new() } else { format!(" {}", measure.unit) };
            self.findings.report(
                Diagnostic::new(
                    Code::E0405,
                    format!(
                        "expected {} .. {}{unit}{per}, found {}{unit}{per}",
                        number(measure.min),
                        number(measure.max),
                        number(shown)
                    ),
                )
                .label(raw.span, "out of range")
                .maybe_advise(raw.span, self.in_range(measure, &raw, shown)),
            );
            return None;
        }
        Some(Number { value: raw.value, dimension: raw.dimension, basis, factor })
    }

    /// Help for a value out of range: a share without its sign, a wrong sign, a wrong prefix.
    fn in_range(&self, measure: &Measure, raw: &Raw, shown: f64) -> Option<Help> {
        let fits = |x: f64| (measure.min..=measure.max).contains(&x);
        let per = measure.basis.map_or(String::new(), |b| format!(" per {}", b.names[0].0));
        if raw.bare && measure.unit == "%" && fits(raw.value) {
            return Some(Help::write(format!("{} %", number(raw.value))));
        }
        if self.asked.is_some_and(|(kind, field)| (kind.name, field) == ("wheelset", "radius")) && fits(shown / 2.0) {
            let half = Quantity::new(raw.value / 2.0, raw.dimension).show(&self.unit_written(raw, measure));
            return Some(Help::write(half).and(": a radius is half of the diameter"));
        }
        if shown < 0.0 && fits(-shown) {
            let written = Help::write(format!("{} {}{per}", number(-shown), measure.unit));
            return Some(written.and(", without the sign"));
        }
        let thousands = [1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9].into_iter().map(|step| shown * step).find(|x| fits(*x))?;
        let there = format!("{} {}{per}", number(thousands), measure.unit);
        let said = format!("`{there}` would be in range: is the prefix of the unit right?");
        (!measure.unit.is_empty()).then(|| Help::say(said))
    }

    /// The unit in which a number is written, else the unit of its field.
    fn unit_written(&self, raw: &Raw, measure: &Measure) -> String {
        let text = self.files.sources.text(raw.span);
        let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-._".contains(c)).trim();
        if Dimension::of_unit(unit) == raw.dimension { unit.to_owned() } else { measure.unit.to_owned() }
    }

    /// Refuses `per` for a value without a basis.
    fn of_one_thing(&mut self, raw: &Raw) -> Option<()> {
        let Some((name, span)) = &raw.basis else { return Some(()) };
        let text = self.files.sources.text(raw.span).to_string();
        self.findings.report(
            Diagnostic::new(Code::E0304, format!("`per {name}` is not allowed here: the value has no basis"))
                .label(*span, "leave it out")
                .write(raw.span.to(*span), text),
        );
        None
    }

    /// The basis of a value, and the factor from it to one rail.
    pub fn basis(&mut self, measure: &'static Measure, raw: &Raw) -> Option<(Option<&'static str>, f64)> {
        match (measure.basis, &raw.basis) {
            (None, None) => Some((None, 1.0)),
            (None, Some(_)) => {
                self.of_one_thing(raw)?;
                None
            }
            (Some(basis), Some((name, span))) => match basis.names.iter().find(|(n, _)| n == name) {
                Some((known, factor)) => Some((Some(known), *factor)),
                None => {
                    let text = self.files.sources.text(raw.span).to_string();
                    let known = || basis.names.iter().map(|(n, _)| *n);
                    let called = ALSO_CALLED.iter().find(|(theirs, _)| theirs == name).map(|(_, ours)| *ours);
                    let meant = called.filter(|ours| known().any(|n| n == *ours)).or_else(|| nearest(name, known()));
                    let help = match meant {
                        Some(meant) => Help::meant(format!("{text} per {meant}")),
                        None => {
                            let written = Help::write(format!("{text} per {}", basis.names[0].0));
                            written.and(", if that is what you meant")
                        }
                    };
                    self.findings.report(
                        Diagnostic::new(Code::E0304, format!("expected {}, found `per {name}`", basis.list()))
                            .label(*span, "wrong basis")
                            .advise(raw.span.to(*span), help),
                    );
                    None
                }
            },
            (Some(basis), None) => match basis.assumed {
                Some(name) => Some((Some(name), basis.factor(name)?)),
                None => {
                    let text = self.files.sources.text(raw.span).to_string();
                    self.findings.report(
                        Diagnostic::new(Code::E0304, format!("expected {}, found none of them", basis.list()))
                            .label(raw.span, "may be per half or per whole")
                            .advise(raw.span, per_what(&text, basis)),
                    );
                    None
                }
            },
        }
    }

    /// Refuses a value of a wrong dimension, or without its unit.
    pub(super) fn wrong_dimension(&mut self, raw: &Raw, measures: &[&'static Measure], expected: &str) {
        if raw.bare && raw.dimension.is_none() {
            return self.missing_unit(measures, &[raw.value], raw.basis_name(), raw.span, expected);
        }
        let text = self.files.sources.text(raw.span);
        let other = self.asked.and_then(|(kind, field)| offers::other_way(kind, field, raw));
        let help = match other {
            Some(field) => Some(Help::say(format!("write `{field} = {text}`, if that is what you meant"))),
            None => measures.iter().find_map(|measure| offers::of_other_dimension(measure, raw, text)),
        };
        self.other_dimension(measures[0], raw, expected, help);
    }

    /// Refuses both ends of a range for the same mistake.
    pub(super) fn wrong_ends(&mut self, a: &Raw, b: &Raw, measure: &'static Measure, span: Span) {
        let expected = format!("expected {}", Form::Number(*measure).describe());
        if a.bare && b.bare && b.dimension.is_none() {
            return self.missing_unit(&[measure], &[a.value, b.value], b.basis_name(), span, &expected);
        }
        let help = offers::ends_of_other_dimension(measure, a, b);
        self.other_dimension(measure, &Raw { span, ..b.clone() }, &expected, help);
    }

    fn other_dimension(&mut self, measure: &Measure, raw: &Raw, expected: &str, help: Option<Help>) {
        let dimension = Dimension::of_unit(measure.unit);
        self.findings.report(
            Diagnostic::new(Code::E0302, format!("{expected}, found {}", raw.dimension.describe()))
                .label(raw.span, Quantity::new(raw.value, raw.dimension).show(&raw.dimension.usual_unit()))
                .help(crate::units::compare(dimension, raw.dimension))
                .maybe_advise(of_raw(raw), help),
        );
    }

    /// Refuses numbers without a unit in a span.
    pub fn missing_unit(
        &mut self,
        measures: &[&'static Measure],
        values: &[f64],
        basis: Option<&str>,
        span: Span,
        expected: &str,
    ) {
        let help = offers::with_unit(self.files.sources.text(span), values, measures, basis);
        self.findings.report(
            Diagnostic::new(Code::E0301, format!("{expected}, found a number without a unit"))
                .label(span, "its unit is missing")
                .advise(span, help),
        );
    }

    /// A whole number within a range.
    pub(super) fn integer(&mut self, min: u32, max: u32, value: &Value, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        self.of_one_thing(&raw)?;
        if !raw.dimension.is_none() {
            self.findings.report(
                Diagnostic::new(Code::E0302, format!("expected a whole number, found {}", raw.dimension.describe()))
                    .label(raw.span, "has a unit")
                    .help("write a whole number without a unit"),
            );
            return None;
        }
        if raw.value.fract() != 0.0 || raw.value < f64::from(min) || raw.value > f64::from(max) {
            self.findings.report(
                Diagnostic::new(
                    Code::E0405,
                    format!("expected a whole number from {min} to {max}, found {}", number(raw.value)),
                )
                .label(raw.span, "out of range"),
            );
            return None;
        }
        Some(raw.into())
    }

    /// `from .. to`; a bare first end takes the unit of the second, `per` holds for both.
    pub fn ends(&mut self, from: &Value, to: &Value, scope: ScopeId) -> Option<(Raw, Raw)> {
        let (mut a, b) = (self.raw(from, scope), self.raw(to, scope)?);
        if let (Some(raw), ValueKind::Number { unit: Some(unit), .. }) = (&mut a, unsigned(to))
            && raw.bare
        {
            raw.value *= parse_unit(&unit.text).map_or(1.0, |u| u.factor);
            raw.dimension = b.dimension;
            raw.bare = false;
        }
        Some((a?, b))
    }

    /// A range of values that a measure takes.
    pub fn interval(&mut self, measure: &'static Measure, value: &Value, scope: ScopeId) -> Option<Val> {
        let (range, basis) = match &value.kind {
            ValueKind::Per(inner, basis) => (&**inner, Some((basis.text.clone(), basis.span))),
            _ => (value, None),
        };
        let ValueKind::Range(from, to) = &range.kind else {
            self.wrong_form(&Form::Interval(*measure), looks_like(&value.kind), value.span);
            return None;
        };
        let (a, b) = self.ends(from, to, scope)?;
        let a = Raw { basis: basis.clone().or(a.basis.clone()), ..a };
        let b = Raw { basis: basis.or(b.basis.clone()), ..b };
        if a.dimension == b.dimension && b.dimension != Dimension::of_unit(measure.unit) {
            self.wrong_ends(&a, &b, measure, range.span);
            return None;
        }
        self.basis(measure, &Raw { span: range.span, ..a.clone() })?;
        let (a, b) = (self.hold(measure, a), self.hold(measure, b));
        self.ascending(a?, b?, range.span)
    }

    fn ascending(&mut self, a: Number, b: Number, span: Span) -> Option<Val> {
        if a.of_rail() <= b.of_rail() {
            return Some(Val::Range(a, b));
        }
        let swapped = swapped(self.files.sources.text(span));
        self.findings.report(
            Diagnostic::new(Code::E0505, "a span must ascend")
                .label(span, "the first end is greater than the second")
                .maybe_advise(span, swapped),
        );
        None
    }

    /// A place in `m` or `sleepers`.
    pub fn place(&mut self, value: &Value, scope: ScopeId) -> Option<Number> {
        let raw = self.raw(value, scope)?;
        self.hold_place(raw)
    }

    fn hold_place(&mut self, raw: Raw) -> Option<Number> {
        if raw.dimension == Dimension::LENGTH || raw.dimension == Dimension::SLEEPERS {
            self.of_one_thing(&raw)?;
            return Some(raw.into());
        }
        let text = self.files.sources.text(raw.span).to_string();
        let mistake = if raw.bare {
            Diagnostic::new(Code::E0301, "expected a place in `m` or `sleepers`, found a number without a unit")
                .label(raw.span, "its unit is missing")
                .advise(raw.span, Help::write_one_of(vec![format!("{text} sleepers"), format!("{text} m")]))
        } else {
            Diagnostic::new(
                Code::E0302,
                format!("expected a place in `m` or `sleepers`, found {}", raw.dimension.describe()),
            )
            .label(raw.span, "not a place")
        };
        self.findings.report(mistake);
        None
    }

    /// A span of places in `m` or `sleepers`.
    pub fn span(&mut self, from: &Value, to: &Value, scope: ScopeId) -> Option<Val> {
        let (a, b) = self.ends(from, to, scope)?;
        let whole = from.span.to(to.span);
        if a.bare && b.bare {
            // one unit is missing, for both
            self.hold_place(Raw { span: whole, ..b.clone() })?;
        }
        let (a, b) = (self.hold_place(a), self.hold_place(b));
        let (a, b) = (a?, b?);
        if a.dimension != b.dimension {
            self.findings.report(
                Diagnostic::new(Code::E0305, "both ends of a span are in `m`, or both in `sleepers`")
                    .label(whole, "mixed")
                    .help("write both ends in `m`, or both in `sleepers`"),
            );
            return None;
        }
        self.ascending(a, b, whole)
    }
}

/// A range with swapped ends: a unit that is written once, behind the second end, stays there.
pub fn swapped(text: &str) -> Option<Help> {
    let (from, to) = text.split_once("..")?;
    let (from, to) = (from.trim(), to.trim());
    let bare = |end: &str| end.chars().all(|c| c.is_ascii_digit() || "+-._".contains(c));
    let written = match to.split_once(' ').filter(|(end, _)| bare(from) && bare(end)) {
        Some((end, unit)) => format!("{end} .. {from} {unit}"),
        None => format!("{to} .. {from}"),
    };
    Some(Help { said: format!("write the smaller end first: `{written}`"), writes: vec![written] })
}

/// A value with the first basis that it may have.
fn per_what(text: &str, basis: &Basis) -> Help {
    Help::write(format!("{text} per {}", basis.names[0].0)).and(", if that is what you meant")
}

/// A number with its basis, if it has one.
fn of_raw(raw: &Raw) -> Span {
    raw.basis
        .as_ref()
        .map_or(raw.span, |(_, span)| if span.file == raw.span.file { raw.span.to(*span) } else { raw.span })
}

fn unsigned(value: &Value) -> &ValueKind {
    match &value.kind {
        ValueKind::Negate(inner) => unsigned(inner),
        kind => kind,
    }
}
