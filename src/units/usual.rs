//! The units in which engineers write a quantity, the most usual first. They are offered for a number without a unit,
//! or with the unit of a similar quantity.

use super::Dimension;

/// Units of one dimension a line.
const USUAL: [&[&str]; 17] = [
    &["m", "mm", "cm", "km", "µm"],
    &["kg", "t", "g"],
    &["s", "ms", "µs", "min", "h", "d"],
    &["kN", "N", "MN"],
    &["kN m", "N m", "MN m"],
    &["MN/m", "kN/mm", "kN/m", "N/m", "N/mm"],
    &["kN s/m", "N s/m", "MN s/m"],
    &["MN m^2", "kN m^2", "N m^2"],
    &["MPa", "GPa", "kPa", "Pa", "MN/m^2", "N/mm^2", "kN/m^2", "kN/mm^2"],
    &["N/mm^3", "MN/m^3", "kN/m^3"],
    &["kg/m^3", "t/m^3", "g/cm^3"],
    &["kg/m", "t/m"],
    &["kg m^2", "t m^2"],
    &["cm^2", "mm^2", "m^2"],
    &["cm^4", "mm^4", "m^4"],
    &["km/h", "m/s"],
    &["Hz", "kHz"],
];

/// The usual units of a dimension; none for a dimension with a single unit.
pub fn usual_units(dimension: Dimension) -> &'static [&'static str] {
    USUAL.iter().find(|units| Dimension::of_unit(units[0]) == dimension).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::parse_unit;

    #[test]
    fn units_of_a_line_are_of_one_dimension() {
        for units in USUAL {
            for unit in units {
                assert_eq!(parse_unit(unit).unwrap().dimension, Dimension::of_unit(units[0]), "{unit}");
            }
        }
    }
}
