//! L1018: the bed of grains is so narrow or short that its walls affect the arrangement of the grains.
//!
//! Ratio of a side of the bed to D90, the size that nine tenths of the modelled mass pass. Across, the side is the
//! width between side wall and middle of the track (or both side walls); along, it is a cell of three bays or the
//! window. Laboratories ask for six grains across a specimen (ASTM D4767, not at hand).

use super::grains::{GrainLayer, beds, mm, of_sizes};
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::Graph;
use crate::scenario::{Scenario, Tier};
use crate::units::number;

/// Coarse grains between two walls.
const FEWEST: f64 = 6.0;
/// Bays of the longest periodic cell.
const BAYS: f64 = 3.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let coarsest = beds(scenario, graph)
        .into_iter()
        .max_by(|a, b| a.granular.grading.d(90.0).total_cmp(&b.granular.grading.d(90.0)));
    let Some(bed) = coarsest else { return Vec::new() };
    let sides = [across(scenario), along(scenario, &bed)];
    let narrow = sides.into_iter().flatten().filter(|side| side.length < FEWEST * bed.granular.grading.d(90.0));
    narrow.map(|side| said(&side, &bed)).collect()
}

/// A side of the bed.
struct Side {
    what: &'static str,
    /// m.
    length: f64,
    span: Option<Span>,
}

fn said(side: &Side, bed: &GrainLayer<'_>) -> Diagnostic {
    let coarse = bed.granular.grading.d(90.0);
    let diagnostic = Diagnostic::new(
        Code::L1018,
        format!(
            "the bed is {} m {}, only {} coarse grains of `{}`, D90 = {} mm",
            number((side.length * 1e3).round() / 1e3),
            side.what,
            number((side.length / coarse * 10.0).round() / 10.0),
            bed.layer.name,
            mm(coarse)
        ),
    )
    .help(format!(
        "make it at least {} m ({FEWEST} x D90); otherwise the walls affect the result",
        number(FEWEST * coarse)
    ));
    match side.span.or_else(|| of_sizes(bed.granular).span()) {
        Some(span) => diagnostic.label(span, "too few grains"),
        None => diagnostic,
    }
}

fn across(scenario: &Scenario) -> Option<Side> {
    let track = &scenario.track;
    let shoulder = |section: usize| track.sections[section].crib.map_or(0.0, |crib| crib.beyond());
    let reach = track.seats.iter().filter_map(|seat| Some(seat.sleeper?.length / 2.0 + shoulder(seat.section)));
    let half = track.bed.half_width.map(|width| *width).or(reach.reduce(f64::max))?;
    let span = track.bed.half_width.and_then(|width| width.origin.span());
    let sides = if scenario.solve.grains.both_rails { 2.0 } else { 1.0 };
    Some(Side { what: "wide", length: sides * half, span })
}

fn along(scenario: &Scenario, bed: &GrainLayer<'_>) -> Option<Side> {
    if *scenario.solve.grains.tier == Tier::Cells {
        let spacing = bed.section.spacing;
        return Some(Side { what: "long, a cell of three bays", length: BAYS * *spacing, span: spacing.origin.span() });
    }
    let window = scenario.solve.grains.window.iter().flatten().map(|[a, b]| b - a).reduce(f64::min);
    let length = window.unwrap_or(bed.section.end - bed.section.start);
    let span = if window.is_some() { None } else { bed.section.length_origin.span() };
    Some(Side { what: "long", length, span })
}
