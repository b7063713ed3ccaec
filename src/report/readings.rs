//! The data of a chart beside its drawing: the page's script reads values from the data and moves curves.
//!
//! One JSON object in the `metadata` of the chart, in the units of its axes. A line holds only the points needed for an
//! accuracy of a part of a pixel, so the data are smaller than the drawing; dots, bars and curves that move hold every
//! value.

use super::curves::{Axis, Chart, Mark, Series};
use super::plane::Plane;
use super::series::{has_dots, line_pixels};
use super::svg::Svg;
use std::fmt::Write;

/// Steps of an axis by the last digit that is stored (finer on the x axis, because steep curves need it), and by the
/// last digit that is shown.
const ACROSS: [f64; 2] = [10_000.0, 2_000.0];
const UPWARDS: [f64; 2] = [2_000.0, 500.0];
/// Resolution of the data of a line, px: width of the columns that keep their peaks, and allowed error of a value
/// between two samples. It is coarser than the drawing but as fine as a pointer, and the data have a third of the size
/// of the drawing.
const COLUMN: f64 = 2.0;
const OFF: f64 = 0.25;
/// Digits that are kept of values on a logarithmic axis.
const DIGITS: i32 = 4;

/// Writes the data of a chart into the group that is open.
pub(super) fn write(svg: &mut Svg, chart: &Chart, plane: &Plane) {
    let (across, upwards) = (Steps::of(&chart.x, plane.x, ACROSS[0]), Steps::of(&chart.y, plane.y, UPWARDS[0]));
    let frame = plane.frame;
    let mut json = format!("{{\"frame\":[{:.1},{:.1},{:.1},{:.1}]", frame.x, frame.y, frame.width, frame.height);
    let _ = write!(json, ",\"x\":{},\"y\":{}", axis(&chart.x, plane.x, ACROSS[1]), axis(&chart.y, plane.y, UPWARDS[1]));
    if !chart.seats.is_empty() {
        let seats = || chart.seats.iter().filter(|seat| (plane.x.0..=plane.x.1).contains(&seat.0));
        let places = across.list(seats().map(|seat| seat.0));
        let numbers: Vec<String> = seats().map(|seat| seat.1.to_string()).collect();
        let _ = write!(json, ",\"seats\":[{places},[{}]]", numbers.join(","));
    }
    let mut grids: Vec<String> = Vec::new();
    let mut curves: Vec<String> = Vec::new();
    for (index, series) in chart.series.iter().enumerate() {
        let points = shown(series, plane);
        let grid = across.list(points.iter().map(|point| point.0));
        let known = grids.iter().position(|other| *other == grid).unwrap_or(grids.len());
        if known == grids.len() {
            grids.push(grid);
        }
        curves.push(curve(chart, index, &points, known, &upwards));
    }
    let _ = write!(json, ",\"grids\":[{}],\"series\":[{}]", grids.join(","), curves.join(","));
    if !chart.steps.is_empty() {
        let steps: Vec<String> = chart.steps.iter().map(|name| text(name)).collect();
        let _ = write!(json, ",\"steps\":[{}]", steps.join(","));
    }
    svg.define(&format!("<metadata>{}}}</metadata>", json));
}

/// A curve over the grid of that number.
fn curve(chart: &Chart, index: usize, points: &[(f64, f64)], grid: usize, upwards: &Steps) -> String {
    let series = &chart.series[index];
    let line = matches!(series.mark, Mark::Line | Mark::Faint);
    let pale = if series.pale { " pale" } else { "" };
    let mut json = format!(
        "{{\"entry\":{},\"name\":{},\"class\":{},\"line\":{line},\"x\":{grid},\"y\":{}",
        chart.entry(index),
        text(&series.name),
        text(&format!("line {}{pale}", series.class)),
        upwards.list(points.iter().map(|point| point.1))
    );
    if !series.moving.is_empty() {
        let moving: Vec<String> = series.moving.iter().map(|values| upwards.list(values.iter().copied())).collect();
        let _ = write!(json, ",\"moving\":[{}]", moving.join(","));
    }
    // what has numbered seats is named by them
    if !series.labels.is_empty() && chart.seats.is_empty() {
        let labels: Vec<String> = series.labels.iter().map(|label| text(label)).collect();
        let _ = write!(json, ",\"labels\":[{}]", labels.join(","));
    }
    json + "}"
}

/// The points of a curve with values that can be read, SI; a value that is not finite is a gap.
fn shown(series: &Series, plane: &Plane) -> Vec<(f64, f64)> {
    let named = !series.labels.is_empty() || !series.moving.is_empty();
    if named || has_dots(series) || matches!(series.mark, Mark::Bars(_)) {
        return series.points.clone();
    }
    let mut points = Vec::new();
    for piece in line_pixels(plane, series, COLUMN, OFF) {
        if let (Some(last), Some(first)) = (points.last().copied(), piece.first()) {
            let (x, _): (f64, f64) = last;
            points.push((0.5 * (x + plane.value_at(*first).0), f64::NAN));
        }
        points.extend(piece.iter().map(|pixel| plane.value_at(*pixel)));
    }
    points
}

