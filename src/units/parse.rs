//! Reads a unit: `kN s/m`, `N/mm^3`, `GN/m^1.5`, `J/(kg m)`.
//!
//! Factors are joined by a blank, `*` or `·`; `/` divides by the next factor only.

use super::Dimension;
use super::foreign::ours;

/// A unit: its size in SI and its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    pub factor: f64,
    pub dimension: Dimension,
}

/// The reason why a text is not a unit.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitError {
    /// `symbol` is not known; `instead` is the probable unit.
    Unknown { symbol: String, instead: Option<String> },
    /// An exponent beyond -9 .. 9, or one that is not a hundredth.
    Exponent,
    /// Not of the form of a unit.
    Form,
}

/// Units that take the prefixes G M k c m µ.
const PREFIXED: [(&str, f64, Dimension); 9] = [
    ("m", 1.0, Dimension::LENGTH),
    ("g", 1e-3, Dimension::MASS),
    ("s", 1.0, Dimension::TIME),
    ("N", 1.0, Dimension::FORCE),
    ("Pa", 1.0, Dimension::NONE), // its dimension is a combination, see `symbol`
    ("J", 1.0, Dimension::NONE),
    ("Hz", 1.0, Dimension::NONE),
    ("B", 1.0, Dimension::DATA),
    ("rad", 1.0, Dimension::ANGLE),
];

const PREFIXES: [(&str, f64); 7] =
    [("G", 1e9), ("M", 1e6), ("k", 1e3), ("c", 1e-2), ("m", 1e-3), ("µ", 1e-6), ("u", 1e-6)];

const PLAIN: [(&str, f64, Dimension); 16] = [
    ("t", 1e3, Dimension::MASS),
    ("kt", 1e6, Dimension::MASS),
    ("MGT", 1e9, Dimension::MASS),
    ("h", 3600.0, Dimension::TIME),
    ("min", 60.0, Dimension::TIME),
    ("d", 86_400.0, Dimension::TIME),
    ("deg", std::f64::consts::PI / 180.0, Dimension::ANGLE),
    ("%", 1e-2, Dimension::NONE),
    ("‰", 1e-3, Dimension::NONE),
    ("GiB", 1_073_741_824.0, Dimension::DATA),
    ("MiB", 1_048_576.0, Dimension::DATA),
    ("axles", 1.0, Dimension::AXLES),
    ("axle", 1.0, Dimension::AXLES),
    ("sleepers", 1.0, Dimension::SLEEPERS),
    ("sleeper", 1.0, Dimension::SLEEPERS),
    ("cycles", 1.0, Dimension::CYCLES),
];

/// Reads a unit. The empty text is the unit of a plain number.
pub fn parse_unit(text: &str) -> Result<Unit, UnitError> {
    let mut reader = Reader { rest: text.trim(), depth: 0 };
    let unit = if reader.rest.is_empty() { ONE } else { reader.product()? };
    if reader.rest.is_empty() { Ok(unit) } else { Err(UnitError::Form) }
}

const ONE: Unit = Unit { factor: 1.0, dimension: Dimension::NONE };

struct Reader<'a> {
    rest: &'a str,
    depth: u32,
}

impl Reader<'_> {
    fn product(&mut self) -> Result<Unit, UnitError> {
        let mut unit = self.power()?;
        loop {
            let blanks = self.rest.len() - self.rest.trim_start_matches([' ', '\t']).len();
            let after = &self.rest[blanks..];
            let (divide, skip) = match after.chars().next() {
                Some('/') => (true, 1),
                Some('*') => (false, 1),
                Some('·') => (false, '·'.len_utf8()),
                Some(c) if c != ')' && blanks > 0 => (false, 0),
                _ => break,
            };
            self.rest = after[skip..].trim_start_matches([' ', '\t']);
            let next = self.power()?;
            unit = if divide {
                Unit { factor: unit.factor / next.factor, dimension: unit.dimension / next.dimension }
            } else {
                Unit { factor: unit.factor * next.factor, dimension: unit.dimension * next.dimension }
            };
        }
        Ok(unit)
    }

    /// A symbol or a product in parentheses, with its exponent.
    fn power(&mut self) -> Result<Unit, UnitError> {
        let base = if let Some(rest) = self.rest.strip_prefix('(') {
            self.depth += 1;
            if self.depth > 16 {
                return Err(UnitError::Form);
            }
            self.rest = rest.trim_start();
            let inner = self.product()?;
            self.rest = self.rest.trim_start().strip_prefix(')').ok_or(UnitError::Form)?;
            self.depth -= 1;
            inner
        } else {
            let end = self.rest.find(|c: char| !(c.is_alphabetic() || c == '%' || c == '‰')).unwrap_or(self.rest.len());
            let (name, rest) = self.rest.split_at(end);
            if name.is_empty() {
                // `1/m` is written by the program itself, never read from a file
                self.rest = self.rest.strip_prefix('1').ok_or(UnitError::Form)?;
                ONE
            } else {
                let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
                if digits > 0 {
                    let instead = Some(format!("{name}^{}", &rest[..digits]));
                    return Err(UnitError::Unknown { symbol: format!("{name}{}", &rest[..digits]), instead });
                }
                self.rest = rest;
                symbol(name)?
            }
        };
        let hundredths = self.exponent()?;
        let dimension = base.dimension.power(hundredths).ok_or(UnitError::Exponent)?;
        Ok(Unit { factor: base.factor.powf(f64::from(hundredths) / 100.0), dimension })
    }

    /// `^2`, `^-1`, `^1.5`, `²` or `³`, in hundredths; 100 without an exponent.
    fn exponent(&mut self) -> Result<i32, UnitError> {
        for (mark, hundredths) in [('²', 200), ('³', 300)] {
            if let Some(rest) = self.rest.strip_prefix(mark) {
                self.rest = rest;
                return Ok(hundredths);
            }
        }
        let Some(rest) = self.rest.strip_prefix('^') else { return Ok(100) };
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
        let (digits, rest) = rest.split_at(end);
        self.rest = rest;
        let value: f64 = digits.parse().map_err(|_| UnitError::Form)?;
        let hundredths = value * 100.0;
        if value.abs() > 9.0 || (hundredths - hundredths.round()).abs() > 1e-9 {
            return Err(UnitError::Exponent);
        }
        Ok(hundredths.round() as i32)
    }
}

