//! L1019: a sleeper stands on so few grains that single contacts determine its force.
//!
//! Ratio of the width of the sleeper's base to the median grain d50 of the layer under it. Below three the force on the
//! sleeper depends on the packing: another packing gives another force.

use super::grains::{beds, mm};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::Scenario;
use crate::units::number;

/// Median grains under the width of a sleeper.
const FEWEST: f64 = 3.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for bed in beds(scenario, graph).into_iter().filter(|bed| bed.top) {
        let seats = scenario.track.seats[scenario.track.seats_of(bed.index)].iter();
        let Some(width) = seats.filter_map(|seat| seat.sleeper).map(|body| body.base_width).reduce(f64::min) else {
            continue;
        };
        let median = bed.granular.grading.d(50.0);
        if width >= FEWEST * median {
            continue;
        }
        let diagnostic = Diagnostic::new(
            Code::L1019,
            format!(
                "sleepers of `{}` are {} mm wide, only {} median grains of `{}`, d50 = {} mm",
                bed.section.name,
                mm(width),
                number((width / median * 10.0).round() / 10.0),
                bed.layer.name,
                mm(median)
            ),
        )
        .help(
            "the force under one sleeper depends on the packing: use finer ballast, or `repeats` for a confidence band",
        );
        found.push(match bed.granular.density.origin.span() {
            Some(span) => diagnostic.label(span, format!("grains of `{}`", bed.layer.name)),
            None => diagnostic,
        });
    }
    found
}
