//! Records of a run: quantities, seats, counts, volumes.

use super::asked::Asked;
use super::given::given;
use super::traffic::{Counted, between_trains, not_counted, whole};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::check::places::chosen::kept_seats;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::response::{Place, Response};
use crate::scenario::{Record as Kept, Volume, VolumeRecord};
use crate::units::Dimension;

/// The recorded quantities of the track, and of volumes under it.
pub fn kept(
    record: &Record,
    places: Option<&Places>,
    cycles: Option<u64>,
    asked: Asked,
    counted: Option<&Counted>,
    findings: &mut Findings,
) -> Option<(Option<Kept>, Option<VolumeRecord>)> {
    let Val::List(slots) = &record.get("quantities")?.value else { return None };
    let quantities: Option<Vec<(Response, Span)>> =
        slots.iter().map(|slot| if let Val::Response(r) = slot.value { Some((r, slot.span)) } else { None }).collect();
    let seats = places.and_then(|places| kept_seats(record, places, findings));
    let after = counts(record, cycles, counted, findings);
    let volume = volume(record);
    let (in_volumes, along): (Vec<_>, Vec<_>) =
        quantities?.into_iter().partition(|(quantity, _)| quantity.place() == Place::Volume);
    if let Some((quantity, span)) = in_volumes.first().filter(|_| !asked.layers_do) {
        without_grains(*quantity, *span, findings);
    }
    let names = |list: Vec<(Response, Span)>| list.into_iter().map(|(quantity, _)| quantity).collect::<Vec<_>>();
    let (in_volumes, along) = (names(in_volumes), names(along));
    let (seats, after, volume) = (seats?, after?, volume?);
    let every = given(record, "every");
    let volumes = (!in_volumes.is_empty()).then(|| VolumeRecord {
        quantities: in_volumes,
        seats: seats.clone(),
        after: after.clone(),
        every: every.map(|every| *every),
        depth: record.number("depth").map(|n| n.value),
        volume,
        span: record.get("volume").and_then(|slot| slot.origin.span()),
    });
    let states = record.word("states") == Some("vtk");
    if let Some(slot) = record.get("states").filter(|_| states && counted.is_none() && cycles.is_some()) {
        states_of_a_rig(slot.origin.span().unwrap_or(slot.span), findings);
    }
    let kept = Kept { quantities: along, seats, after, every, near: None, states };
    let kept = Some(kept).filter(|kept| states || !kept.quantities.is_empty());
    Some((kept, volumes))
}

/// Refuses states of a rig: states record rail and sleepers under trains; another command writes the bed of a rig.
fn states_of_a_rig(span: Span, findings: &mut Findings) {
    let message = "states of a test rig over its cycles are not in this version";
    let help = "leave `states` out: `cycles.csv`, `loops.csv` and `sensors.csv` hold every recorded cycle, and \
                `trackbed pack` writes the grains of the bed before its test";
    findings.report(Diagnostic::new(Code::E0619, message).label(span, "no series of states").help(help));
}

/// The counts of a record: axles of traffic, or cycles of a load.
fn counts(
    record: &Record,
    cycles: Option<u64>,
    counted: Option<&Counted>,
    findings: &mut Findings,
) -> Option<Vec<u64>> {
    let slots = match record.get("after").map(|slot| &slot.value) {
        Some(Val::List(slots)) => slots.as_slice(),
        Some(_) => return None,
        None => return Some(counted.map(|counted| counted.axles).or(cycles).into_iter().collect()),
    };
    // all counts have the same unit, because it is written behind the list
    let cycles_of_axles = |slot: &Slot| matches!(slot.value, Val::Number(n) if n.dimension == Dimension::CYCLES);
    if let Some(first) = slots.iter().find(|slot| counted.is_some() && cycles_of_axles(slot)) {
        not_counted(Dimension::CYCLES, "axles of its trains", first.span, findings);
        return None;
    }
    let of_trains = |slot: &Slot| matches!(slot.value, Val::Number(n) if n.dimension != Dimension::CYCLES);
    if let Some(first) = slots.iter().find(|slot| counted.is_none() && cycles.is_some() && of_trains(slot)) {
        let Val::Number(n) = first.value else { return None };
        not_counted(n.dimension, "cycles of its load", first.span, findings);
        return None;
    }
    let before = findings.diagnostics.len();
    let counts: Vec<Option<u64>> = match (counted, cycles) {
        (Some(_), _) => slots.iter().map(|slot| between_trains(slot, counted, findings)).collect(),
        (None, Some(cycles)) => slots.iter().map(|slot| recorded_cycles(slot, cycles, findings)).collect(),
        // the traffic is not understood, or there is none
        (None, None) => Vec::new(),
    };
    beyond_one_end(&mut findings.diagnostics, before);
    counts.into_iter().collect()
}

/// Counts of a list that all lie beyond the end of the run are reported once.
fn beyond_one_end(diagnostics: &mut Vec<Diagnostic>, before: usize) {
    for mistake in diagnostics.split_off(before.min(diagnostics.len())) {
        let same = |d: &&mut Diagnostic| d.code == Code::E0602 && d.help.is_none() && d.message == mistake.message;
        match diagnostics[before..].iter_mut().find(same) {
            Some(first) => first.labels.extend(mistake.labels),
            None => diagnostics.push(mistake),
        }
    }
}

fn recorded_cycles(slot: &Slot, cycles: u64, findings: &mut Findings) -> Option<u64> {
    let Val::Number(n) = slot.value else { return None };
    if n.dimension != Dimension::CYCLES {
        not_counted(n.dimension, "cycles of its load", slot.span, findings);
        return None;
    }
    let count = whole(n.value, "cycles", slot.span, findings)?;
    if count > cycles {
        findings.report(
            Diagnostic::new(Code::E0602, format!("the run ends after {cycles} cycles"))
                .label(slot.span, format!("{count} cycles are never reached")),
        );
        return None;
    }
    Some(count)
}

/// The shape of the volumes of a record.
pub fn volume(record: &Record) -> Option<Volume> {
    let Val::Word { word, arguments } = &record.get("volume")?.value else { return None };
    let length = |name: &str| match arguments.get(name).map(|slot| &slot.value) {
        Some(Val::Number(n)) => Some(n.value),
        _ => None,
    };
    Some(if word.name == "sphere" {
        Volume::Sphere { radius: length("radius")? }
    } else {
        let across = match arguments.get("across").map(|slot| &slot.value) {
            Some(Val::Word { .. }) => None,
            _ => Some(length("across")?),
        };
        Volume::Box { along: length("along")?, across, height: length("height")? }
    })
}

/// Notes a quantity that a run without grains does not record.
fn without_grains(quantity: Response, span: Span, findings: &mut Findings) {
    let message = format!("`{}` is a response of grains, but this scene runs without grains", quantity.name());
    findings.report(
        Diagnostic::new(Code::E0422, message)
            .label(span, "not recorded")
            .help("it is recorded in runs with `substructure = cells`, `zone` or `full`"),
    );
}
