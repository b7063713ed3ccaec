//! Help for a number that a field cannot take: with a unit that makes it legal, or converted to the quantity of the
//! field.

use super::number::Raw;
use crate::diag::Help;
use crate::schema::{Kind, Measure};
use crate::units::{Dimension, number, parse_unit, usual_units};

/// Divisor from a weight to a mass.
const GRAVITY: f64 = 9.81;
/// The usual spacing, and half of the base area of a usual sleeper.
const SPACING: f64 = 0.6;
const HALF_BASE: f64 = 0.39;

/// A value far below the upper end of a range from zero more likely has a greater unit.
const SMALL: f64 = 1e-4;

impl Measure {
    /// A value in SI, converted to the unit of the range.
    fn shown(&self, value: f64, basis: Option<&str>) -> f64 {
        let unit = parse_unit(self.unit).map_or(1.0, |u| u.factor);
        let of = self.basis.map_or(1.0, |b| {
            let written = basis.or(b.assumed).and_then(|name| b.factor(name));
            written.unwrap_or(b.names[0].1) / b.names[0].1
        });
        value * of / unit
    }

    /// Whether a value in SI lies in the range, with some rounding.
    fn takes(&self, value: f64, basis: Option<&str>) -> bool {
        let shown = self.shown(value, basis);
        let slack = 1e-9 * shown.abs();
        (self.min - slack..=self.max + slack).contains(&shown)
    }

    /// Whether a value in SI is a usual value here.
    fn likely(&self, value: f64, basis: Option<&str>) -> bool {
        let shown = self.shown(value, basis);
        self.takes(value, basis) && (self.min != 0.0 || shown == 0.0 || shown >= SMALL * self.max)
    }

    /// Its own unit, and the others in which its quantity is written.
    fn units(&self) -> impl Iterator<Item = &'static str> {
        std::iter::once(self.unit).chain(usual_units(Dimension::of_unit(self.unit)).iter().copied())
    }

    /// The most usual unit in which all these numbers lie in the range.
    fn legal_unit(&self, values: &[f64], basis: Option<&str>) -> Option<&'static str> {
        let size = |unit: &str| parse_unit(unit).map_or(1.0, |u| u.factor);
        let fits = |unit: &&str| values.iter().all(|v| self.likely(v * size(unit), basis));
        let lies = |unit: &&str| values.iter().all(|v| self.takes(v * size(unit), basis));
        self.units().find(fits).or_else(|| self.units().find(lies))
    }
}

/// Help for numbers without a unit, as they are in the text.
pub fn with_unit(text: &str, values: &[f64], measures: &[&Measure], basis: Option<&str>) -> Help {
    let legal = measures.iter().filter_map(|m| Some((Dimension::of_unit(m.unit), m.legal_unit(values, basis)?)));
    let mut legal: Vec<(Dimension, &str)> = legal.collect();
    // a length may also be counted in sleepers; otherwise the first unit is the usual one
    if !legal.iter().any(|(dimension, _)| *dimension == Dimension::SLEEPERS) {
        legal.truncate(1);
    }
    if let [only] = measures
        && Dimension::of_unit(only.unit) == Dimension::of_unit("kN s/m")
        && values.iter().all(|v| v.abs() < 1.0)
    {
        return Help::say(RATIO);
    }
    if !legal.is_empty() {
        let written: Vec<String> = legal.iter().map(|(_, unit)| format!("{text} {unit}")).collect();
        return Help::write_one_of(written).and(", if that is the unit you meant");
    }
    let (measure, unit) = (measures[0], measures[0].unit);
    // `density = 20`: the weight of a cubic metre in kN
    if let [value] = values
        && Dimension::of_unit(unit) == Dimension::of_unit("kg/m^3")
        && measure.takes(value * 1e3 / GRAVITY, basis)
    {
        let mass = four_digits(value * 1e3 / GRAVITY);
        let why = format!(", if `{text}` is a weight in kN/m^3: divided by {GRAVITY} m/s^2");
        return Help::write(format!("{mass} {unit}")).and(&why);
    }
    Help::say(format!("its unit is `{unit}`, its range {} .. {} {unit}", number(measure.min), number(measure.max)))
}

/// Help for a dashpot that is given as a share.
const RATIO: &str = "a dashpot is given in `kN s/m`, not as a damping ratio: `damping = 5 kN s/m`, \
                     or as a time, damping / stiffness: `damping_time = 0.125 ms`";

