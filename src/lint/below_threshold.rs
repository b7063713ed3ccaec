//! L1008: under a law with a threshold, no sleeper carries enough to settle.
//!
//! The seat load is the static load of a beam on a Winkler foundation; the dynamic part is not known before a run.

use super::led;
use super::winkler::seat_loads;
use super::{acts_in, laws, pointed};
use crate::diag::{Code, Diagnostic};
use crate::graph::Graph;
use crate::scenario::{Scenario, SettlementLaw};
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    if graph.laws().next().is_none() {
        return Vec::new();
    }
    let seats = seat_loads(scenario, graph, traffic);
    let most = |law: &SettlementLaw| {
        let here = seats.iter().filter(|seat| acts_in(scenario, law, seat.section));
        here.max_by(|a, b| a.peak.force.total_cmp(&b.peak.force))
    };
    let below = laws(scenario).filter_map(|law| Some((law, law.law.threshold()?, most(law)?)));
    let kilonewtons = |force: f64| number((force / 1e2).round() / 10.0);
    below
        .filter(|(_, threshold, most)| most.peak.force <= *threshold)
        .map(|(law, threshold, most)| {
            let diagnostic = Diagnostic::new(
                Code::L1008,
                format!(
                    "law `{}` gives no settlement below {} kN per seat, but wheels of {} kN at rest give at most \
                     about {} kN",
                    law.name,
                    kilonewtons(threshold),
                    kilonewtons(most.wheel),
                    kilonewtons(most.peak.force)
                ),
            )
            .help("give the law thresholds calibrated for these loads, or choose a law without a threshold");
            pointed(diagnostic, scenario, law, "its threshold is above every seat load")
        })
        .collect()
}
