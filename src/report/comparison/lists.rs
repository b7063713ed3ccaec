//! The tables of a comparison's page.

use crate::compare::{Column, Comparison, Difference, Edit, Kind, Number, NumberRow, PointRow};
use crate::report::number::{plain, shown_unit, significant};
use crate::report::svg::escape;
use crate::report::table::{TABLE_END, row, table_head};
use std::fmt::Write;

const END: &str = "</section>\n";

/// Differences between the scenes.
pub(super) fn edits(html: &mut String, comparison: &Comparison) {
    let caption = match comparison.edits.as_deref() {
        None => "Not known: an older version of the program did not store the whole scene.",
        Some([]) => "Nothing: the scenes are the same.",
        Some(_) => {
            "Values that differ between the scenes, under the names that --set takes. \u{2013}: the scene has no such \
            value."
        }
    };
    let Some(edits) = comparison.edits.as_deref().filter(|edits| !edits.is_empty()) else {
        let _ = write!(html, "<section><h2>Differences between the scenes</h2><p class=\"caption\">{caption}</p>{END}");
        return;
    };
    *html += &table_head("Differences between the scenes", caption, &heads(comparison, "value", false));
    for Edit { path, texts } in edits {
        let cells: Vec<String> = texts.iter().map(|text| text.clone().unwrap_or("\u{2013}".to_owned())).collect();
        row(html, path, &cells);
    }
    *html += TABLE_END;
    *html += END;
}

/// A column for each result, and one for the difference of each further one.
fn heads<'a>(comparison: &'a Comparison, first: &'a str, differences: bool) -> Vec<&'a str> {
    let mut heads = vec![first];
    for (index, subject) in comparison.subjects.iter().enumerate() {
        heads.push(&subject.name);
        if differences && index > 0 {
            heads.push("difference");
        }
    }
    heads
}

/// The most important scalars, then all others in a closed list.
pub(super) fn numbers(html: &mut String, comparison: &Comparison) {
    if comparison.numbers.is_empty() {
        return;
    }
    let over = comparison.numbers.iter().flat_map(|row| &row.values).flatten().any(|n| n.confidence.is_some());
    let caption = match over {
        true => "Means over packings with their 95 % intervals; a difference in bold is larger than its own interval.",
        false => "One packing each, or none: it is not known if a difference between beds is chance.",
    };
    let heads = heads(comparison, "", true);
    *html += &table_head("Numbers", if comparison.kind == Kind::Run && !over { "" } else { caption }, &heads);
    for number in comparison.numbers.iter().filter(|number| number.label.is_some()) {
        number_row(html, number);
    }
    *html += TABLE_END;
    *html += "<details><summary>All scalars</summary><div class=\"scroll\"><table class=\"wide\"><thead><tr>";
    for head in &heads {
        let _ = write!(html, "<th>{}</th>", escape(head));
    }
    *html += "</tr></thead><tbody>";
    for number in comparison.numbers.iter().filter(|number| number.label.is_none()) {
        number_row(html, number);
    }
    *html += TABLE_END;
    *html += "</details>";
    *html += END;
}

fn number_row(html: &mut String, of: &NumberRow) {
    let (text, unit, size) = match of.label {
        Some(label) => (label.text.trim_start(), label.unit, label.size),
        None => {
            let (unit, size) = shown_unit(&of.unit);
            (of.name.as_str(), unit, size)
        }
    };
    let title = if unit.is_empty() { text.to_owned() } else { format!("{text} [{unit}]") };
    let _ = write!(html, "<tr><td class=\"text\">{}</td>", escape(&title));
    for (index, value) in of.values.iter().enumerate() {
        let _ = write!(html, "<td>{}</td>", value.map_or("\u{2013}".to_owned(), |value| shown(&value, size)));
        if index > 0 {
            let from_first = value.and_then(|value| value.from_first);
            let _ = write!(html, "<td>{}</td>", from_first.map_or(String::new(), |from| differs(&from, size)));
        }
    }
    *html += "</tr>";
}

