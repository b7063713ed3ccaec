//! Several charts in one picture, side by side or one above the other.

use super::Figure;
use super::curves::{Axis, Chart, Mark, Series};
use super::svg::{Frame, Svg};
use super::view::WIDTH;

const GAP: f64 = 14.0;

/// Names and caption of a figure.
pub struct Names<'a> {
    pub id: &'a str,
    pub title: &'a str,
    pub caption: &'a str,
}

/// A figure of charts, each with its height in px, in rows of `columns`; `None` if all charts are empty.
pub fn panels(names: &Names<'_>, charts: &[(Chart, f64)], columns: usize) -> Option<Figure> {
    if charts.iter().all(|(chart, _)| chart.is_empty()) {
        return None;
    }
    let columns = columns.max(1);
    let width = WIDTH / columns as f64;
    let (mut svg, mut y) = (Svg::default(), 0.0);
    for (row, charts) in charts.chunks(columns).enumerate() {
        let mut tallest: f64 = 0.0;
        for (column, (chart, height)) in charts.iter().enumerate() {
            let frame = Frame { x: column as f64 * width, y, width, height: *height };
            chart.draw(&mut svg, &format!("plane-{}-{}", names.id, row * columns + column), frame);
            tallest = tallest.max(*height);
        }
        y += tallest + GAP;
    }
    let Names { id, title, caption } = *names;
    let svg = svg.finish(WIDTH, y - GAP, title);
    Some(Figure { id: id.to_owned(), title: title.to_owned(), caption: caption.to_owned(), svg })
}

/// Gives charts of `height` px one upright scale, so that they can be compared.
pub fn share_scale<'a>(charts: impl Iterator<Item = &'a mut Chart>, height: f64) {
    let mut charts: Vec<&mut Chart> = charts.collect();
    let points = charts.iter().flat_map(|chart| chart.series.iter().flat_map(|series| series.points.iter().copied()));
    let seen = |chart: &Chart, point: &(f64, f64)| chart.x.range.is_none_or(|(a, b)| point.0 >= a && point.0 <= b);
    let Some(first) = charts.first() else { return };
    let points: Vec<(f64, f64)> = points.filter(|point| seen(first, point)).collect();
    let mut levels: Vec<(f64, f64)> =
        charts.iter().flat_map(|chart| chart.levels.iter().map(|level| (0.0, level.0))).collect();
    levels.extend(points);
    let range = first.y_extent(&Series::new("", "", Mark::Line, levels), height);
    for chart in &mut charts {
        chart.y = Axis { range: Some(range), ..chart.y.clone() };
    }
}
