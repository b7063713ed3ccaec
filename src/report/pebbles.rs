//! Accuracy and cost of pebbles: the error of shape and the number of contact tests against the number of pebbles.

use super::curves::{Axis, Chart, Mark, Series};
use super::svg::{Anchor, Frame, Svg};
use super::view::WIDTH;

/// Clumps of so many pebbles, averaged over surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PebbleRow {
    pub pebbles: usize,
    /// Share of the volume that differs between clump and surface.
    pub volume: f64,
    /// Mean distance of the surfaces over the size of the grain.
    pub distance: f64,
    /// Error of the inertia tensor, as a share.
    pub inertia: f64,
    /// Pairs of pebbles that are tested for a pair of grains that touch.
    pub tests: f64,
}

/// Shape error and cost side by side.
pub fn grain_pebbles_svg(rows: &[PebbleRow]) -> String {
    let mut svg = Svg::default();
    svg.text("strong", (6.0, 18.0), Anchor::Start, "Shape error and cost against the number of pebbles");
    let axis = || Axis { logarithmic: true, range: Some((0.9, 60.0)), ..Axis::new("Pebbles per grain", ("", 1.0)) };
    let of = |value: fn(&PebbleRow) -> f64| rows.iter().map(|row| (row.pebbles as f64, value(row))).collect::<Vec<_>>();
    let mut left = Chart::new(axis(), Axis { from_zero: true, ..Axis::new("Error of shape", ("%", 0.01)) });
    left.series = vec![
        Series::new("volume", "s0", Mark::Dots, of(|row| row.volume)),
        Series::new("mean distance / size", "s1", Mark::Dots, of(|row| row.distance)),
        Series::new("inertia", "s2", Mark::Dots, of(|row| row.inertia)),
    ];
    let mut right =
        Chart::new(axis(), Axis { from_zero: true, ..Axis::new("Pebble pairs tested per pair of grains", ("", 1.0)) });
    right.series = vec![Series::new("", "s3", Mark::Dots, of(|row| row.tests))];
    let frame = |x: f64, width: f64| Frame { x, y: 26.0, width, height: 330.0 };
    left.draw(&mut svg, "pebbles-error", frame(0.0, 0.56 * WIDTH));
    right.draw(&mut svg, "pebbles-cost", frame(0.57 * WIDTH, 0.43 * WIDTH));
    svg.finish(WIDTH, 362.0, "Error of shape and cost against pebbles")
}
