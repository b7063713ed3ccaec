//! L1022: the run is expected to take more time or memory than the scene allows.
//!
//! The estimate is that of the plan: passages x steps x unknowns x a measured cost, and bytes an unknown; of a test rig steps x pebbles
//! x a measured cost. Only what this version runs has one.

use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::lower;
use crate::scenario::{Given, Scenario};
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: Option<&Graph>) -> Vec<Diagnostic> {
    match graph {
        Some(_) if scenario.solve.grains.tier.has_grains() => Vec::new(),
        Some(graph) => of_a_run(scenario, graph),
        None => of_a_rig(scenario).into_iter().collect(),
    }
}

fn of_a_run(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let grains = &scenario.solve.grains;
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

fn of_a_rig(scenario: &Scenario) -> Option<Diagnostic> {
    let cost = lower::rig_cost(scenario)?;
    let budget = scenario.solve.grains.budget.filter(|budget| cost.seconds > **budget)?;
    let about = |value: f64| number(format!("{value:.1e}").parse().unwrap_or(value));
    let message = format!(
        "the test is expected to take {} on two cores, its budget is {}: {} grains, {} steps, {}",
        duration(cost.seconds),
        duration(*budget),
        about(cost.grains),
        about(cost.packing_steps + cost.test_steps),
        match cost.repeats {
            1 => "one packing".to_owned(),
            several => format!("{several} packings"),
        }
    );
    Some(said(message, budget, "fewer cycles or packings, a larger `cut_below` or larger grains (`scale`) cost less"))
}

const MIB: f64 = (1u64 << 20) as f64;

fn said(message: String, limit: Given, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::L1022, message).help(help);
    match limit.origin.span() {
        Some(span) => diagnostic.at(span, "less than that"),
        None => diagnostic,
    }
}

/// `40 s`, `12.5 min`, `3.2 h`
fn duration(seconds: f64) -> String {
    let tenth = |x: f64| number((x * 10.0).round() / 10.0);
    match seconds {
        short if short < 120.0 => format!("{} s", tenth(short)),
        middling if middling < 7200.0 => format!("{} min", tenth(middling / 60.0)),
        long => format!("{} h", tenth(long / 3600.0)),
    }
}
