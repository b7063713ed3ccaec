//! L1004: a settlement law is used for forces or axle counts outside its calibration.

use super::led;
use super::winkler::{SeatLoad, seat_loads};
use super::{acts_in, laws, pointed};
use crate::diag::{Code, Diagnostic, Severity};
use crate::graph::Graph;
use crate::scenario::{Scenario, SettlementLaw};
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Some(traffic) = led(scenario, graph) else { return Vec::new() };
    if graph.laws().next().is_none() {
        return Vec::new();
    }
    let seats = seat_loads(scenario, graph, traffic);
    let of_law = |law| {
        let loads = seats.iter().filter(|seat| acts_in(scenario, law, seat.section));
        let loads = loads.filter_map(|seat| beyond_loads(scenario, law, seat)).collect::<Vec<_>>();
        beyond_cycles(scenario, law, traffic.blocks.total).into_iter().chain(loads)
    };
    laws(scenario).flat_map(of_law).collect()
}

fn beyond_cycles(scenario: &Scenario, law: &SettlementLaw, total: u64) -> Option<Diagnostic> {
    let (_, most) = law.cycles.filter(|(_, most)| total as f64 > *most)?;
    let diagnostic = Diagnostic::new(
        Code::L1004,
        format!("law `{}` is calibrated up to {} axles, but the run has {total}", law.name, number(most)),
    )
    .help("read the settlement beyond that count as an extrapolation, or choose a law for more axles");
    Some(refused(pointed(diagnostic, scenario, law, "this law"), law))
}

/// A law that was fitted and states its error does not hold outside: the mistake is an error.
fn refused(diagnostic: Diagnostic, law: &SettlementLaw) -> Diagnostic {
    match law.error {
        Some(_) => diagnostic.severity(Severity::Error).help(
            "fit the law to these loads and counts with `trackbed calibrate --grains`, or remove its `error` to use it \
             as an extrapolation",
        ),
        None => diagnostic,
    }
}

fn beyond_loads(scenario: &Scenario, law: &SettlementLaw, seat: &SeatLoad) -> Option<Diagnostic> {
    let (least, most) = law.loads.filter(|(least, most)| seat.peak.force < *least || seat.peak.force > *most)?;
    let diagnostic = Diagnostic::new(
        Code::L1004,
        format!(
            "law `{}` is calibrated for {} .. {} kN per seat, but wheels at rest give about {} kN in section `{}`",
            law.name,
            number(least / 1e3),
            number(most / 1e3),
            number((seat.peak.force / 1e3).round()),
            scenario.track.sections[seat.section].name
        ),
    )
    .help("choose a law that covers these loads, or read its settlement as an extrapolation");
    Some(refused(pointed(diagnostic, scenario, law, "this law"), law))
}
