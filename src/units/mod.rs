//! Dimensions, units and quantities: the meaning of `40 MN/m`, and messages on a wrong dimension.
//!
//! All arithmetic is in SI. A count (axles, sleepers, cycles), an angle and an amount of data are dimensions of their
//! own, so that none of them is taken as a plain number.

mod compare;
mod dimension;
mod foreign;
mod parse;
mod usual;
mod words;

pub use compare::compare;
pub use dimension::Dimension;
pub use parse::{Unit, UnitError, parse_unit};
pub use usual::usual_units;
pub use words::{duration, percent};

/// A number in SI units with its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    pub value: f64,
    pub dimension: Dimension,
}

impl Quantity {
    pub fn new(value: f64, dimension: Dimension) -> Self {
        Quantity { value, dimension }
    }

    /// The value and a unit as text: `unit` if it fits, else SI.
    pub fn show(self, unit: &str) -> String {
        match parse_unit(unit) {
            Ok(u) if u.dimension == self.dimension => join(self.value / u.factor, unit),
            _ => join(self.value, &self.dimension.si_unit()),
        }
    }
}

fn join(value: f64, unit: &str) -> String {
    if unit.is_empty() { number(value) } else { format!("{} {unit}", number(value)) }
}

/// A number with at most six significant digits and no trailing zeros.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { value.to_string() };
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..15).contains(&magnitude) {
        let text = format!("{value:.5e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trim(mantissa));
    }
    trim(&format!("{value:.*}", (5 - magnitude).max(0) as usize)).to_string()
}

/// A positive value with two digits, never more than the value.
pub fn rounded_down(value: f64) -> f64 {
    let size = 10f64.powf(1.0 - value.log10().floor());
    (value * size).floor() / size
}

fn trim(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        for (value, text) in [(0.1, "0.1"), (29.494, "29.494"), (1.3e7, "13000000"), (2e-5, "2e-5"), (-0.6, "-0.6")] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_quantity_shows_in_the_unit_asked_for() {
        let stiffness = parse_unit("MN/m").unwrap();
        assert_eq!(Quantity::new(40e6, stiffness.dimension).show("MN/m"), "40 MN/m");
        assert_eq!(Quantity::new(40e6, stiffness.dimension).show("kN"), "40000000 kg/s^2");
    }
}
