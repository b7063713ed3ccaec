//! L1022: the run is expected to take more time or memory than the scene allows.
//!
//! The estimate is that of the plan: passages x steps x unknowns x a measured cost, and bytes an unknown. Only what this version runs
//! has one.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Given, Scenario};
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let grains = &scenario.solve.grains;
    if grains.tier.has_grains() {
        return Vec::new();
    }
    let (seconds, bytes) = (graph.estimate.seconds, graph.estimate.bytes as f64);
    let time = grains.budget.filter(|budget| seconds > **budget).map(|budget| {
        let message = format!(
            "the run is expected to take {} on one core, its budget is {}: {} passages, {} steps in all",
            duration(seconds),
            duration(*budget),
            graph.estimate.passages,
            graph.estimate.steps
        );
        said(message, budget, "fewer axles, longer blocks, a longer step or fewer elements cost less")
    });
    let memory = grains.memory.filter(|memory| bytes > **memory).map(|memory| {
        let message = format!(
            "the run is expected to take {} MiB for {} unknowns, it may take {} MiB",
            number((bytes / MIB).ceil()),
            graph.estimate.unknowns,
            number((*memory / MIB).floor())
        );
        said(message, memory, "a shorter track or fewer elements take less")
    });
    time.into_iter().chain(memory).collect()
}

const MIB: f64 = (1u64 << 20) as f64;

fn said(message: String, limit: Given, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::L1022, message).help(help);
    match limit.origin.span() {
        Some(span) => diagnostic.at(span, "less than that"),
        None => diagnostic,
    }
}

/// `40 s`, `12.5 min`
fn duration(seconds: f64) -> String {
    let tenth = |x: f64| number((x * 10.0).round() / 10.0);
    if seconds < 120.0 { format!("{} s", tenth(seconds)) } else { format!("{} min", tenth(seconds / 60.0)) }
}
