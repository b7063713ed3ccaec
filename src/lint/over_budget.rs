//! L1022: the run is expected to take more time or memory than the scene allows.
//!
//! The plan has the estimate: passages x steps x unknowns x a measured cost, and bytes per unknown; for a test rig
//! steps x pebbles x a measured cost. Only plans that this version runs have an estimate.

use crate::diag::{Code, Diagnostic};
use crate::graph::{Cost, Graph, PassageWork, TestWork, Work};
use crate::scenario::{Given, Scenario};
use crate::units::{duration, number};

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    if !graph.runs {
        return Vec::new();
    }
    let grains = &scenario.solve.grains;
    let found = match graph.cost.work {
        Work::Passages(work) => {
            let unknowns = format!("{} unknowns", work.unknowns);
            [of_passages(&graph.cost, work, grains.budget), memory(&graph.cost, &unknowns, grains.memory)]
        }
        Work::Tests(work) => {
            let pebbles = format!("{} pebbles", about(work.pebbles));
            [of_tests(&graph.cost, work, grains.budget), memory(&graph.cost, &pebbles, grains.memory)]
        }
    };
    found.into_iter().flatten().collect()
}

fn of_passages(cost: &Cost, work: PassageWork, budget: Option<Given>) -> Option<Diagnostic> {
    let budget = budget.filter(|budget| cost.seconds > **budget)?;
    let message = format!(
        "the run is expected to take {} on one core, more than its budget of {}: {} passages, {} steps in all",
        duration(cost.seconds),
        duration(*budget),
        work.passages,
        work.steps
    );
    Some(said(message, budget, "use fewer axles, longer blocks, a longer step or fewer elements"))
}

fn memory(cost: &Cost, holds: &str, memory: Option<Given>) -> Option<Diagnostic> {
    let bytes = cost.bytes as f64;
    let memory = memory.filter(|memory| bytes > **memory)?;
    let message = format!(
        "the run is expected to take {} MiB for {holds}, more than the limit of {} MiB",
        number((bytes / MIB).ceil()),
        number((*memory / MIB).floor())
    );
    Some(said(message, memory, LESS_MEMORY))
}

fn of_tests(cost: &Cost, work: TestWork, budget: Option<Given>) -> Option<Diagnostic> {
    let seconds = cost.seconds_on_two_cores;
    let budget = budget.filter(|budget| seconds > **budget)?;
    let message = format!(
        "the test is expected to take {} on two cores, more than its budget of {}: {} grains, {} steps, {}",
        duration(seconds),
        duration(*budget),
        about(work.grains),
        about(work.packing_steps + work.test_steps),
        match work.packings {
            1 => "one packing".to_owned(),
            several => format!("{several} packings"),
        }
    );
    Some(said(message, budget, "use fewer cycles or packings, a larger `cut_below` or larger grains (`scale`)"))
}

/// The value with two significant digits.
fn about(value: f64) -> String {
    number(format!("{value:.1e}").parse().unwrap_or(value))
}

/// Advice for a run that needs too much memory.
pub(crate) const LESS_MEMORY: &str =
    "use a shorter track, fewer elements, a shorter `window` or larger grains (`scale`, `cut_below`)";

const MIB: f64 = (1u64 << 20) as f64;

fn said(message: String, limit: Given, help: &str) -> Diagnostic {
    let diagnostic = Diagnostic::new(Code::L1022, message).help(help);
    match limit.origin.span() {
        Some(span) => diagnostic.label(span, "the limit"),
        None => diagnostic,
    }
}
