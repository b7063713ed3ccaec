//! Text of a page: escaped, with text between backticks as code, and numbers in the shown unit.

use super::number::{plain, shown_unit};
use super::svg::escape;
use crate::results::Verdict;

/// Digits of a computed value in a sentence or a table.
const DIGITS: usize = 4;

/// A text as HTML. Text between two backticks becomes code; a single backtick is left out.
pub(super) fn prose(text: &str) -> String {
    let pieces: Vec<String> = text.split('`').map(escape).collect();
    let closed = |index: usize| index % 2 == 1 && index + 1 < pieces.len();
    let set = |(index, piece): (usize, &String)| match closed(index) {
        true => format!("<code>{piece}</code>"),
        false => piece.clone(),
    };
    pieces.iter().enumerate().map(set).collect()
}

/// A text without backticks, for a place that cannot show code.
pub(super) fn unmarked(text: &str) -> String {
    text.replace('`', "")
}

/// The computed values of an expectation, each in its shown unit: `1.264 mm and 1.758 mm`.
pub(super) fn computed(verdict: &Verdict) -> String {
    if let Some(problem) = &verdict.problem {
        return problem.clone();
    }
    let term = |value: &f64| {
        let (unit, size) = match (verdict.unit.as_str(), shown_unit(&verdict.unit)) {
            ("1", _) => ("", 1.0),
            (unit, ("", _)) => (unit, 1.0),
            (_, shown) => shown,
        };
        format!("{} {unit}", plain(value / size, DIGITS)).trim_end().to_owned()
    };
    let terms: Vec<String> = verdict.values.iter().map(term).collect();
    match terms.split_last() {
        Some((last, first)) if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => terms.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backticks_become_code() {
        assert_eq!(prose("a `b < c` d"), "a <code>b &lt; c</code> d");
        assert_eq!(prose("`a` and `b`"), "<code>a</code> and <code>b</code>");
        assert_eq!(prose("no code"), "no code");
        assert_eq!(prose("one ` alone & `two` more"), "one <code> alone &amp; </code>two more");
        assert_eq!(prose("at the end`"), "at the end");
        assert_eq!(unmarked("the bed of `open`"), "the bed of open");
    }

    #[test]
    fn what_was_computed_is_told_in_the_unit_of_reading() {
        let told = |values: &[f64], unit: &str| {
            let verdict = Verdict {
                text: String::new(),
                met: true,
                values: values.to_vec(),
                unit: unit.to_owned(),
                problem: None,
            };
            computed(&verdict)
        };
        assert_eq!(told(&[0.001264, 0.001758], "m"), "1.264 mm and 1.758 mm");
        assert_eq!(told(&[0.0, 81_234.5, 1e5], "N"), "0 kN, 81.23 kN and 100 kN");
        assert_eq!((told(&[1.25], "1"), told(&[20.0], "kN")), ("1.25".to_owned(), "20 kN".to_owned()));
    }
}