/// Help for a value of another dimension, if there is a conversion.
pub fn of_other_dimension(measure: &Measure, raw: &Raw, text: &str) -> Option<Help> {
    let basis = raw.basis_name();
    let per = basis.filter(|b| measure.basis.is_some_and(|m| m.factor(b).is_some()));
    let per = per.map_or(String::new(), |name| format!(" per {name}"));
    let expected = Dimension::of_unit(measure.unit);
    if let Some((factor, power, why)) = conversion(expected, raw.dimension) {
        let value = factor * raw.value.powi(power);
        if let Some(written) = in_own_unit(measure, value, basis) {
            return Some(Help::write(format!("{written}{per}")).and(&format!(": {why}")));
        }
    }
    if let Some(help) = special(measure, raw, &per) {
        return Some(help);
    }
    let same = same_number(measure, raw, text);
    same.map(|written| Help::write(format!("{written}{per}")).and(", if that is what you meant"))
}

/// The same for both ends of a range.
pub fn ends_of_other_dimension(measure: &Measure, a: &Raw, b: &Raw) -> Option<Help> {
    let expected = Dimension::of_unit(measure.unit);
    let (factor, power, why) = conversion(expected, b.dimension).filter(|(_, power, _)| *power == 1)?;
    let unit = parse_unit(measure.unit).ok()?.factor;
    let ends = [a, b].map(|end| factor * end.value.powi(power));
    let [from, to] = ends.map(|value| four_digits(value / unit));
    let basis = b.basis_name();
    ends.iter()
        .all(|value| measure.takes(*value, basis))
        .then(|| Help::write(format!("{from} .. {to} {}", measure.unit)).and(&format!(": {why}")))
}

/// A value in SI in the unit of the field, else in another usual unit; nothing if it is out of range.
fn in_own_unit(measure: &Measure, value: f64, basis: Option<&str>) -> Option<String> {
    if !measure.takes(value, basis) {
        return None;
    }
    let unit = parse_unit(measure.unit).ok()?.factor;
    Some(format!("{} {}", four_digits(value / unit), measure.unit).trim_end().to_owned())
}

/// Conversion from the found quantity to the expected quantity: a factor, the power of the value, and the reason.
fn conversion(expected: Dimension, found: Dimension) -> Option<(f64, i32, &'static str)> {
    let gravity = Dimension::of_unit("m/s^2");
    let turn = std::f64::consts::TAU;
    if found == expected * gravity {
        return Some((1.0 / GRAVITY, 1, "a weight divided by 9.81 m/s^2 is a mass"));
    }
    if expected == found * gravity {
        return Some((GRAVITY, 1, "a mass times 9.81 m/s^2 is a weight"));
    }
    if found * expected == Dimension::NONE && !found.is_none() {
        return Some((1.0, -1, "the reciprocal of this value"));
    }
    let frequency = Dimension::of_unit("Hz");
    if expected == frequency && found == Dimension::of_unit("rad/s") {
        return Some((1.0 / turn, 1, "an angular frequency divided by 2 pi"));
    }
    if expected == frequency && found == Dimension::of_unit("cycles/s") {
        return Some((1.0, 1, "a frequency has no count"));
    }
    if expected == Dimension::LENGTH && found == Dimension::of_unit("sleepers/m") {
        return Some((1.0, -1, "one divided by the number of sleepers in a length"));
    }
    None
}

/// Pairs of quantities that are often confused, each with its own help.
fn special(measure: &Measure, raw: &Raw, per: &str) -> Option<Help> {
    let (expected, found) = (Dimension::of_unit(measure.unit), raw.dimension);
    let of = |unit: &str| Dimension::of_unit(unit);
    let (stiffness, bedding, pressure) = (of("MN/m"), of("N/mm^3"), of("MPa"));
    let offered = |value: f64| in_own_unit(measure, value, raw.basis_name()).map(|text| format!("{text}{per}"));
    let offer = |why: &str, place: String, text: Option<String>| match text {
        Some(text) => Help { said: format!("{why}; for {place} this is `{text}`"), writes: vec![text] },
        None => Help::say(why),
    };
    if expected == stiffness && found == pressure && measure.basis.is_some() {
        let why = "this value is per metre of rail: multiply it by the spacing for one seat";
        return Some(offer(why, format!("{SPACING} m"), offered(raw.value * SPACING)));
    }
    if expected == stiffness && found == bedding {
        let why = "this value is per area: multiply it by half of the sleeper's base area for one seat";
        let text = offered(raw.value * HALF_BASE).filter(|_| measure.basis.is_some());
        return Some(offer(why, format!("{HALF_BASE} m^2"), text));
    }
    if expected == bedding && found == stiffness {
        let why = "a bedding modulus is a stiffness per area: divide it by half of the sleeper's base area";
        return Some(Help::say(why));
    }
    let angle = found == Dimension::ANGLE && expected.is_none() && measure.unit.is_empty();
    if angle && measure.takes(raw.value.tan(), None) {
        let tangent = Help::write(four_digits(raw.value.tan()));
        return Some(tangent.and(": a coefficient of friction is the tangent of its angle"));
    }
    if found.is_none() {
        let slope = expected == Dimension::LENGTH && measure.varies == crate::schema::Varies::Yes;
        return match () {
            () if expected == of("kN s/m") => Some(Help::say(RATIO)),
            () if expected == of("ms") && measure.unit == "ms" => {
                Some(Help::say("the field is a time, damping / stiffness: 5 kN s/m with 40 MN/m gives `0.125 ms`"))
            }
            () if slope => Some(Help::say("a slope is written as a ramp: `ramp(0 .. 20 mm, over = -10 .. 0 m)`")),
            () => None,
        };
    }
    if expected.is_none() && measure.unit == "%" && found == Dimension::LENGTH {
        return Some(Help::say("a share is given in `%`: the length divided by the whole"));
    }
    if expected == Dimension::TIME && [Dimension::AXLES, Dimension::CYCLES].contains(&found) {
        let why = "an interval of samples is a time; counts of traffic are a list: `after = [100, 200] axles`";
        return Some(Help::say(why));
    }
    if expected == Dimension::AXLES && found == Dimension::TIME {
        return Some(Help::say("traffic is counted in `axles` or as the mass carried, `MGT`, not by time"));
    }
    None
}

