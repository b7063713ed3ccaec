//! Seats that a scene names: at places, over a span, from one transition or mirrored at several.

use super::chainage::{Places, TINY};
use crate::check::evaluate::number::Number;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};

/// The transitions that `from` names, each once; without a name the only transition. `place` counts from them.
fn transitions_named(record: &Record, places: &Places, place: Span, findings: &mut Findings) -> Option<Vec<usize>> {
    let names = match record.get("from").map(|slot| &slot.value) {
        None => return places.transition(None, place, findings).map(|only| vec![only]),
        Some(Val::List(names)) => names,
        Some(_) => return None,
    };
    let mut found: Vec<(Option<usize>, Span)> = Vec::new();
    for slot in names {
        let Val::Text(name) = &slot.value else { return None };
        let transition = places.transition(Some((name, slot.span)), place, findings);
        let first = found.iter().find(|(other, _)| transition.is_some() && *other == transition).map(|f| f.1);
        if let Some(first) = first {
            findings.report(
                Diagnostic::new(Code::E0404, format!("transition `{name}` is named twice"))
                    .label(slot.span, "again here")
                    .label(first, "first named here"),
            );
            return None;
        }
        found.push((transition, slot.span));
    }
    found.into_iter().map(|(transition, _)| transition).collect()
}

/// Chainages of the places in a field, at each transition from which they count.
pub fn chainages_at(
    record: &Record,
    field: &str,
    places: &Places,
    findings: &mut Findings,
) -> Option<Vec<(f64, Span)>> {
    let slot = record.get(field)?;
    let Val::List(at) = &slot.value else { return None };
    let transitions = transitions_named(record, places, slot.span, findings)?;
    let mut found: Vec<Option<(f64, Span)>> = Vec::new();
    for transition in transitions {
        found.extend(at.iter().map(|slot| match slot.value {
            Val::Number(n) => places.chainage_from(n, transition, slot.span, findings).map(|x| (x, slot.span)),
            _ => None,
        }));
    }
    found.into_iter().collect()
}

/// Indices of the seats of the span in `over`, at each transition from which it counts. A span in metres that ends at
/// the transition stays on its side.
pub fn seats_over(record: &Record, places: &Places, findings: &mut Findings) -> Option<Vec<usize>> {
    let slot = record.get("over")?;
    let Val::Range(a, b) = slot.value else { return None };
    let transitions = transitions_named(record, places, slot.span, findings)?;
    let mut seats = Vec::new();
    for transition in transitions {
        seats.extend(seats_from(places, [a, b], transition, slot.span, findings)?);
    }
    Some(seats)
}

fn seats_from(
    places: &Places,
    ends: [Number; 2],
    transition: usize,
    span: Span,
    findings: &mut Findings,
) -> Option<Vec<usize>> {
    let [a, b] = ends.map(|end| places.chainage_from(end, transition, span, findings));
    let (a, b) = (a?, b?);
    let (low, high) = (a.min(b) - TINY, a.max(b) + TINY);
    let beyond = ends[1].dimension != crate::units::Dimension::LENGTH || ends[1].value > TINY;
    let boundary = places.transitions.get(transition).map(|t| t.x).filter(|_| !beyond);
    let inside = |seat: &usize| {
        let x = places.seats[*seat].0;
        (low..=high).contains(&x) && boundary.is_none_or(|boundary| (x - boundary).abs() > TINY)
    };
    Some((0..places.seats.len()).filter(inside).collect())
}

/// Indices of the seats that a record names; all seats if it names none.
pub fn kept_seats(record: &Record, places: &Places, findings: &mut Findings) -> Option<Vec<usize>> {
    let mut seats = Vec::new();
    if record.get("at").is_some() {
        let chainages = chainages_at(record, "at", places, findings)?;
        seats.extend(chainages.iter().filter_map(|(x, _)| places.nearest_seat(*x)));
    }
    if let Some(Slot { value: Val::Range(..), .. }) = record.get("over") {
        seats.extend(seats_over(record, places, findings)?);
    }
    if record.get("at").is_none() && record.get("over").is_none() {
        seats = (0..places.seats.len()).collect();
    }
    seats.sort_unstable();
    seats.dedup();
    Some(seats)
}
