//! Studies in one figure: measured values against the one number that varies, or point for point against the first
//! study.

use super::coloured;
use crate::compare::{Comparison, PointRow};
use crate::report::Figure;
use crate::report::along::figure;
use crate::report::curves::{Axis, Chart, Mark, Series};
use std::collections::BTreeSet;

/// A figure for each measured value.
pub(super) fn figures(comparison: &Comparison) -> Vec<Figure> {
    let mut measured: Vec<(&str, &str)> = Vec::new();
    for row in &comparison.points {
        if !measured.contains(&(&row.measured, &row.unit)) {
            measured.push((&row.measured, &row.unit));
        }
    }
    let rows = |of: &(&str, &str)| -> Vec<&PointRow> {
        comparison.points.iter().filter(|row| (row.measured.as_str(), row.unit.as_str()) == *of).collect()
    };
    measured.iter().enumerate().filter_map(|(index, of)| drawn(comparison, index, *of, &rows(of))).collect()
}

fn drawn(comparison: &Comparison, index: usize, of: (&str, &str), rows: &[&PointRow]) -> Option<Figure> {
    let id = format!("measured-{}", index + 1);
    match the_number_that_varies(comparison) {
        Some((path, unit)) => {
            let mut chart = Chart::new(axis(&path, &unit), axis(of.0, of.1));
            chart.series = curves(comparison, rows);
            figure(&chart, &id, of.0, "Each point of a study against the varied value.")
        }
        None => {
            let mut chart = Chart::new(axis(&format!("in {}", comparison.subjects[0].name), of.1), axis(of.0, of.1));
            chart.series = against_the_first(comparison, rows);
            let caption = "Each point of a study against the same point of the first study. On the line both values \
                are equal.";
            figure(&chart, &id, of.0, caption)
        }
    }
}

fn axis(label: &str, unit: &str) -> Axis {
    Axis { unit: unit.to_owned().into(), ..Axis::new(label, ("", 1.0)) }
}

/// Path and unit of the varied number, if all studies vary one number.
fn the_number_that_varies(comparison: &Comparison) -> Option<(String, String)> {
    let axes: BTreeSet<_> = comparison.subjects.iter().filter_map(|s| s.study()).map(|study| &study.axes).collect();
    let [axes] = axes.into_iter().collect::<Vec<_>>()[..] else { return None };
    let [axis] = &axes[..] else { return None };
    let levels = comparison.points.iter().filter_map(|row| row.levels.first());
    levels.map(|level| level.parse::<f64>().ok()).collect::<Option<Vec<f64>>>()?;
    Some(axis.clone())
}

fn curves(comparison: &Comparison, rows: &[&PointRow]) -> Vec<Series> {
    let curve = |(index, (subject, class)): (usize, (&crate::compare::Subject, String))| {
        let point = |row: &&PointRow| Some((row.levels.first()?.parse().ok()?, row.values[index]?));
        let mut points: Vec<(f64, f64)> = rows.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series::new(&subject.name, &class, Mark::Dots, points)
    };
    coloured(comparison).enumerate().map(curve).collect()
}

fn against_the_first(comparison: &Comparison, rows: &[&PointRow]) -> Vec<Series> {
    let of = |index: usize| -> Vec<(f64, f64)> {
        let point = |row: &&PointRow| Some((row.values[0]?, row.values[index]?));
        let mut points: Vec<(f64, f64)> = rows.iter().filter_map(point).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let mut series: Vec<Series> = coloured(comparison)
        .enumerate()
        .skip(1)
        .map(|(index, (subject, class))| Series::new(&subject.name, &class, Mark::Dots, of(index)))
        .collect();
    let line: Vec<(f64, f64)> =
        series.iter().flat_map(|series| &series.points).map(|point| (point.0, point.0)).collect();
    let ends = line.iter().copied().reduce(|a, b| if b.0 > a.0 { b } else { a });
    let start = line.iter().copied().reduce(|a, b| if b.0 < a.0 { b } else { a });
    series.push(Series::new("", "s0", Mark::Faint, start.into_iter().chain(ends).collect()));
    series
}
