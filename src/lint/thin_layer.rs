//! L1009: a layer of grains holds so few of its coarse grains that it is no layer.
//!
//! `h / D90`, with the thickness where it is least and the size that nine tenths of the modelled mass pass. A grain that reaches from
//! floor to sleeper is a strut, whatever the contact law says; about four across make a bed in which forces spread.

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
                "layer `{}` of `{}` is {} mm thick, {} of its coarse grains, D90 = {} mm",
                bed.layer.name,
                bed.section.name,
                mm(thickness),
                number((thickness / coarse * 100.0).round() / 100.0),
                mm(coarse)
            ),
        )
        .help(format!(
            "{FEWEST} of them, {} mm, make a layer in which forces spread: thicken it, or take grains of D90 = {} mm",
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
