//! Settlement of a scene by the law tier, before its grains are placed.

use crate::diag::has_errors;
use crate::execute::{Event, Executor, Listener};
use crate::graph::{Graph, Schedule};
use crate::lower::Planner;
use crate::lower::memo::Memo;
use crate::scenario::{Given, Scenario, Tier, TimeStep, Update};
use std::ops::ControlFlow;

/// Blocks for the law: six passages for five hundred axles, because only the shape of the result is used.
const FIRST: u64 = 4;
const RATIO: f64 = 3.0;

/// Elements and steps for the law, coarser than in a run: settlements of the shipped scenes `transition`,
/// `transition_full`, `transition_short` and `bridge` differ by at most 2e-4 of the largest, in a third of the time.
const ELEMENTS: u32 = 2;
const STEPS: f64 = 1e-3;

/// Blocks after which the law stops. The plan counts fewer: thirteen for two million axles. Blocks that overshoot are
/// repeated in halves, and the following ones stay short: a million axles of one wagon on 40 MN/m per seat took 42 s.
const MOST: usize = 16;

/// Longest run of the law by its plan, s on one core: a check must stay short, also of a train at walking pace.
const LONGEST: f64 = 20.0;

/// Settlements of the last plans: the run of the law is the longest part of a check.
static SETTLED: Memo<Graph, Option<Vec<f64>>> = Memo::new(4);

/// Settlement of every seat by the law of a scene with `cells`, `zone` or `check_cells`, m, after all axles or after
/// [`MOST`] blocks; `None` for any other scene, and if the law cannot run in [`LONGEST`].
pub fn settlement(planner: &Planner, scenario: &Scenario) -> Option<Vec<f64>> {
    let grains = &scenario.solve.grains;
    if !matches!(*grains.tier, Tier::Cells | Tier::Zone) && *grains.check_cells == 0 {
        return None;
    }
    let mut by_law = scenario.clone();
    by_law.solve.grains.tier = Given { value: Tier::Law, origin: grains.tier.origin };
    by_law.solve.grains.check_cells.value = 0;
    by_law.solve.update = Update::Geometric { first: FIRST, ratio: RATIO };
    let elements = &mut by_law.solve.elements_per_bay;
    elements.value = elements.value.min(ELEMENTS);
    by_law.solve.time_step = TimeStep::Adaptive { tolerance: Given::derived(STEPS) };
    by_law.records.clear();
    let lowered = planner.lower(&by_law);
    let runs = |graph: &Graph| graph.runs && graph.cost.seconds <= LONGEST && !has_errors(&lowered.diagnostics);
    let mut graph = lowered.graph.as_ref().filter(|graph| runs(graph))?.clone();
    if let Schedule::Blocks(blocks) = &mut graph.schedule {
        blocks.compared = None;
    }
    SETTLED.get(graph, run)
}

fn run(graph: &Graph) -> Option<Vec<f64>> {
    let mut last = Last::default();
    Executor::default().run(graph, &mut last, None).ok()?;
    last.settlement
}

/// The settlement after the last block.
#[derive(Default)]
struct Last {
    blocks: usize,
    settlement: Option<Vec<f64>>,
}

impl Listener for Last {
    fn hear(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        if let Event::Block { after, .. } = event {
            self.settlement = Some(after.to_vec());
            self.blocks += 1;
        }
        if self.blocks < MOST { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}
