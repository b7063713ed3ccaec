//! L1006: so much settles between two exchanges that the loop overshoots.
//!
//! The exchange is forward Euler in axles: a perturbation is amplified by 1 - A with A = (dS/dF) k_eff, dS/dF = (1 + alpha)
//! S/F for the block's settlement S at peak force F, and k_eff at most the series of pad and support. A > 1 overshoots,
//! A > 2 may grow. The first block is the worst: laws harden.

use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Schedule, SubstructureNode};
use crate::scenario::Scenario;
use crate::solvers::settlement::Law;
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Vec::new() };
    let Some(wanted) = blocks.wanted(0) else { return Vec::new() };
    let first = blocks.block(0, wanted);
    let SubstructureNode::Law { law, .. } = &graph.substructure else { return Vec::new() };
    let Law::Varandas(varandas) = law;
    let track = &scenario.track;
    let mut worst: Option<(f64, f64)> = None;
    for section in 0..track.sections.len() {
        let ballasted = track.seats.iter().any(|s| s.section == section && s.is_ballasted());
        let Some(winkler) = Winkler::of(track, section).filter(|_| ballasted) else { continue };
        let spacing = *track.sections[section].spacing;
        let wheel = blocks.train.vehicles.iter().map(|v| v.mass()).fold(0.0, f64::max) / 4.0 * *scenario.solve.gravity;
        let force = wheel * winkler.seat_share(spacing);
        let settled = first_block(law, force, first.axles);
        let amplification = (1.0 + varandas.alpha) * settled / force * winkler.modulus * spacing;
        if force > 0.0 && worst.is_none_or(|(a, _)| amplification > a) {
            worst = Some((amplification, settled));
        }
    }
    let Some((amplification, settled)) = worst.filter(|(a, _)| *a > 1.0) else { return Vec::new() };
    let diagnostic = Diagnostic::new(
        Code::L1006,
        format!(
            "the first {} axles settle {} mm before forces are computed anew: an error of one exchange comes back {} times as large",
            first.axles,
            number((settled * 1e5).round() / 1e2),
            number(((amplification - 1.0).abs() * 10.0).round() / 10.0)
        ),
    )
    .help("write `update_every = adaptive`");
    vec![match scenario.solve.update_span {
        Some(span) => diagnostic.at(span, "too long a block"),
        None => diagnostic,
    }]
}

/// Settlement under `axles` equal peaks, m.
fn first_block(law: &Law, force: f64, axles: u64) -> f64 {
    let mut support = law.fresh();
    law.add_cycles(&mut support, force, axles);
    law.settlement(&support)
}
