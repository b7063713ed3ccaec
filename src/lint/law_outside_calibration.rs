//! L1004: a settlement law is asked about forces or axle counts that it was not calibrated for.

use super::winkler::Winkler;
use crate::diag::{Code, Diagnostic};
use crate::graph::{Graph, Schedule};
use crate::scenario::Scenario;
use crate::units::number;

pub(super) fn check(scenario: &Scenario, graph: &Graph) -> Vec<Diagnostic> {
    let Schedule::Blocks(blocks) = &graph.schedule else { return Vec::new() };
    let law = &scenario.solve.law;
    let mut found = Vec::new();
    if let Some((_, most)) = law.cycles.filter(|(_, most)| blocks.total as f64 > *most) {
        found.push(
            Diagnostic::new(
                Code::L1004,
                format!("law `{}` is calibrated up to {} axles, the run has {}", law.name, number(most), blocks.total),
            )
            .help("read what lies beyond as an extrapolation, or give a law for more axles"),
        );
    }
    let track = &scenario.track;
    for section in 0..track.sections.len() {
        let ballasted = track.seats.iter().any(|s| s.section == section && s.is_ballasted());
        let Some(winkler) = Winkler::of(track, section).filter(|_| ballasted) else { continue };
        let wheel = blocks.train.vehicles.iter().map(|v| v.mass()).fold(0.0, f64::max) / 4.0 * *scenario.solve.gravity;
        let seat = wheel * winkler.seat_share(*track.sections[section].spacing);
        if let Some((least, most)) = law.loads.filter(|(least, most)| seat < *least || seat > *most) {
            found.push(
                Diagnostic::new(
                    Code::L1004,
                    format!(
                        "law `{}` is calibrated for {} .. {} kN a seat, static wheels give about {} kN in section `{}`",
                        law.name,
                        number(least / 1e3),
                        number(most / 1e3),
                        number((seat / 1e3).round()),
                        track.sections[section].name
                    ),
                )
                .help("choose a law that covers these loads, or read its settlement as an extrapolation"),
            );
        }
    }
    found
}
