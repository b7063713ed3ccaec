//! Settlement by several laws under the same forces: along the track, and against the axles at the seat with the
//! largest settlement by the first law.

use super::Figure;
use super::along::{figure, track_chart};
use super::curves::{Axis, Chart, Mark, Series};
use super::number::{plain, shown_unit, significant, whole};
use super::prose::prose;
use crate::results::{LawRow, Run, unsettled};
use std::fmt::Write;

/// Laws that a reader can tell apart by colour, and the colours.
const CLASSES: [&str; 10] = ["s0", "s1", "s2", "s3", "k5", "k2", "k0", "k4", "k1", "k3"];

/// The figures of a run with several laws.
pub fn spread(run: &Run) -> Vec<Figure> {
    let names = laws(run);
    if names.len() < 2 {
        return vec![];
    }
    [along_the_track(run, &names), with_the_axles(run, &names)].into_iter().flatten().collect()
}

/// Writes a note for each law under which nothing settled.
pub fn remarks(html: &mut String, run: &Run) {
    for sentence in unsettled(&run.scenario, &run.blocks, &run.laws) {
        let _ = writeln!(html, "<p class=\"caption\" role=\"note\">Note: {}.</p>", prose(&sentence));
    }
}

/// The laws of the table, the driving one first.
fn laws(run: &Run) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in &run.laws {
        if !names.contains(&row.law.as_str()) {
            names.push(&row.law);
        }
    }
    names
}

fn class(index: usize) -> &'static str {
    CLASSES[index % CLASSES.len()]
}

fn rows_of<'a>(run: &'a Run, law: &'a str, axles: u64) -> impl Iterator<Item = &'a LawRow> {
    run.laws.iter().filter(move |row| row.law == law && row.axles == axles && row.settlement_m.is_finite())
}

fn along_the_track(run: &Run, names: &[&str]) -> Option<Figure> {
    let last = run.laws.iter().map(|row| row.axles).max()?;
    let mut chart = track_chart(run, "Settlement", "m", true);
    for (index, name) in names.iter().enumerate() {
        let rows: Vec<&LawRow> = rows_of(run, name, last).collect();
        let mut series =
            Series::new(name, class(index), Mark::Dots, rows.iter().map(|r| (r.x_m, r.settlement_m)).collect());
        series.labels = rows.iter().map(|row| row.sleeper.replace('-', "\u{2212}")).collect();
        chart.series.push(series);
    }
    let caption = format!(
        "Settlement after {} axles by each law. All laws get the same forces: the forces computed with the first law, \
        {}. {}",
        whole(last),
        names[0],
        spread_sentence(run, names, last)
    );
    figure(&chart, "laws_along_the_track", "Settlement by law", &caption)
}

/// `The largest settlement lies between 0.6 mm (a) and 1.8 mm (b), a ratio of 3.`
fn spread_sentence(run: &Run, names: &[&str], axles: u64) -> String {
    let most = |name: &str| rows_of(run, name, axles).map(|row| row.settlement_m).fold(0.0, f64::max);
    let mut largest: Vec<(f64, &str)> = names.iter().map(|name| (most(name), *name)).collect();
    largest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some((least, weakest)), Some((greatest, strongest))) = (largest.first(), largest.last()) else {
        return String::new();
    };
    let millimetres = |value: f64| format!("{} mm", significant(value * 1e3, 3));
    let ratio = match least {
        least if *least > 0.0 => format!("a ratio of {}", plain(greatest / least, 2)),
        _ => "and no ratio can be given".to_owned(),
    };
    format!(
        "The largest settlement lies between {} ({weakest}) and {} ({strongest}), {ratio}. This spread between laws is \
         the uncertainty of this tier.",
        millimetres(*least),
        millimetres(*greatest)
    )
}

fn with_the_axles(run: &Run, names: &[&str]) -> Option<Figure> {
    let last = run.laws.iter().map(|row| row.axles).max()?;
    let deepest = rows_of(run, names[0], last).max_by(|a, b| a.settlement_m.total_cmp(&b.settlement_m))?;
    let mut settlement = Axis::new("Settlement", shown_unit("m"));
    (settlement.downwards, settlement.from_zero) = (true, true);
    let mut chart = Chart::new(Axis::new("Axles", ("", 1.0)), settlement);
    for (index, name) in names.iter().enumerate() {
        let rows = run.laws.iter().filter(|row| row.law == *name && row.sleeper == deepest.sleeper);
        let points = rows.map(|row| (row.axles as f64, row.settlement_m)).collect();
        chart.series.push(Series::new(name, class(index), Mark::Dots, points));
    }
    let caption = format!(
        "Settlement of sleeper {} against the axles passed, by each law. The first law has its largest settlement at \
        this sleeper.",
        deepest.sleeper.replace('-', "\u{2212}")
    );
    figure(&chart, "laws_with_the_axles", "Settlement by law with the axles", &caption)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::example;

    /// The example run with a second law that settles three times as much.
    fn two_laws(factor: f64) -> Run {
        let mut run = example::transition();
        for (law, factor) in [("varandas", 1.0), ("other", factor)] {
            run.laws.extend(run.sleepers.iter().filter(|row| row.x_m < -0.1).map(|row| LawRow {
                axles: row.axles,
                law: law.to_owned(),
                sleeper: row.sleeper.clone(),
                x_m: row.x_m,
                settlement_m: factor * row.settlement_m,
            }));
        }
        run
    }

    #[test]
    fn the_spread_is_a_sentence_and_two_figures() {
        let figures = spread(&two_laws(3.0));
        assert_eq!(figures.len(), 2);
        assert!(
            figures[0].caption.contains("3.00 mm (varandas) and 9.00 mm (other), a ratio of 3."),
            "{}",
            figures[0].caption
        );
        assert!(figures[1].caption.contains("sleeper \u{2212}5"), "{}", figures[1].caption);
        for figure in &figures {
            assert!(roxmltree::Document::parse(&figure.svg).is_ok());
        }
        assert!(spread(&example::transition()).is_empty());
    }

    #[test]
    fn a_law_under_which_nothing_settles_is_named() {
        let run = two_laws(0.0);
        assert!(spread(&run)[0].caption.contains("no ratio can be given"));
        let mut html = String::new();
        remarks(&mut html, &run);
        assert_eq!(html, "");
        let mut run = run;
        run.scenario.solve.other_laws.push(run.scenario.solve.law.clone());
        run.scenario.solve.other_laws[0].name = "other".to_owned();
        remarks(&mut html, &run);
        assert!(
            html.contains("nothing settled under law <code>other</code>: the largest contact force was "),
            "{html}"
        );
    }
}
