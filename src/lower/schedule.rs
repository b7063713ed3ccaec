//! Divides the axles of a run into blocks, between which forces and settlement are exchanged.

use super::{Pass, passage};
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::{Block, Blocks};
use crate::scenario::{Direction, Scenario, Traffic, Train, Update};

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
    let blocks = divide(update, total, &recorded, train);
    if axles < total {
        pass.decide(
            "share",
            format!("{} passages stand for {} trains", blocks.len() + 1, total / axles),
            "trains of one block run over the same settled track, so one passage gives the forces of all",
        );
    }
    Some(Blocks { train: train.clone(), passage: plan?, blocks, recorded, total })
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

/// Blocks of whole trains that end at every recorded count.
fn divide(update: Update, total: u64, recorded: &[u64], train: &Train) -> Vec<Block> {
    let axles = train.axles();
    let mut blocks = Vec::new();
    let mut before = 0;
    let mut trains_before = 0;
    while before < total {
        let wanted = match update {
            Update::Fixed { axles } => axles,
            Update::Geometric { first, ratio } => first.max((ratio * before as f64) as u64 / axles * axles),
        };
        let stop = recorded.iter().copied().find(|c| *c > before).unwrap_or(total);
        let size = wanted.min(stop - before);
        let trains = size / axles;
        let (forward, backward) = match train.direction {
            Direction::Forward => (trains, 0),
            Direction::Backward => (0, trains),
            // the first of every two trains of the run goes forward
            Direction::Both if trains_before % 2 == 0 => (trains.div_ceil(2), trains / 2),
            Direction::Both => (trains / 2, trains.div_ceil(2)),
        };
        blocks.push(Block { before, axles: size, forward, backward });
        before += size;
        trains_before += trains;
    }
    blocks
}
