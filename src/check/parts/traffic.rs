//! Trains, their shares of the traffic, and the counts of axles or mass in a run.

use super::vehicle::train;
use crate::check::evaluate::number::Number;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Given, Order, Sequence, Traffic, Train};
use crate::units::{Dimension, Quantity, number};

/// Largest difference of the sum of the shares from one.
const ROUNDING: f64 = 1e-9;

/// The meaning of counts in this scene.
#[derive(Debug, Clone)]
pub struct Counted {
    sequence: Sequence,
    mixed: bool,
    /// All traffic, as written.
    total: Number,
    /// Axles of the whole run.
    pub axles: u64,
}

/// Reads the traffic over the track, and the meaning of its counts.
pub fn traffic(record: &Record, places: Option<&Places>, findings: &mut Findings) -> Option<(Traffic, Counted)> {
    let slot = record.get("trains")?;
    let Val::Pairs(pairs) = &slot.value else { return None };
    let trains: Vec<Option<Train>> = pairs
        .iter()
        .map(|(slot, _)| match &slot.value {
            Val::Record(record) => train(record, places, findings),
            _ => None,
        })
        .collect();
    let shares = shares(pairs, slot.span, findings);
    let trains: Vec<Train> = trains.into_iter().collect::<Option<_>>()?;
    let (shares, total) = (shares?, record.get("total")?);
    let Val::Number(amount) = total.value else { return None };
    let order = if record.word("order")? == "in_turn" { Order::InTurn } else { Order::Interleaved };
    let (counts, axles) = match trains.as_slice() {
        [train] => {
            let axles = whole_trains(total, train, findings)?;
            (vec![axles / train.axles()], axles)
        }
        _ => trains_of_mix(&trains, &shares, amount, total.span, findings)?,
    };
    let mut trains = trains.into_iter();
    let traffic = Traffic {
        train: trains.next()?,
        others: trains.collect(),
        counts,
        order,
        total: Given { value: axles, origin: total.origin },
    };
    let (sequence, mixed) = (traffic.sequence(), traffic.is_mixed());
    Some((traffic, Counted { sequence, mixed, total: amount, axles }))
}

/// The share of each train with its place; they sum to the whole, and each train has one.
fn shares(pairs: &[(Slot, Slot)], span: Span, findings: &mut Findings) -> Option<Vec<(f64, Span)>> {
    if pairs.is_empty() {
        findings.report(Diagnostic::new(Code::E0403, "traffic needs a train").label(span, "empty"));
        return None;
    }
    let name = |slot: &Slot| if let Val::Record(train) = &slot.value { Some(train.name.clone()) } else { None };
    let twice = pairs.iter().enumerate().find_map(|(i, (train, _))| {
        let first = pairs[..i].iter().find(|(other, _)| name(other).is_some() && name(other) == name(train))?;
        Some((name(train)?, train.span, first.0.span))
    });
    if let Some((name, again, first)) = twice {
        findings.report(
            Diagnostic::new(Code::E0404, format!("train `{name}` is given twice"))
                .label(again, "again here")
                .label(first, "first given here")
                .help("give it one share"),
        );
        return None;
    }
    let share = |(_, share): &(Slot, Slot)| match share.value {
        Val::Number(n) => Some((n.value, share.span)),
        _ => None,
    };
    let shares: Vec<(f64, Span)> = pairs.iter().map(share).collect::<Option<_>>()?;
    let sum: f64 = shares.iter().map(|(share, _)| share).sum();
    if (sum - 1.0).abs() <= ROUNDING {
        return Some(shares);
    }
    let text = format!("the shares of the trains sum to {} %, not to 100 %", number(100.0 * sum));
    let mut mistake = Diagnostic::new(Code::E0407, text);
    mistake = match shares.as_slice() {
        [(_, only)] => mistake.label(*only, "of `total`").help("a train that runs alone needs no share: leave it out"),
        _ => {
            let labelled = shares.iter().fold(mistake, |mistake, (share, span)| {
                mistake.label(*span, format!("{} % of `total`", number(100.0 * share)))
            });
            let names: Vec<String> = pairs.iter().filter_map(|(train, _)| name(train)).collect();
            let each = |(name, (share, _)): (&String, &(f64, Span))| {
                format!("{name}: {} %", number((1000.0 * share / sum).round() / 10.0))
            };
            let scaled: Vec<String> = names.iter().zip(&shares).map(each).collect();
            labelled.help(format!("in the same proportion they are about `[{}]`", scaled.join(", ")))
        }
    };
    findings.report(mistake);
    None
}

