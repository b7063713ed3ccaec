//! A dimension as exponents of base dimensions, and the engineering names of common dimensions.

use super::parse::parse_unit;
use std::ops::{Div, Mul};

/// Base dimensions in the order in which units are written.
const BASES: [(&str, &str); 8] = [
    ("mass", "kg"),
    ("length", "m"),
    ("time", "s"),
    ("angle", "rad"),
    ("data", "B"),
    ("axles", "axles"),
    ("sleepers", "sleepers"),
    ("cycles", "cycles"),
];

/// Exponents in hundredths: wheel-rail contact needs `m^1.5`, settlement laws `kN^1.6`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Dimension([i16; 8]);

impl Dimension {
    pub const NONE: Dimension = Dimension([0; 8]);
    pub const MASS: Dimension = Dimension::base(0);
    pub const LENGTH: Dimension = Dimension::base(1);
    pub const TIME: Dimension = Dimension::base(2);
    pub const ANGLE: Dimension = Dimension::base(3);
    pub const DATA: Dimension = Dimension::base(4);
    pub const AXLES: Dimension = Dimension::base(5);
    pub const SLEEPERS: Dimension = Dimension::base(6);
    pub const CYCLES: Dimension = Dimension::base(7);
    pub const FORCE: Dimension = Dimension([100, 100, -200, 0, 0, 0, 0, 0]);

    const fn base(index: usize) -> Self {
        let mut exponents = [0; 8];
        exponents[index] = 100;
        Dimension(exponents)
    }

    /// The dimension of `unit`, which is written in the program.
    pub fn of_unit(unit: &str) -> Dimension {
        parse_unit(unit).map_or(Dimension::NONE, |u| u.dimension)
    }

    /// Raised to a power in hundredths; `None` if an exponent is outside -9 .. 9.
    pub fn power(self, hundredths: i32) -> Option<Dimension> {
        let mut out = [0; 8];
        for (o, e) in out.iter_mut().zip(self.0) {
            let product = i32::from(e) * hundredths;
            if product % 100 != 0 || product.abs() > 90_000 {
                return None;
            }
            *o = (product / 100) as i16;
        }
        Some(Dimension(out))
    }

    pub fn is_none(self) -> bool {
        self == Dimension::NONE
    }

    /// Name and exponent (in hundredths) of every base with a non-zero exponent.
    pub(super) fn factors(self) -> impl Iterator<Item = (&'static str, i16)> {
        BASES.iter().zip(self.0).filter(|(_, e)| *e != 0).map(|((name, _), e)| (*name, e))
    }

    /// Its engineering name, with a usual unit; `None` for a combination without a name.
    pub fn name(self) -> Option<&'static str> {
        NAMED.iter().find(|(_, unit)| Dimension::of_unit(unit) == self).map(|(name, _)| *name)
    }

    /// A unit in which a value of this dimension is usually written.
    pub fn usual_unit(self) -> String {
        NAMED
            .iter()
            .find(|(_, unit)| Dimension::of_unit(unit) == self)
            .map_or_else(|| self.si_unit(), |(_, u)| u.to_string())
    }

    /// `kg m^2/s^2`; empty for a plain number.
    pub fn si_unit(self) -> String {
        let factor = |(_, unit): (&str, &str), e: i16| match e {
            100 => unit.to_string(),
            e => format!("{unit}^{}", super::number(f64::from(e) / 100.0)),
        };
        let over: Vec<String> = BASES.iter().zip(self.0).filter(|(_, e)| *e > 0).map(|(b, e)| factor(*b, e)).collect();
        let under: Vec<String> =
            BASES.iter().zip(self.0).filter(|(_, e)| *e < 0).map(|(b, e)| factor(*b, -e)).collect();
        let over = if over.is_empty() && !under.is_empty() { "1".into() } else { over.join(" ") };
        if under.is_empty() { over } else { format!("{over}/{}", under.join("/")) }
    }

    /// `a stiffness`, else the SI unit as words for a sentence.
    pub fn describe(self) -> String {
        if self.is_none() {
            return "a plain number".into();
        }
        self.name().map_or_else(|| format!("a quantity in {}", self.si_unit()), str::to_string)
    }
}

/// Names of dimensions with a usual unit; the first name of a dimension is the one that is shown.
const NAMED: [(&str, &str); 27] = [
    ("a length", "m"),
    ("a mass", "kg"),
    ("a time", "s"),
    ("an angle", "deg"),
    ("an amount of data", "GiB"),
    ("a number of axles", "axles"),
    ("a number of sleepers", "sleepers"),
    ("a number of cycles", "cycles"),
    ("a force", "kN"),
    ("a moment", "kN m"),
    ("a stiffness", "MN/m"),
    ("a damping", "kN s/m"),
    ("a bending stiffness", "MN m^2"),
    ("a pressure or modulus", "MPa"),
    ("a bedding modulus", "N/mm^3"),
    ("a density", "kg/m^3"),
    ("a mass per length", "kg/m"),
    ("a moment of inertia of mass", "kg m^2"),
    ("an area", "cm^2"),
    ("a volume", "m^3"),
    ("a second moment of area", "cm^4"),
    ("a speed", "km/h"),
    ("an acceleration", "m/s^2"),
    ("a frequency", "Hz"),
    ("a Hertz constant", "GN/m^1.5"),
    ("a number per length", "1/m"),
    ("a power", "N m/s"),
];

impl Mul for Dimension {
    type Output = Dimension;
    fn mul(self, other: Dimension) -> Dimension {
        let mut out = self.0;
        out.iter_mut().zip(other.0).for_each(|(a, b)| *a = a.saturating_add(b));
        Dimension(out)
    }
}

impl Div for Dimension {
    type Output = Dimension;
    fn div(self, other: Dimension) -> Dimension {
        let mut out = self.0;
        out.iter_mut().zip(other.0).for_each(|(a, b)| *a = a.saturating_sub(b));
        Dimension(out)
    }
}
