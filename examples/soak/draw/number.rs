//! Numbers within their ranges, in a unit of their dimension, with their basis, and such as vary along the track.

use super::Drawing;
use super::aim::want;
use trackbed::schema::{Field, Form, Measure, Need, RANDOM, Varies};
use trackbed::units::{Dimension, parse_unit, usual_units};

/// Axles of the largest train twice.
const TRAINS: f64 = 16.0;
/// What is counted in whole numbers.
const COUNTS: [&str; 4] = ["axles", "cycles", "sleepers", "sleeper"];

impl Drawing<'_> {
    /// A number, now and then one that varies along the track.
    pub(super) fn quantity(&mut self, path: &str, measure: &Measure) -> Option<String> {
        if measure.varies == Varies::No || !self.chance(0.12) {
            let value = self.within(path, measure);
            return Some(self.written(&[value], measure));
        }
        let (one, two) = (self.within(path, measure), self.within(path, measure));
        let (value, basis) = self.unit_and_basis(measure);
        let [one, two] = [one, two].map(|x| plain(value(x)));
        let unit = measure.unit;
        Some(match self.dice.roll(4) {
            0 | 1 => format!("ramp({one} .. {two} {unit}){basis}"),
            2 => format!("smooth({one} .. {two} {unit}){basis}"),
            _ => {
                let arguments: Vec<String> =
                    RANDOM.arguments.iter().filter_map(|a| self.argument("random", a)).collect();
                format!("random({}){basis}", [vec![format!("{one} {unit}")], arguments].concat().join(", "))
            }
        })
    }

    /// `from .. to`, ascending.
    pub(super) fn interval(&mut self, path: &str, measure: &Measure) -> String {
        let (mut one, mut two) = (self.within(path, measure), self.within(path, measure));
        // what may lie on either side of zero does so
        if measure.min < 0.0 && measure.max > 0.0 {
            (one, two) = (-one.abs(), two.abs());
        }
        let (low, high) = (one.min(two), one.max(two));
        let high = if high > low { high } else { low + 0.5 * (measure.max - low).min(low.abs().max(1.0)) };
        let both = if measure.unit.is_empty() { [low.floor(), high.ceil()] } else { [low, high] };
        self.written(&both, measure)
    }

    /// An argument by its name, where it is written.
    pub(super) fn argument(&mut self, path: &str, field: &'static Field) -> Option<String> {
        let path = format!("{path}.{}", field.name);
        let share = match field.need {
            Need::Required => 1.0,
            _ => 0.25,
        };
        let share = want(self.aim, &path).and_then(|want| want.chance).unwrap_or(share);
        if !self.chance(share) || field.name == "per" {
            return None;
        }
        // a file is named as its field shows it, and stands beside the scene
        let shown = field.doc.split('"').nth(1).filter(|_| matches!(field.form, Form::Text));
        let value = match shown {
            Some(file) => Some(format!("\"{file}\"")),
            None => self.value(&path, &field.form),
        };
        value.map(|value| format!("{} = {value}", field.name))
    }

    /// A whole number.
    pub(super) fn whole(&mut self, path: &str, least: u32, most: u32) -> String {
        let measure =
            Measure { unit: "", min: f64::from(least), max: f64::from(most), basis: None, varies: Varies::No };
        let number = self.within(path, &measure).round().clamp(measure.min, measure.max);
        format!("{number}")
    }

    /// A number in the unit and on the first basis of its range.
    pub(super) fn within(&mut self, path: &str, measure: &Measure) -> f64 {
        let whole = [measure.min, measure.max];
        let asked = want(self.aim, path).and_then(|want| want.ranges.iter().find(|(unit, ..)| *unit == measure.unit));
        let usual = self.known.typical.range(path, measure);
        let range = match (asked, usual) {
            (Some((_, low, high)), _) => [*low, *high],
            (None, Some(range)) if !self.chance(self.wild) => range,
            _ => whole,
        };
        let value = rounded(self.drawn(range)).clamp(range[0], range[1]);
        match measure.unit {
            // trains of one vehicle, two or four divide them
            "axles" if range[1] >= TRAINS => ((value / TRAINS).round() * TRAINS).clamp(0.0, range[1]),
            unit if COUNTS.contains(&unit) => value.round().clamp(range[0].ceil(), range[1].floor()),
            _ => value,
        }
    }

    fn drawn(&mut self, [low, high]: [f64; 2]) -> f64 {
        let share = self.share();
        match low {
            _ if low > 0.0 && high / low > 20.0 => low * (high / low).powf(share),
            0.0 if share < 0.1 => 0.0,
            0.0 if high > 1.0 => high * 1e-3_f64.powf(1.0 - share),
            _ => low + share * (high - low),
        }
    }

    /// Numbers with a unit and a basis: one, or two as a range.
    pub(super) fn written(&mut self, values: &[f64], measure: &Measure) -> String {
        let (size, basis) = self.unit_and_basis(measure);
        let own = parse_unit(measure.unit).map_or(1.0, |unit| unit.factor);
        let others = usual_units(Dimension::of_unit(measure.unit));
        let other = (!others.is_empty() && self.chance(0.15)).then(|| others[self.dice.roll(others.len())]);
        let unit = other.unwrap_or(measure.unit);
        let factor = other.and_then(|unit| parse_unit(unit).ok()).map_or(1.0, |unit| own / unit.factor);
        let numbers: Vec<String> = values.iter().map(|x| plain(size(*x) * factor)).collect();
        format!("{} {unit}{basis}", numbers.join(" .. ")).trim_end().to_string()
    }

    /// What a value of the first basis becomes on the one that is drawn, and how that is written.
    fn unit_and_basis(&mut self, measure: &Measure) -> (impl Fn(f64) -> f64 + use<>, String) {
        let Some(basis) = measure.basis else { return (scaled(1.0), String::new()) };
        let (name, factor) = basis.names[self.dice.roll(basis.names.len())];
        let shown =
            if basis.assumed == Some(name) && self.chance(0.5) { String::new() } else { format!(" per {name}") };
        (scaled(basis.names[0].1 / factor), shown)
    }
}

fn scaled(factor: f64) -> impl Fn(f64) -> f64 {
    move |x| x * factor
}

/// To three digits, as people write.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// A number in digits of the language; twelve of them, so that what is divided by a unit stays within its range.
pub(super) fn plain(x: f64) -> String {
    let x: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    if x != 0.0 && x.abs() < 1e-6 { format!("{x:e}") } else { format!("{x}") }
}
