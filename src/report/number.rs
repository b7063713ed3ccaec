//! Numbers for readers: round ticks, few digits, engineering units.

/// Round steps that cut `low .. high` into about `count` pieces: multiples of 1, 2 or 5 times a power of ten.
pub fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let span = high - low;
    if !span.is_finite() || span <= 0.0 {
        return vec![];
    }
    let step = nice_step(span / count.max(1) as f64);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The smallest round step not below `raw`.
pub fn nice_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0].into_iter().find(|step| step * power >= raw * (1.0 - 1e-9));
    step.unwrap_or(10.0) * power
}

/// A tick's label with as many decimals as the step between ticks needs.
pub fn tick_label(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    fixed(value, decimals)
}

/// About `digits` significant digits, thousands apart, no exponent for numbers that fit a line.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-6.0..9.0).contains(&magnitude) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    fixed(value, (digits as f64 - 1.0 - magnitude).clamp(0.0, 9.0) as usize)
}

/// The number as [`significant`] writes it, without zeros behind the point: for numbers that a user chose, for example
/// a spacing of 0.6 m.
pub fn plain(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    if text.contains('.') && !text.contains('e') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

/// A whole number with its thousands apart.
pub fn whole(value: u64) -> String {
    grouped(&value.to_string())
}

fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{:.*}", decimals, value.abs());
    let sign = if value < 0.0 && text.bytes().any(|b| b.is_ascii_digit() && b != b'0') { "\u{2212}" } else { "" };
    let (head, tail) = text.split_once('.').unwrap_or((&text, ""));
    let point = if tail.is_empty() { "" } else { "." };
    format!("{sign}{}{point}{tail}", grouped(head))
}

/// Thin spaces between thousands of numbers of five and more digits.
fn grouped(digits: &str) -> String {
    if digits.len() < 5 {
        return digits.to_owned();
    }
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

/// The unit in which an SI quantity is shown, and its size in SI.
pub fn shown_unit(si: &str) -> (&'static str, f64) {
    match si {
        "N" => ("kN", 1e3),
        "N m" => ("kN m", 1e3),
        "m" => ("mm", 1e-3),
        "N/m" => ("MN/m", 1e6),
        "Pa" => ("kPa", 1e3),
        "Pa stress" => ("MPa", 1e6), // in steel
        "s" => ("s", 1.0),
        "m/s" => ("mm/s", 1e-3),
        "m/s^2" => ("m/s\u{b2}", 1.0),
        _ => ("", 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(ticks(0.0, 1.0, 5), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(ticks(-42.0, 24.0, 8), [-40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0]);
        assert_eq!(ticks(91.0, 131.0, 5), [100.0, 110.0, 120.0, 130.0]);
        assert!(ticks(1.0, 1.0, 5).is_empty());
        assert!(ticks(0.0, f64::NAN, 5).is_empty());
        assert_eq!(tick_label(0.6000000000000001, 0.2), "0.6");
        assert_eq!(tick_label(-40.0, 10.0), "\u{2212}40");
        assert_eq!(tick_label(-1e-17, 0.5), "0.0");
    }

    #[test]
    fn digits_are_sensible() {
        assert_eq!(significant(98_066.5, 3), "98\u{2009}066");
        assert_eq!(significant(1.23456, 3), "1.23");
        assert_eq!(significant(-0.012345, 3), "\u{2212}0.0123");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(1.5e12, 3), "1.50e12");
        assert_eq!(significant(f64::NAN, 3), "\u{2013}");
        assert_eq!((plain(0.6, 3), plain(40.0, 3), plain(-2.5, 4)), ("0.6".into(), "40".into(), "\u{2212}2.5".into()));
        assert_eq!(whole(1_234_567), "1\u{2009}234\u{2009}567");
    }
}
