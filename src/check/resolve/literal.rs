//! Numbers as literals that read back to the same bits.

use crate::check::evaluate::number::Number;
use crate::scenario::Origin;
use crate::schema::Form;
use crate::units::{Dimension, parse_unit};

/// A number and its unit, apart: the first end of a range takes the unit of the second.
pub(super) struct Literal {
    pub digits: String,
    pub unit: String,
}

impl Literal {
    /// The shortest literal in the unit of a form that reads back to the same bits, else a literal in SI.
    pub fn new(number: Number, form: &Form) -> Literal {
        let usual = number.dimension.usual_unit();
        let si = number.dimension.si_unit();
        let units = unit_in(form, number.dimension).into_iter().chain([usual.as_str(), si.as_str()]);
        let usable = units.filter(|unit| number.dimension == Dimension::of_unit(unit));
        for unit in usable {
            let factor = parse_unit(unit).map_or(1.0, |u| u.factor);
            if let Some(digits) = shortest(number.value, factor) {
                return Literal { digits, unit: unit.to_string() };
            }
        }
        Literal { digits: plain(number.value), unit: si }
    }

    pub fn text(&self) -> String {
        if self.unit.is_empty() { self.digits.clone() } else { format!("{} {}", self.digits, self.unit) }
    }
}

/// `40 MN/m per seat`
pub(in crate::check) fn number(number: Number, form: &Form) -> String {
    format!("{}{}", Literal::new(number, form).text(), per(number))
}

/// `-20 .. -1 sleepers`, `5 .. 60 kN per sleeper`
pub(super) fn range(from: Number, to: Number, form: &Form) -> String {
    let (a, b) = (Literal::new(from, form), Literal::new(to, form));
    let first = if a.unit == b.unit { a.digits } else { a.text() };
    format!("{first} .. {}{}", b.text(), per(to))
}

fn per(number: Number) -> String {
    number.basis.map_or(String::new(), |basis| format!(" per {basis}"))
}

/// The unit that a form has for a dimension.
fn unit_in(form: &Form, dimension: Dimension) -> Option<&'static str> {
    match form {
        Form::Number(m) | Form::Interval(m) => Some(m.unit).filter(|unit| Dimension::of_unit(unit) == dimension),
        Form::OneOf(forms) => forms.iter().find_map(|form| unit_in(form, dimension)),
        Form::List(item) => unit_in(item, dimension),
        _ => None,
    }
}

/// The decimal with the fewest digits that, times a factor, is the value.
fn shortest(value: f64, factor: f64) -> Option<String> {
    let quotient = value / factor;
    let rounded = (0..17).map(|digits| format!("{quotient:.digits$e}"));
    let near = [quotient.next_up(), quotient.next_down()].map(|x| format!("{x:e}"));
    let exact = |text: &String| text.parse::<f64>().is_ok_and(|x| x * factor == value);
    rounded.chain(near).find(exact).and_then(|text| text.parse().ok()).map(plain)
}

/// Every digit of a number, as the language writes it.
pub(super) fn plain(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e9).contains(&size) { value.to_string() } else { format!("{value:e}") }
}

/// The origin of a value, for the end of its line.
pub(super) fn origin(origin: Origin, place: impl Fn(crate::diag::Span) -> String) -> String {
    match origin {
        Origin::Written(span) | Origin::Library(span) => place(span),
        Origin::Default => "default".into(),
        Origin::Derived => "derived".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn literals_are_the_ones_that_people_write() {
        for (digits, factor) in [(0.6, 1.0), (300.0, 1e-3), (40.0, 1e6), (0.207, 1e9), (200.0, 1.0 / 3.6), (12.5, 1e-6)]
        {
            assert_eq!(shortest(digits * factor, factor), Some(digits.to_string()));
        }
        assert_eq!((plain(-0.0001), plain(1e-7), plain(1e9)), ("-0.0001".into(), "1e-7".into(), "1e9".into()));
    }

    proptest! {
        #[test]
        fn a_literal_reads_back_to_the_same_bits(value in -1e12..1e12f64, unit in prop::sample::select(vec![
            "m", "mm", "km/h", "MN/m", "kN s/m", "N/mm^3", "%", "deg", "GN/m^1.5", "axles", "MGT", "cm^4",
        ])) {
            let dimension = Dimension::of_unit(unit);
            let number = Number { value, dimension, basis: None, factor: 1.0 };
            let literal = Literal::new(number, &Form::Text);
            let factor = parse_unit(&literal.unit).map_or(1.0, |u| u.factor);
            prop_assert_eq!(literal.digits.parse::<f64>().unwrap() * factor, value);
            let form = Form::Number(crate::schema::Measure {
                unit, min: 0.0, max: 1.0, basis: None, varies: crate::schema::Varies::No,
            });
            let literal = Literal::new(number, &form);
            let factor = parse_unit(&literal.unit).map_or(1.0, |u| u.factor);
            prop_assert_eq!(literal.digits.parse::<f64>().unwrap() * factor, value);
        }
    }
}
