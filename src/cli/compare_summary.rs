//! What `trackbed compare` prints: what differs in the scenes, the numbers side by side, and where along the track they
//! part.

use super::terminal::aligned;
use crate::compare::{Column, Comparison, Difference, NumberRow, PointRow, is_named};
use crate::units::number;
use std::fmt::Write;

/// Lines of one table.
const MOST: usize = 40;
/// Characters of a value of a scene.
const WIDEST: usize = 36;

/// The whole summary.
pub(super) fn text(comparison: &Comparison) -> String {
    let mut text = String::new();
    for (index, subject) in comparison.subjects.iter().enumerate() {
        let first = if index == 0 { ", with which the others are compared" } else { "" };
        let _ = writeln!(text, "{}: {}{first}", subject.name, subject.made.title);
    }
    text += &scenes(comparison);
    text += &numbers(comparison);
    text += &seats(comparison);
    text += &points(comparison);
    text
}

/// The names of the results as the heads of a table.
fn heads(comparison: &Comparison, first: &str) -> Vec<String> {
    let names = comparison.subjects.iter().map(|subject| subject.name.clone());
    std::iter::once(first.to_owned()).chain(names).collect()
}

fn scenes(comparison: &Comparison) -> String {
    let Some(edits) = &comparison.edits else {
        return "\nan older version has kept no `resolved.track`: what differs in the scenes is not known\n".to_owned();
    };
    if edits.is_empty() {
        return "\nthe scenes are the same\n".to_owned();
    }
    let shown = |text: &Option<String>| text.as_deref().map_or("-".to_owned(), cut);
    let row = |edit: &crate::compare::Edit| {
        std::iter::once(edit.path.clone()).chain(edit.texts.iter().map(shown)).collect::<Vec<_>>()
    };
    let mut table = vec![heads(comparison, "in the scene")];
    table.extend(edits.iter().take(MOST).map(row));
    format!("\n{}{}", aligned(&table), and_more(edits.len(), "scenes.csv"))
}

fn and_more(count: usize, file: &str) -> String {
    match count.saturating_sub(MOST) {
        0 => String::new(),
        more => format!("  and {more} more, which `--out` writes to {file}\n"),
    }
}

fn cut(text: &str) -> String {
    match text.char_indices().nth(WIDEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

fn numbers(comparison: &Comparison) -> String {
    let rows: Vec<&NumberRow> = comparison.numbers.iter().filter(|row| is_named(row)).collect();
    if rows.is_empty() {
        return String::new();
    }
    let mut table = vec![heads(comparison, "")];
    table.extend(rows.into_iter().filter_map(number_cells));
    let intervals = comparison.numbers.iter().flat_map(|row| &row.values).flatten().any(|n| n.confidence.is_some());
    let note = if intervals { "  +- is half of a 95 % interval over packings\n" } else { "" };
    format!("\n{}{note}", aligned(&table))
}

/// `largest settlement [mm]   2.1   1.4 (-0.7, -33 %)`
fn number_cells(row: &NumberRow) -> Option<Vec<String>> {
    let label = row.label?;
    let unit = if label.unit.is_empty() { String::new() } else { format!(" [{}]", label.unit) };
    let mut cells = vec![format!("{}{unit}", label.text)];
    for value in &row.values {
        let Some(value) = value else {
            cells.push("-".to_owned());
            continue;
        };
        let mut text = three(value.value / label.size);
        if let Some(half) = value.confidence {
            let _ = write!(text, " +- {}", two(half / label.size));
        }
        if let Some(difference) = value.from_first.filter(|difference| difference.difference != 0.0) {
            let _ = write!(text, " ({})", differs(&difference, label.size));
        }
        cells.push(text);
    }
    Some(cells)
}

/// `-0.7, -33 %`, with the interval of the difference where there is one.
fn differs(difference: &Difference, size: f64) -> String {
    let signed = |text: String, value: f64| if value > 0.0 { format!("+{text}") } else { text };
    let mut text = signed(three(difference.difference / size), difference.difference);
    if let Some(half) = difference.confidence {
        let _ = write!(text, " +- {}", two(half / size));
    }
    match difference.share {
        Some(share) => text + &format!(", {} %", signed(two(share * 100.0), share)),
        None => text,
    }
}

fn three(value: f64) -> String {
    number(rounded(value, 3))
}

fn two(value: f64) -> String {
    number(rounded(value, 2))
}

/// So many digits, and whole numbers above.
fn rounded(value: f64, digits: usize) -> f64 {
    if value.abs() >= 10f64.powi(digits as i32) {
        return value.round();
    }
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// Where each run parts most from the first.
fn seats(comparison: &Comparison) -> String {
    let Some(any) = comparison.seats.first() else { return String::new() };
    let mut table = vec![
        ["", "largest difference", "at sleeper", "first", "this one", "root mean square"].map(str::to_owned).to_vec(),
    ];
    for row in comparison.seats.iter().filter(|row| row.difference != 0.0) {
        let Some(column) = Column::ALL.iter().find(|column| column.name == row.column) else { continue };
        let shown = |value: f64| three(value / column.size);
        table.push(vec![
            format!("{}: {} [{}]", comparison.subjects[row.run].name, column.text, column.unit),
            shown(row.difference),
            format!("{} ({} m)", row.sleeper, number(rounded(row.x_m, 4))),
            shown(row.first),
            shown(row.value),
            format!("{} over {} seats", shown(row.rms), row.seats),
        ]);
    }
    if table.len() == 1 {
        return format!("\nalong the track nothing differs after {} axles\n", any.axles);
    }
    format!("\nalong the track, after {} axles\n{}", any.axles, aligned(&table))
}

fn points(comparison: &Comparison) -> String {
    if comparison.points.is_empty() {
        return String::new();
    }
    let row = |row: &PointRow| {
        let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
        let mut cells = vec![cut(&row.point), format!("{}{unit}", cut(&row.measured))];
        for (value, from_first) in row.values.iter().zip(&row.from_first) {
            let difference = from_first.filter(|difference| difference.difference != 0.0);
            let difference = difference.map_or(String::new(), |difference| format!(" ({})", differs(&difference, 1.0)));
            cells.push(value.map_or("-".to_owned(), |value| format!("{}{difference}", three(value))));
        }
        cells
    };
    let mut table = vec![heads(comparison, "point")];
    table[0].insert(1, "measured".to_owned());
    table.extend(comparison.points.iter().take(MOST).map(row));
    let mut text = format!("\n{}{}", aligned(&table), and_more(comparison.points.len(), "points.csv"));
    for subject in &comparison.subjects {
        for lines in subject.study().iter().flat_map(|study| study.best.first()) {
            let _ = writeln!(text, "  best of {}: {}", subject.name, lines.join(", "));
        }
    }
    text
}
