//! Seats that a scene names: at places, over a span, from one transition or mirrored at several.

use super::Checker;
use super::geometry::Places;
use super::value::{Number, Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};

/// Two chainages closer than this are one place, m.
const TINY: f64 = 1e-6;

impl Checker<'_> {
    /// The transitions that `from` names, each once; where nothing is named the only one. `place` counts from them.
    pub(super) fn counted_from(&mut self, record: &Record, places: &Places, place: Span) -> Option<Vec<usize>> {
        let names = match record.get("from").map(|slot| &slot.value) {
            None => return self.transition(places, None, place).map(|only| vec![only]),
            Some(Val::List(names)) => names,
            Some(_) => return None,
        };
        let mut found: Vec<(Option<usize>, Span)> = Vec::new();
        for slot in names {
            let Val::Text(name) = &slot.value else { return None };
            let transition = self.transition(places, Some((name, slot.span)), place);
            let first = found.iter().find(|(other, _)| transition.is_some() && *other == transition).map(|f| f.1);
            if let Some(first) = first {
                self.report(
                    Diagnostic::new(Code::E0404, format!("transition `{name}` is named twice"))
                        .at(slot.span, "again here")
                        .at(first, "first named here"),
                );
                return None;
            }
            found.push((transition, slot.span));
        }
        found.into_iter().map(|(transition, _)| transition).collect()
    }

    /// Chainages of the places in a field, at each transition from which they count.
    pub(super) fn chainages_at(&mut self, record: &Record, field: &str, places: &Places) -> Option<Vec<(f64, Span)>> {
        let slot = record.get(field)?;
        let Val::List(at) = &slot.value else { return None };
        let transitions = self.counted_from(record, places, slot.span)?;
        let mut found: Vec<Option<(f64, Span)>> = Vec::new();
        for transition in transitions {
            found.extend(at.iter().map(|slot| match slot.value {
                Val::Number(n) => self.counted(places, n, transition, slot.span).map(|x| (x, slot.span)),
                _ => None,
            }));
        }
        found.into_iter().collect()
    }

    /// Indices of the seats of the span in `over`, at each transition from which it counts. A span in metres that ends at
    /// the transition stays on its side.
    pub(super) fn seats_over(&mut self, record: &Record, places: &Places) -> Option<Vec<usize>> {
        let slot = record.get("over")?;
        let Val::Range(a, b) = slot.value else { return None };
        let transitions = self.counted_from(record, places, slot.span)?;
        let mut seats = Vec::new();
        for transition in transitions {
            seats.extend(self.seats_from(places, [a, b], transition, slot.span)?);
        }
        Some(seats)
    }

    fn seats_from(&mut self, places: &Places, ends: [Number; 2], transition: usize, span: Span) -> Option<Vec<usize>> {
        let [a, b] = ends.map(|end| self.counted(places, end, transition, span));
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

    /// Indices of the seats that a record names; all of them where it names none.
    pub(super) fn kept_seats(&mut self, record: &Record, places: &Places) -> Option<Vec<usize>> {
        let mut seats = Vec::new();
        if record.get("at").is_some() {
            let chainages = self.chainages_at(record, "at", places)?;
            seats.extend(chainages.iter().filter_map(|(x, _)| places.nearest_seat(*x)));
        }
        if let Some(Slot { value: Val::Range(..), .. }) = record.get("over") {
            seats.extend(self.seats_over(record, places)?);
        }
        if record.get("at").is_none() && record.get("over").is_none() {
            seats = (0..places.seats.len()).collect();
        }
        seats.sort_unstable();
        seats.dedup();
        Some(seats)
    }
}