/// The number as written, in a unit of the expected quantity that begins alike: `40 kN/mm` for `40 kN`.
fn same_number(measure: &Measure, raw: &Raw, text: &str) -> Option<String> {
    let expected = Dimension::of_unit(measure.unit);
    let (digits, unit) = literal(text)?;
    let value: f64 = digits.replace('_', "").parse().ok()?;
    let size = |unit: &str| parse_unit(unit).ok().filter(|u| u.dimension == expected).map(|u| u.factor);
    let fits = |unit: &str| size(unit).is_some_and(|factor| measure.takes(value * factor, raw.basis_name()));
    let closed: String = unit.split(' ').collect();
    // `40 MN per m`, `600 m m`
    let mended = raw.basis_name().map(|name| format!("{unit}/{name}")).filter(|u| fits(u));
    if let Some(unit) = mended.or_else(|| Some(closed).filter(|u| fits(u))) {
        return Some(format!("{digits} {unit}"));
    }
    let symbol = |unit: &str| unit.chars().take_while(|c| c.is_alphabetic()).collect::<String>();
    let counts = [Dimension::AXLES, Dimension::CYCLES];
    let pressure = expected == Dimension::of_unit("N/mm^3") && raw.dimension == Dimension::of_unit("MPa");
    let alike = counts.contains(&expected) && counts.contains(&raw.dimension) || pressure;
    let begins = measure.units().find(|u| symbol(u) == symbol(unit) && fits(u));
    let own = || Some(measure.unit).filter(|u| alike && fits(u));
    begins.or_else(own).map(|unit| format!("{digits} {unit}"))
}

/// The digits and the unit of a number in the text.
fn literal(text: &str) -> Option<(&str, &str)> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "._+-".contains(c)))?;
    let rest = &text[end..];
    let exponent = rest.strip_prefix(['e', 'E']).map_or(0, |r| {
        let digits = r.trim_start_matches(['+', '-']);
        let length = digits.len() - digits.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        if length == 0 { 0 } else { 1 + r.len() - digits.len() + length }
    });
    let (digits, unit) = text.split_at(end + exponent);
    let unit = unit.trim();
    (!digits.is_empty() && parse_unit(unit).is_ok()).then_some((digits, unit))
}

/// The field that a value belongs to, if that field gives the same quantity as `field` in another way.
pub fn other_way(kind: &Kind, field: &str, raw: &Raw) -> Option<&'static str> {
    let ways = kind.alternatives.iter().filter(|a| a.ways.iter().any(|way| way.contains(&field)));
    let mut others = ways.flat_map(|a| a.ways.iter()).flat_map(|way| way.iter()).filter(|other| **other != field);
    let takes = |m: &Measure| Dimension::of_unit(m.unit) == raw.dimension && m.takes(raw.value, raw.basis_name());
    others.find(|other| kind.field(other).and_then(|f| f.form.measure()).is_some_and(takes)).copied()
}

/// A number with four significant digits.
fn four_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    number(rounded)
}

/// Help for an operand of a comparison with another dimension, in a usual unit.
pub fn in_comparison(expected: Dimension, raw: &Raw, text: &str, unit: &str) -> Option<Help> {
    let per = raw.basis_name().map_or(String::new(), |name| format!(" per {name}"));
    if raw.bare && raw.dimension.is_none() {
        return Some(Help::write(format!("{text} {unit}{per}")).and(", if that is the unit you meant"));
    }
    let (factor, power, why) = conversion(expected, raw.dimension)?;
    let size = parse_unit(unit).ok()?.factor;
    let value = four_digits(factor * raw.value.powi(power) / size);
    Some(Help::write(format!("{value} {unit}{per}")).and(&format!(": {why}")))
}
