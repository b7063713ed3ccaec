//! Divides the axles of a run into blocks, between which forces and settlement are exchanged.

use super::{Pass, passage};
use crate::diag::{Code, Diagnostic, Span};
use crate::graph::{Blocks, PassagePlan};
use crate::scenario::{Order, Scenario, Share, Traffic, Train, Update};
use crate::units::number;

pub(super) fn blocks(pass: &mut Pass, scenario: &Scenario, traffic: &Traffic) -> Option<Blocks> {
    let plans: Vec<Option<PassagePlan>> =
        traffic.trains().map(|train| passage::plan(pass, scenario, train, traffic.is_mixed())).collect();
    let total = *traffic.total;
    let mut update = scenario.solve.update;
    // counts of a mix have gone to the nearest train
    let mut sound = traffic.is_mixed() || whole_trains(pass, scenario, traffic, &mut update);
    let mut recorded: Vec<u64> =
        scenario.records.iter().flat_map(|r| r.after.iter().copied()).chain([0, total]).collect();
    recorded.sort_unstable();
    recorded.dedup();
    if !traffic.is_mixed() {
        sound &= between_trains(pass, &recorded, total, &traffic.train);
    }
    if !sound || !few_enough(pass, scenario, update, total) {
        return None;
    }
    let sequence = traffic.sequence();
    let turns = sequence.turns().into_iter().map(|position| sequence.axles(position));
    let tamped = scenario.tampings.iter().flat_map(|tamping| tamping.after.iter().copied());
    let mut stops: Vec<u64> = recorded.iter().copied().chain(turns).chain(tamped).collect();
    stops.sort_unstable();
    stops.dedup();
    let mut plans = plans.into_iter();
    let (train, passage) = (traffic.train.clone(), plans.next()??);
    let others = traffic.others.iter().cloned().zip(plans).map(|(train, plan)| Some((train, plan?)));
    let others: Vec<_> = others.collect::<Option<_>>()?;
    let tampings = scenario.tampings.clone();
    let blocks = Blocks { train, passage, others, sequence, update, cure: true, recorded, tampings, stops, total };
    for tamping in &blocks.tampings {
        let after: Vec<String> = tamping.after.iter().map(u64::to_string).collect();
        let what = format!("{} sleepers after {} axles", tamping.seats.len(), after.join(", "));
        let why = format!(
            "`{}` leaves {} % of their settlement; their law begins afresh",
            tamping.name,
            number(100.0 * tamping.left)
        );
        pass.decide("tamping", what, why);
    }
    if traffic.is_mixed() {
        mix(pass, &blocks);
    }
    Some(blocks)
}

/// Blocks of a run at most: each is a passage of every kind of train.
const MOST_BLOCKS: u64 = 20_000;

/// Whether the policy cuts the run into as many blocks as anybody could wait for.
fn few_enough(pass: &mut Pass, scenario: &Scenario, update: Update, total: u64) -> bool {
    let (mut before, mut blocks) = (0, 0);
    while before < total && blocks <= MOST_BLOCKS {
        let Some(axles) = update.axles_after(before) else { return true };
        before += axles.max(1);
        blocks += 1;
    }
    if blocks <= MOST_BLOCKS {
        return true;
    }
    let message =
        format!("{total} axles make more than {MOST_BLOCKS} blocks between two exchanges of forces and settlement");
    let mut mistake = Diagnostic::new(Code::E0103, message)
        .help("let them grow with the axles, `update_every = adaptive(0.003 mm)` or `geometric(4 axles, ratio = 0.2)`");
    if let Some(span) = scenario.solve.update_span {
        mistake = mistake.at(span, "too short");
    }
    pass.diagnostics.push(mistake);
    false
}

/// Whether total and blocks of traffic of one kind are whole trains.
fn whole_trains(pass: &mut Pass, scenario: &Scenario, traffic: &Traffic, update: &mut Update) -> bool {
    let (train, span) = (&traffic.train, scenario.solve.update_span);
    let sound = divides(pass, *traffic.total, train, "the run", traffic.total.origin.span());
    let blocks = match update {
        // nobody chose the default for this train
        Update::Geometric { first, .. } if span.is_none() => {
            *first = first.div_ceil(train.axles()) * train.axles();
            true
        }
        Update::Geometric { first, .. } => divides(pass, *first, train, "the first block", span),
        Update::Fixed { axles } => divides(pass, *axles, train, "an update interval", span),
        Update::Adaptive { .. } => true,
    };
    sound && blocks
}

/// Whether everything that is recorded is recorded between two trains of one kind.
fn between_trains(pass: &mut Pass, recorded: &[u64], total: u64, train: &Train) -> bool {
    let axles = train.axles();
    let within: Vec<u64> = recorded.iter().copied().filter(|count| count % axles != 0 && *count != total).collect();
    for count in &within {
        pass.diagnostics.push(
            Diagnostic::new(
                Code::E0602,
                format!("{count} recorded axles are no whole number of trains of {axles} axles"),
            )
            .help(format!("record after {} axles", (count / axles).max(1) * axles)),
        );
    }
    within.is_empty()
}

/// Says what a mix has become in whole trains.
fn mix(pass: &mut Pass, blocks: &Blocks) {
    let share = |((train, _), share): ((&Train, &PassagePlan), &Share)| {
        let axles = 100.0 * (share.trains * share.axles) as f64 / blocks.total as f64;
        format!("{} of `{}` ({} % of the axles)", share.trains, train.name, number((axles * 100.0).round() / 100.0))
    };
    let shares: Vec<String> = blocks.kinds().zip(&blocks.sequence.shares).map(share).collect();
    let why = match blocks.sequence.order {
        Order::Interleaved => "shares go to the nearest whole train; trains are spread evenly over the run",
        Order::InTurn => "shares go to the nearest whole train; one kind runs after the other",
    };
    pass.decide("mix", format!("{}, {} axles in all", shares.join(", "), blocks.total), why);
}

/// Says how many passages stand for all trains.
pub(super) fn share(pass: &mut Pass, blocks: &Blocks, passages: u64) {
    let trains = blocks.sequence.trains();
    if trains < 2 {
        return;
    }
    let why = "trains of one kind and block run over the same settled track, so one passage gives the forces of all";
    let about = if matches!(blocks.update, Update::Adaptive { .. }) { "about " } else { "" };
    pass.decide("share", format!("{about}{passages} passages stand for {trains} trains"), why);
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
