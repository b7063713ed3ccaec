//! Content of a diagram: axes with units, curves, shaded stretches and reference lines. Data are SI.

use super::plane::finite;
use std::borrow::Cow;

/// A direction of the diagram.
#[derive(Debug, Clone)]
pub struct Axis {
    pub label: String,
    pub unit: Cow<'static, str>,
    /// Size of the shown unit in SI.
    pub size: f64,
    /// Larger values stand lower: settlement and deflection.
    pub downwards: bool,
    /// In SI; the extent of the data where absent.
    pub range: Option<(f64, f64)>,
    pub from_zero: bool,
    /// Powers of ten at equal distances; values are above zero. Not used for bars and second scales.
    pub logarithmic: bool,
    /// Marks at whole numbers only: counts of few things.
    pub whole: bool,
}

impl Axis {
    pub fn new(label: &str, (unit, size): (&'static str, f64)) -> Self {
        Axis {
            label: label.to_owned(),
            unit: unit.into(),
            size,
            downwards: false,
            range: None,
            from_zero: false,
            logarithmic: false,
            whole: false,
        }
    }

    /// Chainage, m.
    pub fn chainage(range: (f64, f64)) -> Self {
        Axis { range: Some(range), ..Axis::new("Chainage", ("m", 1.0)) }
    }

    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} [{}]", self.label, self.unit) }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    Line,
    /// A thin line behind the others, without a place in the legend.
    Faint,
    /// A line with a dot at every value.
    Dots,
    /// Bars of this width in SI from zero.
    Bars(f64),
}

#[derive(Debug, Clone)]
pub struct Series {
    /// Empty keeps it out of the legend.
    pub name: String,
    /// Its colour: `k0`..`k5` for axle counts, `s0`..`s3` otherwise.
    pub class: String,
    pub mark: Mark,
    pub points: Vec<(f64, f64)>,
    /// Label of each point, shown under the pointer.
    pub labels: Vec<String>,
    /// Whether it is drawn paler, because its values are less certain.
    pub pale: bool,
    /// Upright values at each step of a chart that moves, over the places of `points`, which hold the last step.
    pub moving: Vec<Vec<f64>>,
}

impl Series {
    pub fn new(name: &str, class: &str, mark: Mark, points: Vec<(f64, f64)>) -> Self {
        Series {
            name: name.to_owned(),
            class: class.to_owned(),
            mark,
            points,
            labels: vec![],
            pale: false,
            moving: vec![],
        }
    }
}

/// A shaded stretch of the x axis.
#[derive(Debug, Clone)]
pub struct Band {
    pub from: f64,
    pub to: f64,
    pub label: String,
    pub class: &'static str,
}

#[derive(Debug, Clone)]
pub struct Chart {
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub bands: Vec<Band>,
    /// Dashed upright lines, SI.
    pub uprights: Vec<f64>,
    /// Dotted level lines with a name, SI.
    pub levels: Vec<(f64, String)>,
    /// Places of numbered seats, for the upper edge; SI.
    pub seats: Vec<(f64, i32)>,
    /// A second scale of the upright axis: its title, and its value per SI of the first.
    pub second: Option<(String, f64)>,
    /// Names of the steps through which the page's script moves the curves; none if the curves do not move.
    pub steps: Vec<String>,
}

impl Chart {
    pub fn new(x: Axis, y: Axis) -> Self {
        let (series, bands, uprights, levels) = (vec![], vec![], vec![], vec![]);
        Chart { x, y, series, bands, uprights, levels, seats: vec![], second: None, steps: vec![] }
    }

    /// Whether there is anything to see.
    pub fn is_empty(&self) -> bool {
        !self.series.iter().any(|series| series.points.iter().any(finite))
    }

    /// The series in whose legend entry a series is counted: itself, or the named one of its colour.
    pub fn entry(&self, index: usize) -> usize {
        let class = &self.series[index].class;
        let named = |other: &usize| !self.series[*other].name.is_empty() && self.series[*other].mark != Mark::Faint;
        let alike = (0..self.series.len()).filter(|other| self.series[*other].class == *class && named(other));
        if named(&index) { index } else { alike.min_by_key(|other| other.abs_diff(index)).unwrap_or(index) }
    }
}
