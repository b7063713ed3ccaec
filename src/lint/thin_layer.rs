//! L1009: a layer of grains is only a few of its coarse grains thick.
//!
//! `h / D90`, with the smallest thickness and the size that nine tenths of the modelled mass pass. A grain that reaches
//! from the floor to the sleeper is a strut under any contact law. Forces spread in a bed that is about four grains
//! thick.

use super::grains::{beds, mm, of_sizes};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Varying};
use crate::units::number;

/// Coarse grains across a layer.
const FEWEST: f64 = 4.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for bed in beds(scenario, graph) {
        let (thickness, coarse) = (bed.layer.thickness.smallest(), bed.granular.grading.d(90.0));
        if thickness <= 0.0 || thickness >= FEWEST * coarse * (1.0 - 1e-9) {
            continue;
        }
        let diagnostic = Diagnostic::new(
            Code::L1009,
            format!(
                "layer `{}` of `{}` is {} mm thick, only {} of its coarse grains, D90 = {} mm",
                bed.layer.name,
                bed.section.name,
                mm(thickness),
                number((thickness / coarse * 100.0).round() / 100.0),
                mm(coarse)
            ),
        )
        .help(format!(
            "forces spread in a layer of at least {} mm ({FEWEST} x D90): make it thicker, or use grains of D90 = {} \
             mm",
            mm(FEWEST * coarse),
            mm((thickness / FEWEST * 1e3).floor() / 1e3)
        ));
        let thickness_span = match &bed.layer.thickness {
            Varying::Constant(given) => given.origin.span(),
            Varying::Profile(profile) => profile.origin.span(),
        };
        let diagnostic = match thickness_span {
            Some(span) => diagnostic.label(span, "this thickness"),
            None => diagnostic,
        };
        found.push(match of_sizes(bed.granular).span() {
            Some(span) => diagnostic.label(span, format!("grains of `{}`", bed.layer.name)),
            None => diagnostic,
        });
    }
    found
}
