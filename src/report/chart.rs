//! One diagram: axes with units, series, shaded stretches and reference lines, drawn into a frame of a picture.
//!
//! Data are in SI and are shown in the axis's unit. A value that is not finite is a gap. Long series are thinned to the
//! resolution of the pixels, and every peak is kept.

use super::curves::{Chart, Mark, Series};
use super::number::{nice_step, plain, tick_label, ticks};
use super::plane::{Plane, decades, extent, finite, rows, widened};
use super::readings;
use super::series::{draw_series, draw_symbol};
use super::svg::{Anchor, Frame, Svg, text_width};

const LEFT: f64 = 56.0;
const RIGHT: f64 = 14.0;
const BOTTOM: f64 = 42.0;
/// Room that a second scale and the numbers of seats take, px.
const SECOND: f64 = 34.0;
const PLACES: f64 = 18.0;
/// Room of one number of a seat, px.
const NUMBER: f64 = 36.0;
const LEGEND_ROW: f64 = 19.0;
/// Room of a mark on the edge of the plane, px.
const EDGE: f64 = 4.0;
/// Digits of the marks of a logarithmic axis.
const LOG_DIGITS: usize = 4;

impl Chart {
    /// Draws the diagram with its labels into `frame`. `id` is unique on a page.
    pub fn draw(&self, svg: &mut Svg, id: &str, frame: Frame) {
        svg.group(r#"class="chart""#, |svg| self.draw_parts(svg, id, frame));
    }

    fn draw_parts(&self, svg: &mut Svg, id: &str, frame: Frame) {
        let top = self.draw_head(svg, frame) + if self.seats.is_empty() { 0.0 } else { PLACES };
        let right = if self.second.is_some() { RIGHT + SECOND } else { RIGHT };
        let plane = self.plane(Frame {
            x: frame.x + LEFT,
            y: top,
            width: frame.width - LEFT - right,
            height: frame.y + frame.height - BOTTOM - top,
        });
        readings::write(svg, self, &plane);
        self.draw_bands(svg, &plane);
        self.draw_axes(svg, &plane);
        svg.clipped(id, self.room(&plane), |svg| {
            for (index, series) in self.series.iter().enumerate() {
                let group = format!(r#"class="series" data-series="{index}""#);
                svg.group(&group, |svg| draw_series(svg, &plane, series, self));
            }
        });
        self.draw_names(svg, &plane);
        self.draw_seats(svg, &plane);
        self.draw_second(svg, &plane);
    }

    /// The axis's title and the legend; gives the top of the plane.
    fn draw_head(&self, svg: &mut Svg, frame: Frame) -> f64 {
        let title = match self.steps.last() {
            Some(step) => format!("{}, {step}", self.y.title()),
            None => self.y.title(),
        };
        svg.text("strong", (frame.x + 6.0, frame.y + 14.0), Anchor::Start, &title);
        let named = |(_, series): &(usize, &Series)| !series.name.is_empty() && series.mark != Mark::Faint;
        let entries: Vec<(usize, &Series)> = self.series.iter().enumerate().filter(named).collect();
        let width = |series: &Series| text_width(&series.name) + 36.0;
        let all: f64 = entries.iter().map(|(_, series)| width(series)).sum();
        let (left, right) = (frame.x + 6.0, frame.x + frame.width - RIGHT);
        let beside = right - all > left + text_width(&title) + 24.0;
        let (mut x, mut y) = if beside { (right - all, frame.y + 14.0) } else { (left, frame.y + 14.0 + LEGEND_ROW) };
        for (index, series) in &entries {
            if x + width(series) > right + 8.0 && x > left {
                (x, y) = (left, y + LEGEND_ROW);
            }
            let group = format!(r#"class="entry" data-series="{index}""#);
            svg.group(&group, |svg| draw_entry(svg, series, (x, y)));
            x += width(series);
        }
        if entries.is_empty() { frame.y + 24.0 } else { y + 10.0 }
    }

    /// The plane with room for the marks on its edges; none to the sides where curves go on beyond them.
    fn room(&self, plane: &Plane) -> Frame {
        let Frame { x, y, width, height } = plane.frame;
        let beyond = |x: f64| x < plane.x.0 || x > plane.x.1;
        let goes_on = self.series.iter().flat_map(|series| &series.points).any(|point| beyond(point.0));
        let side = if goes_on { 0.0 } else { EDGE };
        Frame { x: x - side, y: y - EDGE, width: width + 2.0 * side, height: height + 2.0 * EDGE }
    }

    fn plane(&self, frame: Frame) -> Plane {
        let points = || self.series.iter().flat_map(|series| series.points.iter().filter(|p| finite(p)));
        let x = self.x.range.unwrap_or_else(|| extent(points().map(|p| p.0)));
        let inside = points().filter(|p| p.0 >= x.0 && p.0 <= x.1).map(|p| p.1);
        let y = self.y.range.unwrap_or_else(|| {
            let levels = self.levels.iter().map(|(level, _)| *level);
            let moving = self.series.iter().flat_map(|s| s.moving.iter().flatten().copied()).filter(|v| v.is_finite());
            let all = inside.chain(moving).chain(levels).chain(self.y.from_zero.then_some(0.0));
            self.round_range(extent(all), frame.height)
        });
        let logarithmic = [self.x.logarithmic, self.y.logarithmic];
        Plane { frame, x: widened(x), y: widened(y), downwards: self.y.downwards, logarithmic }
    }

    /// The range of the upright axis, SI, that shows `series` whole on a plane of `height` px.
    pub fn y_extent(&self, series: &Series, height: f64) -> (f64, f64) {
        self.round_range(extent(series.points.iter().filter(|p| finite(p)).map(|p| p.1)), height)
    }

    /// A range that ends on round values, with room for names at the top.
    fn round_range(&self, (low, high): (f64, f64), height: f64) -> (f64, f64) {
        if self.y.logarithmic {
            return (10f64.powf(low.log10().floor()), 10f64.powf(high.log10().ceil()));
        }
        let step = nice_step((high - low) / self.y.size / rows(height) as f64) * self.y.size;
        let room = if self.bands.iter().any(|band| !band.label.is_empty()) { 0.09 * (high - low) } else { 0.0 };
        let up = |value: f64| (value / step - 1e-6).ceil() * step;
        let (bottom, top) = (-up(-low), up(high));
        if self.y.downwards { (bottom.min(low - room), top) } else { (bottom, top.max(high + room)) }
    }

    fn draw_bands(&self, svg: &mut Svg, plane: &Plane) {
        let Frame { x: left, y, width, height } = plane.frame;
        for band in &self.bands {
            let from = plane.point_at((band.from, 0.0)).0.max(left);
            let to = plane.point_at((band.to, 0.0)).0.min(left + width);
            if to > from {
                svg.rect(band.class, Frame { x: from, y, width: to - from, height });
            }
        }
    }

    fn draw_axes(&self, svg: &mut Svg, plane: &Plane) {
        let frame = plane.frame;
        let (right, bottom) = (frame.x + frame.width, frame.y + frame.height);
        let (low, high) = (plane.y.0 / self.y.size, plane.y.1 / self.y.size);
        let logarithmic = self.y.logarithmic;
        let marks = if logarithmic { decades(low, high) } else { ticks(low, high, rows(frame.height) + 1) };
        let step = marks.windows(2).next().map_or(1.0, |pair| pair[1] - pair[0]);
        for mark in marks {
            let y = plane.point_at((plane.x.0, mark * self.y.size)).1;
            let label = if logarithmic { plain(mark, LOG_DIGITS) } else { tick_label(mark, step) };
            svg.line("grid", (frame.x, y), (right, y));
            svg.text("small muted", (frame.x - 7.0, y + 4.0), Anchor::End, &label);
        }
        let (low, high) = (plane.x.0 / self.x.size, plane.x.1 / self.x.size);
        let most = frame.width / 75.0;
        let pieces = if self.x.whole { most.min(high - low) } else { most };
        let marks = if self.x.logarithmic { decades(low, high) } else { ticks(low, high, pieces as usize) };
        let step = marks.windows(2).next().map_or(1.0, |pair| pair[1] - pair[0]);
        for mark in marks {
            let x = plane.point_at((mark * self.x.size, plane.y.0)).0;
            svg.line("grid", (x, frame.y), (x, bottom));
            svg.line("axis", (x, bottom), (x, bottom + 4.0));
            let label = if self.x.logarithmic { plain(mark, LOG_DIGITS) } else { tick_label(mark, step) };
            svg.text("small muted", (x, bottom + 17.0), Anchor::Middle, &label);
        }
        svg.line("axis", (frame.x, bottom), (right, bottom));
        svg.line("axis", (frame.x, frame.y), (frame.x, bottom));
        if plane.y.0 < 0.0 && plane.y.1 > 0.0 {
            let zero = plane.point_at((plane.x.0, 0.0)).1;
            svg.line("axis", (frame.x, zero), (right, zero));
        }
        svg.text("", (frame.x + frame.width / 2.0, bottom + 35.0), Anchor::Middle, &self.x.title());
    }

    /// Seat numbers over the plane: round ones, as many as fit.
    fn draw_seats(&self, svg: &mut Svg, plane: &Plane) {
        let Frame { x: left, y: top, width, .. } = plane.frame;
        let (Some(first), Some(last)) = (self.seats.first(), self.seats.last()) else { return };
        let gap = (plane.point_at((last.0, 0.0)).0 - plane.point_at((first.0, 0.0)).0) / self.seats.len() as f64;
        let fits = |step: &i32| f64::from(*step) * gap >= NUMBER;
        let step = [1, 2, 5, 10, 20, 50, 100, 200, 500].into_iter().find(fits).unwrap_or(1000);
        svg.text("small muted", (left - 7.0, top - 8.0), Anchor::End, "Seat");
        let mut free = left + 0.4 * NUMBER;
        for (place, number) in self.seats.iter().filter(|seat| seat.1 % step == 0) {
            let x = plane.point_at((*place, 0.0)).0;
            if (free..=left + width).contains(&x) {
                free = x + 0.9 * NUMBER;
                svg.line("axis", (x, top - 4.0), (x, top));
                let name = format!("{number:+}").replace('-', "\u{2212}");
                svg.text("small muted", (x, top - 8.0), Anchor::Middle, &name);
            }
        }
    }

    /// The second scale, right of the plane.
    fn draw_second(&self, svg: &mut Svg, plane: &Plane) {
        let Some((title, factor)) = &self.second else { return };
        let Frame { x, y, width, height } = plane.frame;
        let right = x + width;
        let marks = ticks(plane.y.0 * factor, plane.y.1 * factor, rows(height) + 3);
        let step = marks.windows(2).next().map_or(1.0, |pair| pair[1] - pair[0]);
        svg.line("axis", (right, y), (right, y + height));
        for mark in marks {
            let at = plane.point_at((plane.x.0, mark / factor)).1;
            svg.line("axis", (right, at), (right + 4.0, at));
            svg.text("small muted", (right + 7.0, at + 4.0), Anchor::Start, &tick_label(mark, step));
        }
        svg.text("small muted", (right + RIGHT + SECOND - 2.0, y + height + 35.0), Anchor::End, title);
    }

    /// Reference lines and every name inside the plane, above the data.
    fn draw_names(&self, svg: &mut Svg, plane: &Plane) {
        let Frame { x: left, y: top, width, height } = plane.frame;
        for x in self.uprights.iter().filter(|x| (plane.x.0..=plane.x.1).contains(*x)) {
            let x = plane.point_at((*x, 0.0)).0;
            svg.line("mark", (x, top), (x, top + height));
        }
        for (level, name) in &self.levels {
            let y = plane.point_at((plane.x.0, *level)).1;
            svg.line("load", (left, y), (left + width, y));
            if !name.is_empty() {
                // below the line where there is no room above it
                let shift = if y - top < 16.0 { 14.0 } else { -5.0 };
                svg.text("small muted halo", (left + 6.0, y + shift), Anchor::Start, name);
            }
        }
        for band in self.bands.iter().filter(|band| !band.label.is_empty()) {
            let from = plane.point_at((band.from, 0.0)).0.max(left);
            let to = plane.point_at((band.to, 0.0)).0.min(left + width);
            if to - from > text_width(&band.label) {
                svg.text("small muted halo", ((from + to) / 2.0, top + 14.0), Anchor::Middle, &band.label);
            }
        }
    }
}

/// The mark of a series and its name.
fn draw_entry(svg: &mut Svg, series: &Series, (x, y): (f64, f64)) {
    match series.mark {
        Mark::Bars(_) => {
            let frame = Frame { x: x + 6.0, y: y - 9.0, width: 10.0, height: 10.0 };
            svg.rect(&format!("bar {}", series.class), frame);
        }
        _ => svg.line(&format!("line {}", series.class), (x, y - 4.0), (x + 20.0, y - 4.0)),
    }
    if series.mark == Mark::Dots {
        draw_symbol(svg, (&series.class, ""), (x + 10.0, y - 4.0), 3.0, "");
    }
    svg.text("", (x + 25.0, y), Anchor::Start, &series.name);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::curves::Axis;

    #[test]
    fn values_that_are_none_leave_a_gap() {
        let mut chart = Chart::new(Axis::new("a", ("", 1.0)), Axis::new("b", ("", 1.0)));
        assert!(chart.is_empty());
        let points = vec![(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, f64::INFINITY), (4.0, 1.0), (5.0, 0.0)];
        chart.series.push(Series::new("c", "k0", Mark::Dots, points));
        let mut svg = Svg::default();
        chart.draw(&mut svg, "id", Frame { x: 0.0, y: 0.0, width: 300.0, height: 200.0 });
        let text = svg.finish(300.0, 200.0, "d");
        assert!(!text.contains("NaN") && !text.contains("inf"));
        assert_eq!(text.matches(r#"<path class="line"#).count(), 2);
    }

    #[test]
    fn counts_of_few_things_are_marked_at_whole_numbers() {
        let mut chart = Chart::new(Axis { whole: true, ..Axis::new("Cycles", ("", 1.0)) }, Axis::new("b", ("", 1.0)));
        chart.series = vec![Series::new("", "s0", Mark::Line, vec![(1.0, 0.0), (3.0, 400.0)])];
        let mut svg = Svg::default();
        chart.draw(&mut svg, "id", Frame { x: 0.0, y: 0.0, width: 960.0, height: 300.0 });
        let picture = svg.finish(960.0, 300.0, "");
        assert!(["1", "2", "3"].iter().all(|mark| picture.contains(&format!(">{mark}</text>"))), "{picture}");
        assert!(!picture.contains(">1.2</text>") && !picture.contains(">1.5</text>"), "{picture}");
    }

    #[test]
    fn a_logarithmic_upright_axis_ends_on_powers_of_ten() {
        let mut chart = Chart::new(Axis::new("a", ("", 1.0)), Axis { logarithmic: true, ..Axis::new("b", ("", 1.0)) });
        chart.series.push(Series::new("", "s0", Mark::Line, vec![(0.0, 0.9), (1.0, 0.002)]));
        let frame = Frame { x: 0.0, y: 0.0, width: 300.0, height: 200.0 };
        let plane = chart.plane(frame);
        assert_eq!(plane.y, (1e-3, 1.0));
        let down = |value: f64| plane.point_at((0.0, value)).1;
        assert!((down(1e-3) - 200.0).abs() < 1e-9 && down(1.0).abs() < 1e-9);
        assert!((down(0.1) - 200.0 / 3.0).abs() < 1e-9, "{}", down(0.1));
        let mut svg = Svg::default();
        chart.draw(&mut svg, "id", frame);
        let text = svg.finish(300.0, 200.0, "d");
        assert!(text.contains(">0.01<") && text.contains(">1<") && !text.contains("NaN"), "{text}");
    }
}
