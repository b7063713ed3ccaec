//! Times and shares as people read them, with two significant digits.

use super::number;

/// `8.7 s`, `86 s`, `12 min`, `3.4 h`
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 119.5 => format!("{} s", two_digits(s)),
        s if s < 7_170.0 => format!("{} min", two_digits(s / 60.0)),
        s => format!("{} h", two_digits(s / 3600.0)),
    }
}

/// `2.5 %` for 0.025
pub fn percent(share: f64) -> String {
    format!("{} %", two_digits(100.0 * share))
}

/// Whole numbers keep all of their digits.
fn two_digits(value: f64) -> String {
    if value.abs() >= 99.5 { number(value.round()) } else { number(format!("{value:.1e}").parse().unwrap_or(value)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_shares_have_two_digits() {
        let times = [0.0, 0.0123, 8.74, 86.4, 119.4, 119.6, 725.0, 7_169.0, 7_171.0, 36_400.0, 1e7];
        let expected =
            ["0 s", "0.012 s", "8.7 s", "86 s", "119 s", "2 min", "12 min", "119 min", "2 h", "10 h", "2778 h"];
        assert_eq!(times.map(duration), expected);
        assert_eq!([0.00021, 0.025, 0.48, 12.0].map(percent), ["0.021 %", "2.5 %", "48 %", "1200 %"]);
    }
}
