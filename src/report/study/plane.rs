//! A small diagram with two plain scales, for points of a study.

use crate::report::curves::{Axis, Chart, Series};
use crate::report::number::{nice_step, tick_label, ticks};
use crate::report::svg::{Anchor, Frame, Svg};
use crate::report::{plane, readings};

/// Frame of the data on the picture.
pub(super) struct Plane {
    pub frame: Frame,
    pub x: (f64, f64),
    pub y: (f64, f64),
}

/// A range with some room at its ends.
pub(super) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if !(low.is_finite() && high.is_finite()) {
        return (0.0, 1.0);
    }
    // a difference only in the fifth digit is drawn level
    let room = (0.08 * (high - low)).max(1e-4 * low.abs().max(high.abs())).max(1e-12);
    (low - room, high + room)
}

impl Plane {
    pub fn point(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let across = (x - self.x.0) / (self.x.1 - self.x.0);
        let up = (y - self.y.0) / (self.y.1 - self.y.0);
        (self.frame.x + across * self.frame.width, self.frame.y + (1.0 - up) * self.frame.height)
    }

    /// Writes the data of the diagram for the script of the page: the axes by name and unit, and the series.
    pub fn readings(&self, svg: &mut Svg, [x, y]: [(&str, &str); 2], series: Vec<Series>) {
        let axis = |(name, unit): (&str, &str)| Axis { unit: unit.to_owned().into(), ..Axis::new(name, ("", 1.0)) };
        let chart = Chart { series, ..Chart::new(axis(x), axis(y)) };
        let plane = plane::Plane { frame: self.frame, x: self.x, y: self.y, downwards: false, logarithmic: [false; 2] };
        readings::write(svg, &chart, &plane);
    }

    /// Level lines with their values.
    pub fn upright_scale(&self, svg: &mut Svg) {
        let Frame { x: left, y: top, width, height } = self.frame;
        let count = (height / 26.0) as usize;
        let step = nice_step((self.y.1 - self.y.0) / count.max(1) as f64);
        for mark in ticks(self.y.0, self.y.1, count) {
            let y = self.point((self.x.0, mark)).1;
            svg.line("grid", (left, y), (left + width, y));
            svg.text("small muted", (left - 7.0, y + 4.0), Anchor::End, &tick_label(mark, step));
        }
        svg.line("axis", (left, top), (left, top + height));
        svg.line("axis", (left, top + height), (left + width, top + height));
    }

    /// A dashed level line: the scene as it is.
    pub fn as_it_is(&self, svg: &mut Svg, y: f64, title: &str) {
        let Frame { x: left, width, .. } = self.frame;
        let y = self.point((self.x.0, y)).1;
        svg.path("mark", &[(left, y), (left + width, y)], false, title);
        svg.text("small halo", (left + width - 4.0, y - 4.0), Anchor::End, "as it is");
    }

    pub fn level_scale(&self, svg: &mut Svg) {
        let count = (self.frame.width / 45.0) as usize;
        let step = nice_step((self.x.1 - self.x.0) / count.max(1) as f64);
        for mark in ticks(self.x.0, self.x.1, count) {
            self.mark(svg, mark, 0, &tick_label(mark, step));
        }
    }

    /// A mark of the level scale, its label in that row below it.
    pub fn mark(&self, svg: &mut Svg, x: f64, row: usize, label: &str) {
        let x = self.point((x, self.y.0)).0;
        let bottom = self.frame.y + self.frame.height;
        svg.line("axis", (x, bottom), (x, bottom + 4.0));
        svg.text("small muted", (x, bottom + 17.0 + 13.0 * row as f64), Anchor::Middle, label);
    }
}

/// `max(settlement) [mm]`
pub(super) fn titled(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// A text cut to what fits.
pub(super) fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['\u{2026}']).collect()
}
