//! Tamping: its counts, its sleepers, and the remaining share of their settlement.

use super::asked::Asked;
use super::traffic::{Counted, between_trains};
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::check::places::chosen::seats_over;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Tamping, Track};

/// Every tamping of a scene. Tampings without effect are reported.
pub fn tampings(
    records: &[Record],
    places: Option<&Places>,
    track: Option<&Track>,
    asked: Asked,
    counted: Option<&Counted>,
    findings: &mut Findings,
) -> Option<Vec<Tamping>> {
    let mut tampings: Vec<Option<(Tamping, Vec<Span>)>> = Vec::new();
    for record in records {
        if !asked.traffic {
            findings.report(
                Diagnostic::new(
                    Code::E0427,
                    format!("`{}` has no effect, because no train settles the track", record.name),
                )
                .label(record.span, "no effect")
                .help("add `traffic`, or take the tamping out"),
            );
            continue;
        }
        tampings.push(tamping(record, places, track, counted, findings));
    }
    let tampings: Vec<(Tamping, Vec<Span>)> = tampings.into_iter().collect::<Option<_>>()?;
    tamped_once(&tampings, findings).then_some(())?;
    Some(tampings.into_iter().map(|(tamping, _)| tamping).collect())
}

fn tamping(
    record: &Record,
    places: Option<&Places>,
    track: Option<&Track>,
    counted: Option<&Counted>,
    findings: &mut Findings,
) -> Option<(Tamping, Vec<Span>)> {
    let after = tamped_after(record, counted, findings);
    let left = record.number("left");
    let places = places?;
    let over = record.get("over").map_or(record.span, |slot| slot.span);
    let named = if record.get("over").is_some() {
        seats_over(record, places, findings)
    } else {
        Some((0..places.seats.len()).collect())
    };
    let (named, track) = (named?, track?);
    let seats: Vec<usize> = named.into_iter().filter(|seat| track.seats[*seat].is_ballasted()).collect();
    if seats.is_empty() {
        findings.report(
            Diagnostic::new(Code::E0427, format!("`{}` covers no sleeper on ballast", record.name))
                .label(over, "nothing to tamp here")
                .help("tamp sleepers on a support that settles: `over = -20 .. -1 sleepers`"),
        );
        return None;
    }
    let (after, spans) = after?.into_iter().unzip();
    Some((Tamping { name: record.name.clone(), after, seats, left: left?.value }, spans))
}

/// The counts after which it is done, between the first and the last train.
fn tamped_after(record: &Record, counted: Option<&Counted>, findings: &mut Findings) -> Option<Vec<(u64, Span)>> {
    let Val::List(slots) = &record.get("after")?.value else { return None };
    let counts: Vec<Option<(u64, Span)>> =
        slots.iter().map(|slot| Some((between_trains(slot, counted, findings)?, slot.span))).collect();
    let counts: Vec<(u64, Span)> = counts.into_iter().collect::<Option<_>>()?;
    let total = counted?.axles;
    let mut sound = true;
    for (count, span) in &counts {
        let why = match *count {
            0 => "nothing has settled before the first train",
            count if count == total => "the run ends there",
            _ => continue,
        };
        findings.report(
            Diagnostic::new(Code::E0427, format!("`{}` has no effect at this count", record.name))
                .label(*span, why)
                .help("tamp between the first and the last train"),
        );
        sound = false;
    }
    sound.then_some(counts)
}

/// Whether no sleeper is tamped twice at the same count; the result would depend on the order.
fn tamped_once(tampings: &[(Tamping, Vec<Span>)], findings: &mut Findings) -> bool {
    let counts = |of: &(Tamping, Vec<Span>)| of.0.after.iter().copied().zip(of.1.clone()).collect::<Vec<_>>();
    let mut sound = true;
    for (i, later) in tampings.iter().enumerate() {
        for (n, (count, span)) in counts(later).into_iter().enumerate() {
            let same = counts(later)[..n].iter().find(|(other, _)| *other == count).map(|(_, first)| *first);
            let other = tampings[..i].iter().find_map(|first| {
                let meets = first.0.seats.iter().any(|seat| later.0.seats.contains(seat));
                counts(first).into_iter().find(|(other, _)| meets && *other == count).map(|(_, first)| first)
            });
            let Some(first) = same.or(other) else { continue };
            findings.report(
                Diagnostic::new(Code::E0427, format!("sleepers are tamped twice after {count} axles"))
                    .label(span, "again here")
                    .label(first, "first tamped here")
                    .help("keep one of the two, or let them reach other sleepers"),
            );
            sound = false;
        }
    }
    sound
}