/// `{"name":"Settlement","unit":"mm","range":[0,5],"down":true,"log":false,"digits":3}`: `digits` decimals are worth
/// showing.
fn axis(axis: &Axis, (low, high): (f64, f64), steps: f64) -> String {
    let (low, high) = (low / axis.size, high / axis.size);
    let digits = if axis.whole { 0 } else { decimals((high - low) / steps) };
    format!(
        "{{\"name\":{},\"unit\":{},\"range\":[{low},{high}],\"down\":{},\"log\":{},\"digits\":{digits}}}",
        text(&axis.label),
        text(&axis.unit),
        axis.downwards,
        axis.logarithmic
    )
}

/// Rounding of the numbers of an axis.
struct Steps {
    size: f64,
    decimals: Option<usize>,
}

impl Steps {
    fn of(axis: &Axis, (low, high): (f64, f64), steps: f64) -> Steps {
        let decimals = (!axis.logarithmic).then(|| decimals((high - low) / axis.size / steps));
        Steps { size: axis.size, decimals }
    }

    /// `[1,2.5,null]`
    fn list(&self, values: impl Iterator<Item = f64>) -> String {
        let values: Vec<String> = values.map(|value| self.number(value / self.size)).collect();
        format!("[{}]", values.join(","))
    }

    fn number(&self, value: f64) -> String {
        if !value.is_finite() {
            return "null".to_owned();
        }
        let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
        let decimals = self.decimals.unwrap_or((DIGITS - 1 - magnitude).clamp(0, 12) as usize);
        let text = format!("{value:.decimals$}");
        let text = if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    }
}

/// Decimals that show a number to `step`.
fn decimals(step: f64) -> usize {
    if step > 0.0 && step.is_finite() { (-step.log10()).ceil().clamp(0.0, 9.0) as usize } else { 0 }
}

/// A text of JSON that is text in XML and HTML too.
fn text(text: &str) -> String {
    let quoted = serde_json::Value::from(text).to_string();
    quoted.replace('&', "\\u0026").replace('<', "\\u003c").replace('>', "\\u003e")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::svg::Frame;

    fn data(chart: &Chart) -> serde_json::Value {
        let mut svg = Svg::default();
        chart.draw(&mut svg, "id", Frame { x: 0.0, y: 0.0, width: 300.0, height: 200.0 });
        let picture = svg.finish(300.0, 200.0, "d");
        let document = roxmltree::Document::parse(&picture).unwrap();
        let node = document.descendants().find(|node| node.tag_name().name() == "metadata").unwrap();
        serde_json::from_str(node.text().unwrap()).unwrap()
    }

    #[test]
    fn dots_hold_their_values_and_share_their_places() {
        let mut chart = Chart::new(Axis::new("a", ("m", 1.0)), Axis::new("b <&>", ("mm", 1e-3)));
        let dots = |name: &str, values: [f64; 3]| {
            let points = values.into_iter().enumerate().map(|(k, v)| (k as f64, v)).collect();
            Series::new(name, "k0", Mark::Dots, points)
        };
        chart.series = vec![dots("one", [0.0, 1.234e-3, f64::NAN]), dots("", [0.0, 0.0, 4e-3])];
        let data = data(&chart);
        assert_eq!(data["grids"], serde_json::json!([[0, 1, 2]]));
        assert_eq!(data["series"][0]["y"], serde_json::json!([0, 1.234, null]));
        assert_eq!((&data["y"]["name"], &data["y"]["unit"]), (&"b <&>".into(), &"mm".into()));
        // a series without a name belongs to the legend entry of its colour
        assert_eq!(data["series"][1]["entry"], 0);
    }

    #[test]
    fn a_line_holds_what_is_drawn_with_its_gaps() {
        let mut chart = Chart::new(Axis::new("a", ("", 1.0)), Axis::new("b", ("", 1.0)));
        let mut points: Vec<(f64, f64)> = (0..=1000).map(|k| (f64::from(k), f64::from(k % 500))).collect();
        points[700].1 = f64::NAN;
        chart.series = vec![Series::new("", "s0", Mark::Line, points)];
        let data = data(&chart);
        let values = data["series"][0]["y"].as_array().unwrap();
        assert!(values.len() < 60, "{}", values.len());
        assert_eq!(values.iter().filter(|value| value.is_null()).count(), 1);
        assert_eq!(values.iter().filter_map(serde_json::Value::as_f64).fold(0.0, f64::max), 499.0);
    }
}
