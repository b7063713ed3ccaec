//! Lays a random field along the track, and checks its values against the range of its field.

use super::cover::Cover;
use super::random_field::RandomField;
use crate::check::evaluate::number::Number;
use crate::check::evaluate::shape::Random;
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::Curve;
use crate::units::{number, parse_unit};

/// Points per correlation length for a continuous curve: a spline through them differs from the field by 1e-4 of its
/// scatter.
const KNOTS: f64 = 8.0;
/// Points before and after the track: the effect of its ends decays by a factor of 3.7 per point.
const BEYOND: i64 = 30;

/// The places at which a random field is required.
pub struct Scatter {
    /// m.
    pub start: f64,
    pub end: f64,
    /// Chainages of the seats that need it, m; everywhere if absent.
    pub seats: Option<Vec<f64>>,
    pub span: Span,
}

impl Random {
    /// The value of one rail for a normal number z.
    pub fn value(&self, z: f64) -> f64 {
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

/// A random field as a curve: exact at the seats, else through close points.
pub fn random_curve(random: &Random, seed: u64, cover: &Cover, at: &Scatter, findings: &mut Findings) -> Option<Curve> {
    let seed = random.seed.unwrap_or(seed);
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
    within_range(random, seed, cover, at.span, &points, findings)?;
    Some(curve)
}

/// Refuses a random field with values outside the range of its field.
fn within_range(
    random: &Random,
    seed: u64,
    cover: &Cover,
    span: Span,
    points: &[[f64; 2]],
    findings: &mut Findings,
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
        "reduce the scatter, or write `distribution = log_normal`: its values stay positive"
    } else {
        "reduce the scatter, or change the mean"
    };
    findings.report(
        Diagnostic::new(
            Code::E0605,
            format!(
                "{} of {} random values ({} %) of {} are outside {} .. {}{unit}{per}",
                beyond.len(),
                points.len(),
                number((10.0 * share).round() / 10.0),
                cover.what,
                number(measure.min),
                number(measure.max)
            ),
        )
        .label(span, format!("drawn with seed {seed}, the furthest is {}{unit}", number((1e3 * worst).round() / 1e3)))
        .help(help),
    );
    None
}
