//! Sieve curves of the granular layers: the whole curve, and the modelled part.

use super::curves::{Axis, Chart, Mark, Series};
use super::number::plain;
use super::svg::{Anchor, Frame, Svg};
use super::view::WIDTH;
use crate::scenario::{Grading, Scenario};

const HEIGHT: f64 = 300.0;
/// Points of a curve.
const POINTS: usize = 160;

/// Draws the gradings of all layers in one chart; gives the height.
pub(super) fn draw(svg: &mut Svg, scenario: &Scenario) -> f64 {
    let mut found: Vec<(&str, &Grading)> = Vec::new();
    for layer in scenario.track.sections.iter().flat_map(|section| &section.layers) {
        if let Some(granular) = layer.granular()
            && !found.iter().any(|(name, grading)| *name == layer.name && *grading == &granular.grading)
        {
            found.push((&layer.name, &granular.grading));
        }
    }
    if found.is_empty() {
        return 0.0;
    }
    svg.text("strong", (6.0, 18.0), Anchor::Start, "Gradings");
    let (low, high) = range(&found);
    let mut chart = Chart::new(
        Axis { range: Some((low, high)), logarithmic: true, ..Axis::new("Size", ("mm", 1e-3)) },
        Axis { range: Some((0.0, 1.0)), ..Axis::new("Mass passing", ("%", 0.01)) },
    );
    for (index, (name, grading)) in found.iter().enumerate() {
        let class = format!("s{}", index % 4);
        let sizes = || (0..=POINTS).map(|k| low * (high / low).powf(k as f64 / POINTS as f64));
        let whole = sizes().map(|size| (size, grading.passing.share(size))).collect();
        chart.series.push(Series::new("", &class, Mark::Faint, whole));
        let mut modelled: Vec<(f64, f64)> = sizes()
            .filter(|s| *s > grading.smallest() && *s < grading.largest())
            .map(|s| (s, grading.modelled_below(s)))
            .collect();
        modelled.insert(0, (grading.smallest().max(low), 0.0));
        modelled.push((grading.largest().min(high), 1.0));
        chart.series.push(Series::new(name, &class, Mark::Line, modelled));
    }
    chart.draw(svg, "gradings", Frame { x: 0.0, y: 24.0, width: WIDTH, height: HEIGHT });
    let mut y = 24.0 + HEIGHT + 14.0;
    for (name, grading) in &found {
        svg.text("small muted", (6.0, y), Anchor::Start, &caption(name, grading));
        y += 16.0;
    }
    y + 8.0
}

/// `ballast: 96 % of the mass is modelled, 32 to 80 mm; D50 52 mm, D60 / D10 1.6`
fn caption(name: &str, grading: &Grading) -> String {
    let mm = |size: f64| plain(1e3 * size, 3);
    format!(
        "{name}: {} % of the mass is modelled, {} to {} mm; D50 {} mm, D60 / D10 {}; thin lines are the whole curves",
        plain(100.0 * grading.modelled_share(), 3),
        mm(grading.d(0.0)),
        mm(grading.d(100.0)),
        mm(grading.d(50.0)),
        plain(grading.uniformity(), 3)
    )
}

/// Sizes that the chart shows, m: all curves from 1 % to their ends.
fn range(found: &[(&str, &Grading)]) -> (f64, f64) {
    let ends = found.iter().map(|(_, grading)| (grading.passing.size(0.001), grading.passing.size(0.999)));
    let (low, high) = ends.fold((f64::INFINITY, 0.0f64), |(low, high), (a, b)| (low.min(a), high.max(b)));
    (0.8 * low.max(1e-4), 1.25 * high)
}
