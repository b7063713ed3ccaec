//! L1029: sleepers lie on sand or soil that lies on ballast.
//!
//! Layers are listed downwards. Ballast comes first, because it drains and carries the pressure of the sleepers. Finer
//! grains above the ballast fall into its pores.

use super::strata::{grounds, is_ballast};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Layer, Scenario};

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> = Vec::new();
    for ground in grounds(scenario, graph) {
        let ballast = |layer: &&Layer| layer.granular().is_some_and(is_ballast);
        let Some((top, below)) = ground.layers.split_first().filter(|(top, _)| !ballast(top)) else { continue };
        let Some(ballast) = below.iter().find(ballast) else { continue };
        let message = format!(
            "the sleepers of `{}` lie on `{}`, and the ballast `{}` lies below it",
            ground.section, top.name, ballast.name
        );
        let diagnostic = Diagnostic::new(Code::L1029, message).help(format!(
            "layers are listed downwards from the sleepers: write `{}` before `{}`",
            ballast.name, top.name
        ));
        let labels = [(top, "under the sleepers"), (ballast, "ballast")];
        let diagnostic =
            labels.into_iter().fold(diagnostic, |d, (layer, text)| match layer.thickness.origin().span() {
                Some(span) => d.label(span, text),
                None => d,
            });
        if !found.contains(&diagnostic) {
            found.push(diagnostic);
        }
    }
    found
}