/// The number of trains of each kind, rounded to whole trains, and the axles of all trains.
fn trains_of_mix(
    trains: &[Train],
    shares: &[(f64, Span)],
    total: Number,
    span: Span,
    findings: &mut Findings,
) -> Option<(Vec<u64>, u64)> {
    let mut counts = Vec::new();
    for (train, (share, place)) in trains.iter().zip(shares) {
        let one = if total.dimension == Dimension::MASS { train.mass() } else { train.axles() as f64 };
        let count = (share * total.value / one).round();
        if count < 1.0 {
            let unit = if total.dimension == Dimension::MASS { "t" } else { "axles" };
            let carried = |amount: f64| Quantity::new(amount, total.dimension).show(unit);
            findings.report(
                Diagnostic::new(
                    Code::E0602,
                    format!(
                        "a share of {} % is {}, less than half of one train `{}` of {}",
                        number(100.0 * share),
                        carried(share * total.value),
                        train.name,
                        carried(one)
                    ),
                )
                .label(*place, "no train of this kind would run")
                .label(span, "all traffic")
                .help("leave the train out, or let more traffic run"),
            );
            return None;
        }
        counts.push(count as u64);
    }
    let axles = counts.iter().zip(trains).map(|(count, train)| count * train.axles()).sum();
    Some((counts, axles))
}

/// Axles of a count that may be given as the mass carried, rounded to whole trains.
fn whole_trains(slot: &Slot, train: &Train, findings: &mut Findings) -> Option<u64> {
    let Val::Number(n) = slot.value else { return None };
    if n.dimension == Dimension::MASS {
        let trains = (n.value / train.mass()).round().max(1.0);
        return Some(trains as u64 * train.axles());
    }
    whole_axles(n.value, slot.span, findings)
}

/// An axle count, which is a whole number.
pub fn whole_axles(axles: f64, span: Span, findings: &mut Findings) -> Option<u64> {
    whole(axles, "axles", span, findings)
}

/// A count, which is a whole number.
pub fn whole(count: f64, what: &str, span: Span, findings: &mut Findings) -> Option<u64> {
    if count.fract() != 0.0 {
        findings.report(
            Diagnostic::new(Code::E0405, format!("expected a whole number of {what}, found {}", number(count)))
                .label(span, "not whole"),
        );
        return None;
    }
    Some(count as u64)
}

/// Refuses a count in a unit that this scene does not count.
pub fn not_counted(dimension: Dimension, counts: &str, span: Span, findings: &mut Findings) {
    let message = format!("this scene counts the {counts}, found {}", dimension.describe());
    let help = "counts are in `axles` or as the mass carried, `MGT`, if trains run; in `cycles` if a load is cyclic";
    findings.report(Diagnostic::new(Code::E0302, message).label(span, "not counted here").help(help));
}

/// The axle count of an event in a run: between two trains, and not after the last train.
pub fn between_trains(slot: &Slot, counted: Option<&Counted>, findings: &mut Findings) -> Option<u64> {
    let Val::Number(n) = slot.value else { return None };
    axle_count(n, slot.span, true, counted, findings)
}

/// An axle count of the run, given in axles or as the mass carried. Counts of a mix of trains, and counts of mass, are
/// rounded to the nearest train; a count of axles for one kind of train must end with a train if it is `exact`.
pub fn axle_count(
    n: Number,
    span: Span,
    exact: bool,
    counted: Option<&Counted>,
    findings: &mut Findings,
) -> Option<u64> {
    if n.dimension == Dimension::CYCLES {
        not_counted(n.dimension, "axles of its trains", span, findings);
        return None;
    }
    let by_mass = n.dimension == Dimension::MASS;
    let Some(counted) = counted else {
        // the traffic is not understood
        return if by_mass { None } else { whole_axles(n.value, span, findings) };
    };
    if n.value == 0.0 {
        return Some(0);
    }
    if !by_mass {
        whole_axles(n.value, span, findings)?;
    }
    let sequence = &counted.sequence;
    let carried = |sequence: &Sequence, position: u64| {
        if by_mass { sequence.mass(position) } else { sequence.axles(position) as f64 }
    };
    let as_total = counted.total.dimension == n.dimension;
    let whole = if as_total { counted.total.value } else { carried(sequence, sequence.trains()) };
    if n.value > whole * (1.0 + ROUNDING) {
        let text = format!("the run ends after {} axles", counted.axles);
        let asked = if by_mass { "this mass is".into() } else { format!("{} axles are", number(n.value)) };
        findings.report(Diagnostic::new(Code::E0602, text).label(span, format!("{asked} never reached")));
        return None;
    }
    if as_total && n.value >= whole * (1.0 - ROUNDING) {
        return Some(counted.axles);
    }
    if by_mass || counted.mixed {
        let position = sequence.nearest(n.value, carried).max(1);
        return Some(sequence.axles(position));
    }
    let (count, axles) = (n.value as u64, sequence.shares[0].axles);
    if exact && !count.is_multiple_of(axles) {
        let below = count / axles * axles;
        findings.report(
            Diagnostic::new(Code::E0602, format!("{count} axles are not a whole number of trains of {axles} axles"))
                .label(span, "in the middle of a train")
                .help(format!("write {below} or {} axles", below + axles)),
        );
        return None;
    }
    Some(count)
}