fn symbol(name: &str) -> Result<Unit, UnitError> {
    known(name).ok_or_else(|| UnitError::Unknown { symbol: name.to_string(), instead: suggest(name) })
}

fn known(name: &str) -> Option<Unit> {
    if let Some(&(_, factor, dimension)) =
        PLAIN.iter().find(|(n, ..)| *n == name || (*n == "cycles" && name == "cycle"))
    {
        return Some(Unit { factor, dimension });
    }
    let base = |name: &str| {
        let &(unit, factor, dimension) = PREFIXED.iter().find(|(n, ..)| *n == name)?;
        let length = Dimension::LENGTH;
        let dimension = match unit {
            "Pa" => Dimension::FORCE / (length * length),
            "J" => Dimension::FORCE * length,
            "Hz" => Dimension::NONE / Dimension::TIME,
            _ => dimension,
        };
        Some(Unit { factor, dimension })
    };
    base(name).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, scale)| {
            let unit = base(name.strip_prefix(prefix)?)?;
            Some(Unit { factor: scale * unit.factor, ..unit })
        })
    })
}

/// The probable unit for an unknown symbol: a foreign spelling, two units without a blank, a wrong case of letters.
fn suggest(name: &str) -> Option<String> {
    if let Some(ours) = ours(name) {
        return Some(ours.to_string());
    }
    let lower = name.to_lowercase();
    let splits = name.char_indices().skip(1).map(|(i, _)| name.split_at(i));
    for (left, right) in splits {
        if known(left).is_some_and(|u| !u.dimension.is_none()) && known(right).is_some_and(|u| !u.dimension.is_none()) {
            return Some(format!("{left} {right}"));
        }
    }
    let prefixed = PREFIXED.iter().flat_map(|(unit, ..)| {
        PREFIXES.iter().map(move |(prefix, _)| format!("{prefix}{unit}")).chain([unit.to_string()])
    });
    let plain = PLAIN.iter().map(|(n, ..)| n.to_string());
    prefixed.chain(plain).find(|n| n.to_lowercase() == lower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn factor(text: &str) -> f64 {
        parse_unit(text).unwrap_or_else(|e| panic!("{text}: {e:?}")).factor
    }

    #[test]
    fn units_of_the_guide_have_their_size() {
        for (text, expected) in [
            ("MN/m", 1e6),
            ("kN s/m", 1e3),
            ("N/mm^3", 1e9),
            ("GN/m^1.5", 1e9),
            ("km/h", 1.0 / 3.6),
            ("cm^4", 1e-8),
            ("m²", 1.0),
            ("J/(kg m)", 1.0),
            ("MGT", 1e9),
            ("‰", 1e-3),
            ("kg m^2", 1.0),
            ("1/m", 1.0),
            ("µs", 1e-6),
        ] {
            assert!((factor(text) / expected - 1.0).abs() < 1e-12, "{text}");
        }
    }

    #[test]
    fn division_takes_the_next_factor_only() {
        assert_eq!(parse_unit("N/m s").unwrap().dimension, parse_unit("N s/m").unwrap().dimension);
        assert_eq!(parse_unit("N/(m s)").unwrap().dimension, parse_unit("N/m/s").unwrap().dimension);
    }

    #[test]
    fn foreign_spellings_get_ours() {
        for (text, ours) in [
            ("tonnes", "t"),
            ("hr", "h"),
            ("kNs", "kN s"),
            ("MNm", "MN m"),
            ("m2", "m^2"),
            ("KN", "kN"),
            ("inch", "mm (1 in = 25.4 mm)"),
        ] {
            match parse_unit(text) {
                Err(UnitError::Unknown { instead: Some(instead), .. }) => assert_eq!(instead, ours, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
    }

    #[test]
    fn a_mass_is_not_a_force() {
        assert_ne!(parse_unit("t").unwrap().dimension, parse_unit("kN").unwrap().dimension);
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in ".{0,40}") {
            let _ = parse_unit(&text);
        }

        #[test]
        fn a_product_has_the_product_of_the_sizes(a in "[GMkcm]?[msN]", b in "[GMkcm]?[msN]", n in 1i32..4) {
            let product = parse_unit(&format!("{a} {b}^{n}")).unwrap();
            let expected = factor(&a) * factor(&b).powi(n);
            prop_assert!((product.factor / expected - 1.0).abs() < 1e-12);
            let quotient = parse_unit(&format!("{a} {b}^{n}/{b}^{n}")).unwrap();
            prop_assert_eq!(quotient.dimension, parse_unit(&a).unwrap().dimension);
        }

        #[test]
        fn the_si_unit_of_a_dimension_reads_back(a in -3i32..4, b in -3i32..4, c in -3i32..4) {
            let d = Dimension::MASS.power(a * 100).unwrap() * Dimension::LENGTH.power(b * 100).unwrap()
                * Dimension::TIME.power(c * 100).unwrap();
            prop_assert_eq!(Dimension::of_unit(&d.si_unit()), d);
        }
    }
}
