//! The curves of a chart as they are drawn: lines thinned to the pixels, dots, bars.

use super::curves::{Axis, Chart, Mark, Series};
use super::number::significant;
use super::plane::{Plane, finite};
use super::svg::{Anchor, Frame, Svg};
use super::thin::{UNSEEN, straighten, thin};

/// Dots that a curve may have before they run together.
const MOST_DOTS: usize = 400;

pub(super) fn draw_series(svg: &mut Svg, plane: &Plane, series: &Series, chart: &Chart) {
    if let Mark::Bars(width) = series.mark {
        return draw_bars(svg, plane, series, chart, width);
    }
    let pale = pale(series);
    let (kind, column) = if series.mark == Mark::Faint { ("faint", 2.0) } else { ("line", 1.0) };
    for piece in line_pixels(plane, series, column, UNSEEN) {
        svg.path(&format!("{kind} {}{pale}", series.class), &piece, false, &series.name);
    }
    if has_dots(series) {
        let radius = if series.points.len() > 150 { 1.8 } else { 2.2 };
        for (index, point) in series.points.iter().enumerate() {
            let pixel = plane.point_at(*point);
            if finite(&pixel) {
                draw_symbol(svg, (&series.class, pale), pixel, radius, &label(series, index, chart));
            }
        }
    }
}

/// Whether every value of a curve has a mark of its own.
pub(super) fn has_dots(series: &Series) -> bool {
    series.mark == Mark::Dots && series.points.len() <= MOST_DOTS
}

/// The pieces of a curve in pixels, thinned by columns of `column` px and to what is farther than `off` px from a
/// straight line.
pub(super) fn line_pixels(plane: &Plane, series: &Series, column: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let pixels: Vec<(f64, f64)> = series.points.iter().map(|point| plane.point_at(*point)).collect();
    let pieces = pixels.split(|point| !finite(point)).filter(|piece| !piece.is_empty());
    pieces.map(|piece| straighten(&thin(piece, column), off)).collect()
}

fn pale(series: &Series) -> &'static str {
    if series.pale { " pale" } else { "" }
}

fn draw_bars(svg: &mut Svg, plane: &Plane, series: &Series, chart: &Chart, width: f64) {
    let class = format!("bar {}{}", series.class, pale(series));
    for (index, point) in series.points.iter().enumerate().filter(|(_, p)| finite(p)) {
        let (left, top) = plane.point_at((point.0 - width / 2.0, point.1.max(0.0)));
        let (right, bottom) = plane.point_at((point.0 + width / 2.0, point.1.min(0.0)));
        let (top, bottom) = (top.min(bottom), top.max(bottom));
        let frame = Frame { x: left, y: top, width: right - left, height: bottom - top };
        svg.titled_rect(&class, frame, &label(series, index, chart));
        if point.1 > 0.03 * plane.y.1 && frame.width > 14.0 {
            let value = significant(point.1 / chart.y.size, 2);
            svg.text("small halo", (left + frame.width / 2.0, top - 4.0), Anchor::Middle, &value);
        }
    }
}

/// A symbol of its own for every colour that curves of one chart may have.
pub(super) fn draw_symbol(svg: &mut Svg, (class, pale): (&str, &str), (x, y): (f64, f64), radius: f64, title: &str) {
    let kind = format!("dot {class}{pale}");
    let r = 1.25 * radius;
    match class {
        "s1" | "k2" => svg.path(&kind, &[(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)], true, title),
        "s2" | "k0" => {
            let r = 1.2 * r;
            svg.path(&kind, &[(x, y - r), (x + r, y + r), (x - r, y + r)], true, title);
        }
        "s3" | "k3" => {
            let r = 1.25 * r;
            svg.path(&kind, &[(x, y - r), (x + r, y), (x, y + r), (x - r, y)], true, title);
        }
        _ => svg.circle(&kind, (x, y), radius, title),
    }
}

fn label(series: &Series, index: usize, chart: &Chart) -> String {
    let (x, y) = series.points[index];
    let what = series.labels.get(index).map_or("", String::as_str);
    let value = |axis: &Axis, value: f64| format!("{} {}", significant(value / axis.size, 4), axis.unit);
    let place = if what.is_empty() { value(&chart.x, x) } else { format!("{what} ({})", value(&chart.x, x)) };
    let name = if series.name.is_empty() { String::new() } else { format!(", {}", series.name) };
    format!("{place}{name}: {}", value(&chart.y, y))
}
