//! `random(mean, cov = 10 %)`: a value that scatters along the track.

use super::Checker;
use super::arithmetic::Raw;
use super::modules::ScopeId;
use super::profile::{Per, ShapeKind};
use super::random_field::RandomField;
use super::seats::Cover;
use super::value::{Number, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Curve, Origin};
use crate::schema::{Measure, RANDOM};
use crate::syntax::tree::{Argument, Field, Item, Name, Value, ValueKind};
use crate::units::{Dimension, number, parse_unit};

/// Where nothing is said of the scatter.
const USUAL_COV: f64 = 0.1;
/// Points a correlation length where it is asked for everywhere: a spline through them leaves the field by 1e-4 of its scatter.
const KNOTS: f64 = 8.0;
/// Points before and after the track: what its ends do is damped by 3.7 a point.
const BEYOND: i64 = 30;

/// A random field, as written.
#[derive(Debug, Clone)]
pub(super) struct Random {
    pub mean: Number,
    /// Standard deviation, in the unit and basis of the mean.
    pub deviation: f64,
    /// m.
    pub correlation: f64,
    pub log_normal: bool,
    /// That of the scene where none is given.
    pub seed: Option<u64>,
    /// The path of the field in which it is written: what it is drawn for, whatever else stands in the file.
    pub path: String,
    pub measure: &'static Measure,
}

impl Random {
    /// The value of one rail for a normal number z.
    fn value(&self, z: f64) -> f64 {
        let mean = self.mean.value;
        let value = if self.log_normal {
            let variance = (self.deviation / mean).powi(2).ln_1p();
            mean * (variance.sqrt() * z - 0.5 * variance).exp()
        } else {
            mean + self.deviation * z
        };
        Number { value, ..self.mean }.of_rail()
    }

    /// A value of one rail as messages show it, with the unit and the basis of the field's range.
    fn shown(&self, of_rail: f64) -> f64 {
        let unit = parse_unit(self.measure.unit).map_or(1.0, |u| u.factor);
        of_rail / self.measure.basis.map_or(1.0, |b| b.names[0].1) / unit
    }
}

