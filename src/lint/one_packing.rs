//! L1037: a study compares designs of a track on one packing of its grains.
//!
//! A design changes the forces on all sleepers a little, and other forces move other grains. So results differ without
//! another cause (`docs/mitigations.md`, "On grains").

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, Study};

pub(super) fn check(scenario: &Scenario, graph: &Graph, study: &Study) -> Option<Diagnostic> {
    let several = study.repeats.are_several() || scenario.solve.grains.repeats.are_several();
    let of_packings = study.axes.iter().any(|axis| axis.path == "solve.seed");
    if !graph.runs || !graph.has_grains_under_track() || several || of_packings {
        return None;
    }
    let message = format!(
        "study `{}` compares its points on one packing of grains: results of equal designs differ by about a tenth of the \
         settlement there",
        study.name
    );
    let help = "write `repeats = 3 .. 12` in the study: each point gets as many packings as its difference needs";
    Some(Diagnostic::new(Code::L1037, message).label(study.span, "each point runs on one packing").help(help))
}
