//! Points of a study as rows, each with its difference to the scene as it is.

use crate::report::number::plain;
use crate::report::prose::prose;
use crate::report::svg::escape;
use crate::study::{Answer, PointOutcome, Row};
use std::fmt::Write;

/// A value with more characters may take several lines, so that the columns behind it stay on the page.
const LONG: usize = 24;

/// Writes these rows; `whole` adds the status of each row.
pub(super) fn table(html: &mut String, answer: &Answer, rows: &[usize], whole: bool) {
    let study = &answer.study;
    let measured = study.measured();
    *html += "<div class=\"scroll\"><table><tr><th>point</th>";
    let head = |html: &mut String, name: &str, unit: &str| {
        let unit = if unit.is_empty() { String::new() } else { format!("<small>{}</small>", escape(unit)) };
        let _ = write!(html, "<th>{}{unit}</th>", breakable(name));
    };
    study.axes.iter().for_each(|axis| head(html, &axis.path, &axis.unit));
    measured.iter().for_each(|m| head(html, &m.text, &m.unit.0));
    let counted = study.repeats.are_open();
    if counted {
        *html += "<th>packings</th>";
    }
    if whole {
        *html += "<th class=\"text\">status</th>";
    }
    *html += "</tr>";
    let best = answer.best();
    for index in rows {
        let row = &answer.rows[*index];
        let _ = write!(html, "<tr><td>{}</td>", name(row));
        for level in &row.levels {
            let text = level.number.map_or(level.text.clone(), |n| plain(n, 6));
            let class = if text.chars().count() > LONG { " class=\"long\"" } else { "" };
            let _ = write!(html, "<td{class}>{}</td>", escape(&text));
        }
        (0..measured.len()).for_each(|m| {
            let _ = write!(html, "<td>{}</td>", cell(answer, row, m));
        });
        if counted {
            let _ = write!(html, "<td>{}</td>", row.packings());
        }
        if whole {
            let (class, words) = status(answer, row, best.contains(index));
            let _ = write!(html, "<td class=\"text {class}\">{}</td>", prose(&words));
        }
        *html += "</tr>";
    }
    *html += "</table></div>";
}

/// `as it is`, with its number where a point of the design is the same.
fn name(row: &Row) -> String {
    match (row.as_it_is, row.number) {
        (true, 0) => "<b>as it is</b>".to_owned(),
        (true, number) => format!("<b>as it is</b> <small>point {number}</small>"),
        (false, number) => number.to_string(),
    }
}

/// A value in its unit, with its scatter and its difference to the scene as it is.
fn cell(answer: &Answer, row: &Row, index: usize) -> String {
    let m = answer.study.measured()[index];
    let PointOutcome::Done { values, deviations, .. } = &row.outcome else { return "\u{2013}".to_owned() };
    let spread = plain(deviations[index] / m.unit.1, 2);
    let spread = if answer.study.repeats.are_several() { format!(" \u{b1} {spread}") } else { String::new() };
    let difference = answer.difference(row, index).map(|difference| {
        let text = difference.text(m).replace("+-", "\u{b1}").replace('-', "\u{2212}").replace(' ', "\u{a0}");
        // an interval needs a line of its own
        let line = if difference.half.is_some() { "<br>" } else { " " };
        format!("{line}<small>{}</small>", escape(&text))
    });
    plain(values[index] / m.unit.1, 4) + &spread + &difference.unwrap_or_default()
}

/// A name that a narrow column may break behind its joints.
fn breakable(name: &str) -> String {
    ['_', '.', '('].iter().fold(escape(name), |text, joint| text.replace(*joint, &format!("{joint}<wbr>")))
}

fn status(answer: &Answer, row: &Row, best: bool) -> (&'static str, String) {
    match &row.outcome {
        PointOutcome::Failed { reason, .. } => ("bad", format!("\u{2717} failed: {reason}")),
        PointOutcome::Done { .. } if !row.feasible() => ("", format!("misses {}", answer.missed(row).join(", "))),
        PointOutcome::Done { .. } if best => ("good", "\u{2713}\u{a0}best".to_owned()),
        PointOutcome::Done { .. } => ("", String::new()),
    }
}
