//! L1006: the settlement between two exchanges is so large that the loop overshoots.
//!
//! The exchange is forward Euler in axles: a perturbation is amplified by 1 - A with A = (dS/dF) k_eff for the block's
//! settlement S at peak force F, and k_eff at most the series of pad and support. A > 1 overshoots, A > 2 may grow. The
//! first block is the worst: laws harden.

use super::led;
use super::winkler::seat_loads;
use crate::diag::{Code, Diagnostic};
use crate::graph::{Block, Graph};
use crate::scenario::Scenario;
use crate::solvers::settlement::{Law, Peak};
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    let Some(wanted) = traffic.blocks.wanted(0) else { return Vec::new() };
    let first = traffic.blocks.block(0, wanted);
    if graph.laws().next().is_none() {
        return Vec::new();
    }
    let mut worst: Option<(f64, f64)> = None;
    for seat in seat_loads(scenario, graph, traffic) {
        for law in scenario.driving_laws_of(seat.section) {
            let settled = |share: f64| first_block(&law.law, seat.peak.scaled(share), &first);
            // 1 % to either side
            let slope = (settled(1.01) - settled(0.99)) / (0.02 * seat.peak.force);
            let amplification = slope * seat.winkler.modulus * seat.spacing;
            if seat.peak.force > 0.0 && worst.is_none_or(|(a, _)| amplification > a) {
                worst = Some((amplification, settled(1.0)));
            }
        }
    }
    let Some((amplification, settled)) = worst.filter(|(a, _)| *a > 1.0) else { return Vec::new() };
    let diagnostic = Diagnostic::new(
        Code::L1006,
        format!(
            "the first {} axles cause {} mm of settlement before forces are computed again: the next exchange \
             multiplies an error by {}",
            first.axles,
            number((settled * 1e5).round() / 1e2),
            number(((amplification - 1.0).abs() * 10.0).round() / 10.0)
        ),
    )
    .help("write `update_every = adaptive`")
    .rewrite(scenario.solve.update_span, "adaptive");
    vec![match scenario.solve.update_span {
        Some(span) => diagnostic.label(span, "block too long"),
        None => diagnostic,
    }]
}

/// Settlement of a fresh support under the equal wheels of one block, m.
fn first_block(law: &Law, peak: Peak, block: &Block) -> f64 {
    let mut support = law.fresh();
    let trains = block.trains().max(1);
    support.load(&vec![peak; (block.axles / trains) as usize], trains);
    support.settlement()
}