impl Checker<'_> {
    pub(super) fn random(
        &mut self,
        measure: &'static Measure,
        word: &Name,
        arguments: &[Argument],
        per: Per,
        scope: ScopeId,
    ) -> Option<ShapeKind> {
        let Some(first) = arguments.first().filter(|a| a.name.is_none()) else {
            self.report(
                Diagnostic::new(Code::E0403, "`random` needs its mean")
                    .at(word.span, "around which value?")
                    .help("write something like `random(mean, cov = 10 %)`"),
            );
            return None;
        };
        let is_sd = |a: &&Argument| a.name.as_ref().is_some_and(|n| n.text == "sd");
        let sd = arguments.iter().find(is_sd);
        let others: Vec<Argument> = arguments[1..].iter().filter(|a| !is_sd(a)).cloned().collect();
        let value = self.word(&RANDOM, &others, word, scope)?;
        let mut slot = Slot { value, span: word.span, origin: Origin::Written(word.span) };
        self.complete_slot(&mut slot);
        let Val::Word { arguments: given, .. } = slot.value else { return None };
        let mean = self.raw(&first.value, scope)?;
        let mean = Raw { basis: mean.basis.clone().or(per.clone()), ..mean };
        let mean = self.hold(measure, mean)?;
        let plain = |name: &str| match given.get(name).map(|slot| &slot.value) {
            Some(Val::Number(n)) => Ok(Some(n.value)),
            Some(_) => Err(()),
            None => Ok(None),
        };
        let (cov, correlation, seed) = (plain("cov").ok()?, plain("correlation").ok()??, plain("seed").ok()?);
        let Some(Val::Word { word: distribution, .. }) = given.get("distribution").map(|slot| &slot.value) else {
            return None;
        };
        let log_normal = distribution.name == "log_normal";
        let deviation = match (sd, cov) {
            (Some(sd), Some(_)) => {
                let cov = given.get("cov").map_or(word.span, |slot| slot.span);
                self.report(
                    Diagnostic::new(Code::E0407, "`cov` and `sd` both say how much a random value scatters")
                        .at(sd.value.span, "as a value")
                        .at(cov, "as a share of the mean")
                        .help("keep one way of the two"),
                );
                return None;
            }
            (Some(sd), None) => self.deviation(measure, &mean, &sd.value, per, scope)?,
            (None, cov) => cov.unwrap_or(USUAL_COV) * mean.value.abs(),
        };
        self.scatters(&mean, deviation, log_normal, first.value.span)?;
        let path = self.path_of(word.span, scope);
        let seed = seed.map(|seed| seed as u64);
        Some(ShapeKind::Random(Random { mean, deviation, correlation, log_normal, seed, path, measure }))
    }

    /// A standard deviation of the field's dimension, in the basis of the mean.
    fn deviation(
        &mut self,
        measure: &'static Measure,
        mean: &Number,
        value: &Value,
        per: Per,
        scope: ScopeId,
    ) -> Option<f64> {
        let raw = self.raw(value, scope)?;
        let raw = Raw { basis: raw.basis.clone().or(per).or(mean.basis.map(|b| (b.to_string(), raw.span))), ..raw };
        if raw.dimension != Dimension::of(measure.unit) {
            self.wrong_dimension(&raw, measure, "expected a standard deviation of the same dimension as the mean");
            return None;
        }
        let (_, factor) = self.basis(measure, &raw)?;
        if raw.value <= 0.0 {
            self.report(
                Diagnostic::new(Code::E0405, "expected a positive standard deviation").at(raw.span, "out of range"),
            );
            return None;
        }
        Some(raw.value * factor / mean.factor)
    }

    /// Whether there is such a distribution.
    fn scatters(&mut self, mean: &Number, deviation: f64, log_normal: bool, span: Span) -> Option<()> {
        let mistake = if log_normal && mean.value <= 0.0 {
            Diagnostic::new(Code::E0405, "a log-normal value is positive, and so is its mean")
                .at(span, "not above zero")
                .help("`distribution = normal` takes any mean")
        } else if deviation == 0.0 {
            Diagnostic::new(Code::E0405, "a share of a mean of zero is nothing")
                .at(span, "nothing would scatter")
                .help("say how much it scatters as a value: `sd = ...` instead of `cov`")
        } else {
            return Some(());
        };
        self.report(mistake);
        None
    }

    /// The path of the field, or the name of the `let`, in which a place of the text lies.
    fn path_of(&self, place: Span, scope: ScopeId) -> String {
        let inside = |span: Span| span.file == place.file && span.start <= place.start && place.end <= span.end;
        let tree = &self.scopes[scope].tree;
        let path = tree.items.iter().find_map(|item| match item {
            Item::Let(binding) => inside(binding.value.span).then(|| binding.name.text.clone()),
            Item::Declaration(d) => {
                let name = d.name.as_ref().map_or(&d.kind.text, |name| &name.text);
                Some(format!("{name}.{}", path_in(&d.fields, &inside)?))
            }
            Item::Use(_) => None,
        });
        path.unwrap_or_default()
    }

    /// A random field as a curve: exact at the seats, else through close points.
    pub(super) fn random_curve(&mut self, random: &Random, cover: &Cover, at: &Scatter) -> Option<Curve> {
        let seed = random.seed.unwrap_or(self.seed);
        let field = RandomField::new(seed, &random.path, random.correlation);
        let point = |x: f64| [x, random.value(field.value(x))];
        let (points, curve) = match &at.seats {
            Some(seats) => {
                let points: Vec<[f64; 2]> = seats.iter().map(|x| point(*x)).collect();
                let curve =
                    if points.is_empty() { Curve::constant(random.value(0.0)) } else { Curve::Linear(points.clone()) };
                (points, curve)
            }
            None => {
                let step = random.correlation / KNOTS;
                let (first, last) = ((at.start / step).floor() as i64, (at.end / step).ceil() as i64);
                let points: Vec<[f64; 2]> = (first - BEYOND..=last + BEYOND).map(|i| point(i as f64 * step)).collect();
                let on_track = points.iter().filter(|[x, _]| (at.start..=at.end).contains(x)).copied().collect();
                (on_track, if cover.smooth { Curve::natural(&points) } else { Curve::Linear(points) })
            }
        };
        self.within_range(random, seed, cover, at.span, &points)?;
        Some(curve)
    }

    /// Refuses a field that leaves the range of what it is drawn for.
    fn within_range(
        &mut self,
        random: &Random,
        seed: u64,
        cover: &Cover,
        span: Span,
        points: &[[f64; 2]],
    ) -> Option<()> {
        let measure = random.measure;
        let beyond: Vec<f64> = points
            .iter()
            .map(|[_, value]| random.shown(*value))
            .filter(|value| !(measure.min..=measure.max).contains(value))
            .collect();
        let outside = |value: f64| (measure.min - value).max(value - measure.max);
        let Some(worst) = beyond.iter().copied().max_by(|a, b| outside(*a).total_cmp(&outside(*b))) else {
            return Some(());
        };
        let unit = if measure.unit.is_empty() { String::new() } else { format!(" {}", measure.unit) };
        let per = measure.basis.map_or(String::new(), |b| format!(" per {}", b.names[0].0));
        let share = 100.0 * beyond.len() as f64 / points.len() as f64;
        let help = if measure.min >= 0.0 && !random.log_normal {
            "let it scatter less, or write `distribution = log_normal`: its values stay positive"
        } else {
            "let it scatter less, or move its mean"
        };
        self.report(
            Diagnostic::new(
                Code::E0605,
                format!(
                    "{} of {} random values ({} %) of {} leave {} .. {}{unit}{per}",
                    beyond.len(),
                    points.len(),
                    number((10.0 * share).round() / 10.0),
                    cover.what,
                    number(measure.min),
                    number(measure.max)
                ),
            )
            .at(span, format!("drawn with seed {seed}, the furthest is {}{unit}", number((1e3 * worst).round() / 1e3)))
            .help(help),
        );
        None
    }
}

/// Where a random field is asked for.
pub(super) struct Scatter {
    /// m.
    pub start: f64,
    pub end: f64,
    /// Chainages of the seats that ask for it, m; everywhere where absent.
    pub seats: Option<Vec<f64>>,
    pub span: Span,
}

fn path_in(fields: &[Field], inside: &dyn Fn(Span) -> bool) -> Option<String> {
    let field = fields.iter().find(|field| inside(field.value.span))?;
    let own = field.path.text();
    let inner = match &field.value.kind {
        ValueKind::Object { fields, .. } => path_in(fields, inside),
        _ => None,
    };
    Some(inner.map_or(own.clone(), |inner| format!("{own}.{inner}")))
}
