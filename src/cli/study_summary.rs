//! What `trackbed study` prints at its end: a table that begins with the scene as it is, the best designs, and what
//! stands against the answer.

use super::terminal;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Goal, Measured};
use crate::study::{Answer, MetAndMissed, Row, amount};
use crate::units::number;
use std::fmt::Write;
use std::path::Path;

/// Rows of the table.
const MOST: usize = 20;
/// Characters of a value that varies.
const WIDEST: usize = 28;

/// The whole summary.
pub(super) fn text(answer: &Answer, out: &Path, seconds: f64) -> String {
    let (title, name) = (&answer.title, &answer.study.name);
    let mut text = format!("{title}, study `{name}`\n\n{}\n", measured(answer));
    let rows = shown(answer);
    text += &terminal::aligned(&table(answer, &rows));
    if rows.len() < answer.rows.len() {
        let _ = writeln!(text, "  and {} more in study.csv", answer.rows.len() - rows.len());
    }
    text += &packings(answer);
    text += &constraints(answer);
    text += &best(answer);
    let _ = writeln!(text, "{} ({} s)", out.join("study.html").display(), number((seconds * 10.0).round() / 10.0));
    text
}

/// What each column of the table holds: expressions are long.
fn measured(answer: &Answer) -> String {
    let line = |(index, m): (usize, &&Measured)| {
        let goal = answer.study.objectives.iter().find(|objective| objective.of.text == m.text);
        let goal = goal.map_or("", |objective| match objective.goal {
            Goal::Minimise => ", the smaller the better",
            Goal::Maximise => ", the larger the better",
        });
        let unit = if m.unit.0.is_empty() { String::new() } else { format!(" [{}]", m.unit.0) };
        format!("  {}  {}{unit}{goal}\n", letter(index), m.text)
    };
    answer.study.measured().iter().enumerate().map(line).collect()
}

/// `a` to `z`, then `a2`.
fn letter(index: usize) -> String {
    let letter = char::from(b'a' + (index % 26) as u8);
    if index < 26 { letter.to_string() } else { format!("{letter}{}", index / 26 + 1) }
}

/// Rows that the terminal shows: the scene as it is, and of many points the best or the nearest.
fn shown(answer: &Answer) -> Vec<usize> {
    if answer.rows.len() <= MOST {
        return (0..answer.rows.len()).collect();
    }
    let first = answer.rows.iter().position(|row| row.as_it_is);
    let chosen = first.into_iter().chain(answer.best()).chain(answer.nearest());
    let mut rows: Vec<usize> = Vec::new();
    for index in chosen.chain(0..answer.rows.len()) {
        if !rows.contains(&index) && rows.len() < MOST {
            rows.push(index);
        }
    }
    rows
}

/// Cells, their titles first.
fn table(answer: &Answer, rows: &[usize]) -> Vec<Vec<String>> {
    let study = &answer.study;
    let mut titles = vec!["point".to_string()];
    titles.extend(
        study.axes.iter().map(|axis| {
            if axis.unit.is_empty() { axis.path.clone() } else { format!("{} [{}]", axis.path, axis.unit) }
        }),
    );
    titles.extend((0..study.measured().len()).map(letter));
    titles.extend(study.repeats.are_open().then(|| "packings".to_string()));
    titles.push(String::new());
    let best = answer.best();
    let row = |index: &usize| {
        let row = &answer.rows[*index];
        let mut cells = vec![if row.as_it_is { "as it is".to_string() } else { row.number.to_string() }];
        cells.extend(row.levels.iter().map(|level| level.number.map_or_else(|| cut(&level.text), number)));
        cells.extend(study.measured().iter().enumerate().map(|(index, m)| value(answer, row, index, m)));
        cells.extend(study.repeats.are_open().then(|| row.packings().to_string()));
        cells.push(remark(answer, row, best.contains(index)));
        cells
    };
    std::iter::once(titles).chain(rows.iter().map(row)).collect()
}

/// `2.07 (-22 %)`
fn value(answer: &Answer, row: &Row, index: usize, m: &Measured) -> String {
    let Some(value) = row.values().and_then(|values| values.get(index)) else { return "-".to_string() };
    let mut text = number(rounded(value / m.unit.1, 4));
    if answer.study.repeats.are_several()
        && let Some(deviation) = row.deviations().and_then(|deviations| deviations.get(index))
    {
        let _ = write!(text, " +- {}", number(rounded(deviation / m.unit.1, 2)));
    }
    match answer.difference(row, index) {
        Some(difference) => format!("{text} ({})", difference.text(m)),
        None => text,
    }
}

