//! L1028: the ballast under the sleepers is thicker than on any track.
//!
//! Railways lay 250 .. 350 mm under the sleeper, up to 500 mm on old lines that were lifted often (UIC 719, unchecked;
//! Ahmadi et al. 2026 have 300 mm). A larger thickness has a wrong unit, or includes the sub-ballast and the soil.

use super::strata::{grounds, is_ballast};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::Scenario;
use crate::units::number;

/// m.
const THICKEST: f64 = 1.0;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for ground in grounds(scenario, graph) {
        let Some(layer) = ground.layers.first().filter(|layer| layer.granular().is_some_and(is_ballast)) else {
            continue;
        };
        let thickness = layer.thickness.largest();
        if thickness <= THICKEST * (1.0 + 1e-9) {
            continue;
        }
        let message = format!(
            "{} m of ballast `{}` lie under the sleepers of `{}`",
            number((thickness * 1e3).round() / 1e3),
            layer.name,
            ground.section
        );
        let diagnostic = Diagnostic::new(Code::L1028, message).help(
            "250 .. 350 mm is usual, 500 mm is the most: write for example `300 mm`, and give deeper layers separately",
        );
        let diagnostic = match layer.thickness.origin().span() {
            Some(span) => diagnostic.label(span, "this thickness"),
            None => diagnostic,
        };
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}