fn shown(number: &Number, size: f64) -> String {
    let band = number.confidence.map_or(String::new(), |half| format!(" \u{b1} {}", plain(half / size, 2)));
    format!("{}{band}", plain(number.value / size, 4))
}

/// `-0.7 (-33 %)`, in bold where it is larger than its own interval.
fn differs(difference: &Difference, size: f64) -> String {
    if difference.difference == 0.0 {
        return "0".to_owned();
    }
    let signed = |value: f64, digits: usize| {
        let sign = if value > 0.0 { "+" } else { "" };
        format!("{sign}{}", plain(value, digits))
    };
    let mut text = signed(difference.difference / size, 3);
    if let Some(half) = difference.confidence {
        let _ = write!(text, " \u{b1} {}", plain(half / size, 2));
    }
    if let Some(share) = difference.share {
        let _ = write!(text, " ({} %)", signed(share * 100.0, 2));
    }
    if difference.is_sure() == Some(true) { format!("<b>{text}</b>") } else { text }
}

/// The largest differences between runs along the track.
pub(super) fn seats(html: &mut String, comparison: &Comparison) {
    let Some(any) = comparison.seats.first() else { return };
    let caption = format!(
        "After {} axles, over the seats at the same chainage in both runs that whole trains pass: the largest \
         difference, its place, and the root mean square over all seats.",
        any.axles
    );
    let heads = ["", "difference", "at sleeper", "chainage [m]", "first", "this run", "root mean square", "seats"];
    *html += &table_head("Along the track", &caption, &heads);
    for seat in &comparison.seats {
        let Some(column) = Column::ALL.iter().find(|column| column.name == seat.column) else { continue };
        let value = |value: f64| significant(value / column.size, 3);
        let name = format!("{}: {} [{}]", comparison.subjects[seat.run].name, column.text, column.unit);
        let cells = [
            value(seat.difference),
            seat.sleeper.replace('-', "\u{2212}"),
            plain(seat.x_m, 4),
            value(seat.first),
            value(seat.value),
            value(seat.rms),
            seat.seats.to_string(),
        ];
        row(html, &name, &cells);
    }
    *html += TABLE_END;
    *html += END;
}

/// Points of studies.
pub(super) fn point_table(html: &mut String, comparison: &Comparison) {
    if comparison.points.is_empty() {
        return;
    }
    let caption = "Points with equal varied values. \u{2013}: the study has no such point, or the point failed.";
    let mut heads = heads(comparison, "point", true);
    heads.insert(1, "measured");
    *html += &table_head("Points", caption, &heads);
    for PointRow { point, measured, unit, values, from_first, .. } in &comparison.points {
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let _ = write!(
            html,
            "<tr><td class=\"text\">{}</td><td class=\"text\">{}{unit}</td>",
            escape(point),
            escape(measured)
        );
        for (index, value) in values.iter().enumerate() {
            let _ = write!(html, "<td>{}</td>", value.map_or("\u{2013}".to_owned(), |value| plain(value, 4)));
            if index > 0 {
                let _ =
                    write!(html, "<td>{}</td>", from_first[index].map_or(String::new(), |from| differs(&from, 1.0)));
            }
        }
        *html += "</tr>";
    }
    *html += TABLE_END;
    *html += END;
}

/// Provenance of each result.
pub(super) fn made(html: &mut String, comparison: &Comparison) {
    *html += &table_head("How these were made", "", &["", "title", "file", "seed", "program", "SHA-256"]);
    for subject in &comparison.subjects {
        let made = &subject.made;
        let seed = made.seed.map_or(String::new(), |seed| seed.to_string());
        let cells =
            [made.title.clone(), made.file.clone(), seed, made.version.clone(), made.sha256.chars().take(12).collect()];
        row(html, &subject.name, &cells);
    }
    *html += TABLE_END;
    *html += END;
}