fn remark(answer: &Answer, row: &Row, best: bool) -> String {
    let point = if row.as_it_is && row.designed() { format!("point {}", row.number) } else { String::new() };
    let missed = row.misses().iter().flatten().count();
    let largest = row.misses().iter().flatten().map(|miss| miss.share).fold(0.0, f64::max);
    let what = if row.failed().is_some() {
        "failed".to_string()
    } else if best && answer.study.objectives.len() == 1 {
        "best".to_string()
    } else if best {
        "no other is better in all".to_string()
    } else if missed > 0 {
        let constraints = if missed == 1 { "a constraint".to_string() } else { format!("{missed} constraints") };
        format!("misses {constraints}, by {} %", number(rounded(largest * 100.0, 2)))
    } else {
        String::new()
    };
    [point, what].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// What the columns of repeated points hold.
fn packings(answer: &Answer) -> String {
    let repeats = answer.study.repeats;
    if !repeats.are_several() {
        return String::new();
    }
    let runs = if repeats.are_open() {
        format!("{} runs, {repeats} packings a point", answer.runs())
    } else {
        format!("{repeats} packings a point")
    };
    format!(
        "\n  {runs}: mean +- standard deviation of one packing; in brackets the difference on the same packings, with \
         the 95 % interval\n  of its mean\n"
    )
}

/// How the designs do against the constraints that some of them miss.
fn constraints(answer: &Answer) -> String {
    let missed: Vec<MetAndMissed> = answer.constraints().into_iter().filter(|c| c.missed > 0).collect();
    let line = |c: &MetAndMissed| format!("  {}\n", told(c, true));
    if missed.is_empty() { String::new() } else { format!("\n{}", missed.iter().map(line).collect::<String>()) }
}

/// `` `max(settlement) < 3 mm` is missed by 5 of 12 designs, by 0.4 mm (13 %) to 2.1 mm (70 %) ``
fn told(c: &MetAndMissed, named: bool) -> String {
    let of = c.met + c.missed;
    let designs = if of == 1 { "1 design".to_string() } else { format!("{of} designs") };
    let name = if named { format!("`{}` is ", c.text) } else { String::new() };
    let by = match (c.least, c.largest) {
        (Some(least), Some(largest)) if least.by == largest.by => format!(", by {}", amount(&least, &c.unit)),
        (Some(least), Some(largest)) => {
            format!(", by {} to {}", amount(&least, &c.unit), amount(&largest, &c.unit))
        }
        _ => String::new(),
    };
    format!("{name}missed by {} of {designs}{by}", c.missed)
}

/// The best design with what it changes, or the nearest one.
fn best(answer: &Answer) -> String {
    let best = answer.best();
    let mut text = String::from("\n");
    if let Some(nearest) = answer.nearest() {
        let row = &answer.rows[nearest];
        let _ = writeln!(text, "  no design meets every constraint; the nearest is {}", described(answer, row));
        answer.missed(row).iter().for_each(|missed| {
            let _ = writeln!(text, "    misses {missed}");
        });
        return text;
    }
    match (answer.study.objectives.len(), best.as_slice()) {
        (0, _) => return text,
        (_, []) => text += "  no design ran to its end\n",
        (1, [first, ..]) => {
            let _ = writeln!(text, "  best: {}", described(answer, &answer.rows[*first]));
        }
        (_, many) => {
            let points: Vec<String> = many.iter().map(|index| answer.rows[*index].number.to_string()).collect();
            let _ = writeln!(text, "  designs that no other beats in every objective: {}", points.join(", "));
        }
    }
    for sentence in [answer.certainty(), answer.against_as_it_is()].into_iter().flatten() {
        let _ = writeln!(text, "  {sentence}");
    }
    text
}

/// `point 3, pad = 40 MN/m`
fn described(answer: &Answer, row: &Row) -> String {
    format!("{}, {}", row.name(), answer.lines(row).join(", "))
}

/// What stands against the answer: no design that meets its constraints, and points that failed.
pub(super) fn diagnostics(answer: &Answer) -> Vec<Diagnostic> {
    let mut found = failures(answer);
    found.extend(infeasible(answer));
    found
}

/// No design meets every constraint: by how much each is missed, and which design comes nearest.
fn infeasible(answer: &Answer) -> Option<Diagnostic> {
    let nearest = &answer.rows[answer.nearest()?];
    let study = &answer.study;
    let message = format!("no design of study `{}` meets every constraint", study.name);
    let missed = study.constraints.iter().zip(answer.constraints()).filter(|(_, c)| c.missed > 0);
    let labelled = missed.fold(Diagnostic::new(Code::E0711, message), |diagnostic, (constraint, c)| {
        diagnostic.label(constraint.span, told(&c, false))
    });
    let as_it_is = match answer.as_it_is() {
        Some(row) if row.feasible() && !row.designed() => "; the scene as it is meets them all",
        _ => "",
    };
    let (described, missed) = (described(answer, nearest), answer.missed(nearest).join(" and "));
    Some(
        labelled
            .help(format!("the nearest is {described}: it misses {missed}{as_it_is}. Vary further, or ask for less")),
    )
}

/// Points that failed are named once a reason.
fn failures(answer: &Answer) -> Vec<Diagnostic> {
    let mut reasons: Vec<(&str, Vec<&Row>)> = Vec::new();
    for row in answer.failures() {
        let reason = row.failed().unwrap_or_default();
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, rows)) => rows.push(row),
            None => reasons.push((reason, vec![row])),
        }
    }
    let told = |(reason, rows): (&str, Vec<&Row>)| {
        let (first, study) = (rows[0].name(), &answer.study.name);
        let which = match rows.as_slice() {
            [only] if only.designed() => format!("{first} of study `{study}`"),
            [_] => format!("{first}, which study `{study}` runs beside its points,"),
            many => format!("{} points, the first {first}, of study `{study}`", many.len()),
        };
        Diagnostic::new(Code::E0808, format!("{which} failed: {reason}"))
            .label(answer.study.span, "the other points stand")
            .help("its row in `study.csv` has the values; run it alone with `trackbed run` and `--set`")
    };
    reasons.into_iter().map(told).collect()
}

/// A text cut to what a column holds.
fn cut(text: &str) -> String {
    if text.chars().count() <= WIDEST {
        return text.to_owned();
    }
    text.chars().take(WIDEST - 3).chain("...".chars()).collect()
}

/// To so many digits.
fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}
