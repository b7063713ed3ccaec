//! Divides the axles of a run into blocks, between which forces and settlement are exchanged.

use super::{Pass, estimate, passage};
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::Blocks;
use crate::scenario::{Scenario, Traffic, Train, Update};

pub(super) fn blocks(pass: &mut Pass, scenario: &Scenario, traffic: &Traffic) -> Option<Blocks> {
    let train = &traffic.train;
    let plan = passage::plan(pass, scenario, train);
    let total = *traffic.total;
    let axles = train.axles();
    let mut sound = divides(pass, total, train, "the run", traffic.total.origin.span());
    let mut update = scenario.solve.update;
    match &mut update {
        // nobody chose the default for this train
        Update::Geometric { first, .. } if scenario.solve.update_span.is_none() => {
            *first = first.div_ceil(axles) * axles
        }
        Update::Geometric { first, .. } => {
            sound &= divides(pass, *first, train, "the first block", scenario.solve.update_span)
        }
        Update::Fixed { axles } => {
            sound &= divides(pass, *axles, train, "an update interval", scenario.solve.update_span)
        }
        Update::Adaptive { .. } => {}
    }
    let mut recorded: Vec<u64> =
        scenario.records.iter().flat_map(|r| r.after.iter().copied()).chain([0, total]).collect();
    recorded.sort_unstable();
    recorded.dedup();
    for count in recorded.iter().filter(|c| *c % axles != 0 && **c != total) {
        pass.diagnostics.push(
            Diagnostic::new(
                Code::E0602,
                format!("{count} recorded axles are no whole number of trains of {axles} axles"),
            )
            .help(format!("record after {} axles", (count / axles).max(1) * axles)),
        );
        sound = false;
    }
    if !sound {
        return None;
    }
    let blocks = Blocks { train: train.clone(), passage: plan?, update, cure: true, recorded, total };
    if axles < total {
        let trains = total / axles;
        let why = "trains of one block run over the same settled track, so one passage gives the forces of all";
        match blocks.planned() {
            Some(planned) => {
                let passages: usize = planned.iter().map(|block| blocks.passages(block).len()).sum();
                pass.decide("share", format!("{} passages stand for {trains} trains", passages + 1), why)
            }
            None => pass.decide(
                "share",
                format!("about {} passages stand for {trains} trains", estimate::passages(&blocks)),
                why,
            ),
        }
    }
    Some(blocks)
}

/// Whether a count is a whole number of trains.
fn divides(pass: &mut Pass, count: u64, train: &Train, what: &str, span: Option<Span>) -> bool {
    let axles = train.axles();
    if count.is_multiple_of(axles) && count > 0 {
        return true;
    }
    let below = (count / axles).max(1) * axles;
    let mut mistake =
        Diagnostic::new(Code::E0602, format!("{what} of {count} axles is no whole number of trains of {axles} axles"))
            .help(if count < axles {
                format!("write `{axles} axles`")
            } else {
                format!("write `{below} axles` or `{} axles`", below + axles)
            });
    if let Some(span) = span {
        mistake = mistake.at(span, "does not divide");
    }
    pass.diagnostics.push(mistake);
    false
}
