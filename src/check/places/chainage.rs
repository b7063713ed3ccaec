//! The places of a track: its sections, transitions and seats, and the chainage of places that count from them.

use crate::check::evaluate::number::Number;
use crate::check::findings::Findings;
use crate::diag::nearest::nearest;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Side, Transition};
use crate::units::{Dimension, number};
use std::ops::Range;

/// Two chainages that differ by less are one place, m.
pub const TINY: f64 = 1e-6;

/// The places of a track.
#[derive(Debug, Clone, Default)]
pub struct Places {
    /// Chainage of both ends of every section.
    pub sections: Vec<(f64, f64)>,
    pub transitions: Vec<Transition>,
    /// Chainage, section, transition and number of every seat.
    pub seats: Vec<(f64, usize, usize, i32)>,
    /// The seed of random values along the track that have no seed of their own.
    pub seed: u64,
}

impl Places {
    /// The transition that `from` names; without a name the only transition.
    pub fn transition(&self, from: Option<(&str, Span)>, place: Span, findings: &mut Findings) -> Option<usize> {
        match from {
            Some((name, span)) => {
                let found = self.transitions.iter().position(|t| t.name == name);
                if found.is_none() {
                    let near = nearest(name, self.transitions.iter().map(|t| t.name.as_str()));
                    findings.report(
                        Diagnostic::new(Code::E0504, format!("no transition is called `{name}`"))
                            .label(span, "unknown transition")
                            .maybe_meant(span, near),
                    );
                }
                found
            }
            None if self.transitions.len() > 1 => {
                let names: Vec<&str> = self.transitions.iter().map(|t| t.name.as_str()).collect();
                findings.report(
                    Diagnostic::new(Code::E0504, "expected the transition from which this place counts, found none")
                        .label(place, "the track has several")
                        .help(format!("add `from = {}`", names.join("` or `from = "))),
                );
                None
            }
            None => Some(0),
        }
    }

    /// Chainage of a place.
    pub fn chainage(&self, at: Number, from: Option<(&str, Span)>, span: Span, findings: &mut Findings) -> Option<f64> {
        let transition = self.transition(from, span, findings)?;
        self.chainage_from(at, transition, span, findings)
    }

    /// Chainages of a span, in ascending order.
    pub fn span(
        &self,
        a: Number,
        b: Number,
        from: Option<(&str, Span)>,
        span: Span,
        findings: &mut Findings,
    ) -> Option<(f64, f64)> {
        let (a, b) = (self.chainage(a, from, span, findings), self.chainage(b, from, span, findings));
        let (a, b) = (a?, b?);
        Some((a.min(b), a.max(b)))
    }

    /// Chainage of a place counted from a transition.
    pub fn chainage_from(&self, at: Number, transition: usize, span: Span, findings: &mut Findings) -> Option<f64> {
        let (first, last) = (self.sections.first()?.0, self.sections.last()?.1);
        if at.dimension == Dimension::LENGTH {
            let x = match self.transitions.get(transition) {
                Some(t) if t.side == Side::StiffToSoft => t.x - at.value,
                Some(t) => t.x + at.value,
                None => at.value,
            };
            if x < first - TINY || x > last + TINY {
                findings.report(
                    Diagnostic::new(
                        Code::E0501,
                        format!("the track reaches from {} m to {} m", number(first), number(last)),
                    )
                    .label(span, format!("x = {} m is off the track", number(x))),
                );
                return None;
            }
            return Some(x);
        }
        match self.seat(transition, at.value) {
            Some(seat) => Some(self.seats[seat].0),
            None => {
                let range = self.range(transition);
                let message = if at.value == 0.0 && !self.transitions.is_empty() {
                    "there is no sleeper 0: the softer side ends with -1, the stiffer one begins with +1".to_string()
                } else {
                    format!("no sleeper has the number {:+}", at.value)
                };
                findings.report(
                    Diagnostic::new(Code::E0501, message)
                        .label(span, "not on the track")
                        .help(format!("the track has {range}")),
                );
                None
            }
        }
    }

    /// Index of the seat with that number, counted from a transition.
    pub fn seat(&self, transition: usize, n: f64) -> Option<usize> {
        if n.fract() != 0.0 {
            return None;
        }
        let steps = n.abs() as usize;
        let Some(boundary) = self.transitions.get(transition) else {
            return steps.checked_sub(1).filter(|i| n > 0.0 && *i < self.seats.len());
        };
        let left = (n < 0.0) == (boundary.side == Side::SoftToStiff);
        let seats = self.seats_of(if left { transition } else { transition + 1 });
        let seat = if left { seats.end.checked_sub(steps) } else { (seats.start + steps).checked_sub(1) };
        seat.filter(|i| steps > 0 && seats.contains(i))
    }

    /// Seats of the two sections beside a transition with their numbers from there; without a transition all seats from
    /// the left.
    fn numbers_from(&self, transition: usize) -> impl Iterator<Item = (usize, i32)> + '_ {
        let boundary = self.transitions.get(transition);
        self.seats.iter().enumerate().filter_map(move |(i, &(_, section, ..))| match boundary {
            None => Some((i, i as i32 + 1)),
            Some(t) => {
                let here =
                    |s: usize| self.seats.iter().enumerate().filter(move |(_, seat)| seat.1 == s).map(|(i, _)| i);
                let (first_right, last_left) =
                    (here(transition + 1).next()? as i32, here(transition).next_back()? as i32);
                let steps = if section == transition {
                    last_left - i as i32 + 1
                } else if section == transition + 1 {
                    i as i32 - first_right + 1
                } else {
                    return None;
                };
                let soft = (section == transition) == (t.side == Side::SoftToStiff);
                Some((i, if soft { -steps } else { steps }))
            }
        })
    }

    fn range(&self, transition: usize) -> String {
        let numbers: Vec<i32> = self.numbers_from(transition).map(|(_, n)| n).collect();
        let (Some(min), Some(max)) = (numbers.iter().min(), numbers.iter().max()) else { return "no sleepers".into() };
        if *min < 0 && *max > 0 {
            format!("sleepers {min} .. -1 and +1 .. {max:+}")
        } else {
            format!("sleepers {min} .. {max}")
        }
    }

    /// Index of the seat nearest to a chainage.
    pub fn nearest_seat(&self, x: f64) -> Option<usize> {
        (0..self.seats.len()).min_by(|&a, &b| (self.seats[a].0 - x).abs().total_cmp(&(self.seats[b].0 - x).abs()))
    }

    /// The interval of the track that is nearest to a seat.
    pub fn cell(&self, seat: usize) -> (f64, f64) {
        let middle = |i: usize, j: usize| (self.seats[i].0 + self.seats[j].0) / 2.0;
        let start = self.sections.first().map_or(0.0, |s| s.0);
        let end = self.sections.last().map_or(0.0, |s| s.1);
        let left = if seat == 0 { start } else { middle(seat - 1, seat) };
        let right = if seat + 1 == self.seats.len() { end } else { middle(seat, seat + 1) };
        (left, right)
    }

    /// Indices of the seats of a section.
    pub fn seats_of(&self, section: usize) -> Range<usize> {
        let start = self.seats.partition_point(|s| s.1 < section);
        start..self.seats.partition_point(|s| s.1 <= section)
    }

    /// Indices of the seats between two chainages. A span in metres that ends at the transition stays on its side: the
    /// seat on the boundary belongs to the section beyond.
    pub fn seats_between(&self, ends: [f64; 2], transition: usize, beyond: bool) -> Range<usize> {
        let (low, high) = (ends[0].min(ends[1]) - TINY, ends[0].max(ends[1]) + TINY);
        let boundary = self.transitions.get(transition).map(|t| t.x).filter(|_| !beyond);
        let inside = |seat: &(f64, usize, usize, i32)| {
            (low..=high).contains(&seat.0) && boundary.is_none_or(|x| (seat.0 - x).abs() > TINY)
        };
        let start = self.seats.iter().position(inside).unwrap_or(0);
        start..start + self.seats[start..].iter().take_while(|seat| inside(seat)).count()
    }

    /// `sleepers -6 .. -1`, with the transition if there are several.
    pub fn named(&self, seats: &Range<usize>) -> String {
        let (first, last) = (self.seats[seats.start], self.seats[seats.end - 1]);
        let of = |transition: usize| match self.transitions.get(transition) {
            Some(t) if self.transitions.len() > 1 => format!(" of `{}`", t.name),
            _ => String::new(),
        };
        if seats.len() == 1 {
            format!("seat {:+}{}", first.3, of(first.2))
        } else if first.2 == last.2 {
            format!("seats {:+} .. {:+}{}", first.3.min(last.3), first.3.max(last.3), of(first.2))
        } else {
            format!("seats {:+}{} to {:+}{}", first.3, of(first.2), last.3, of(last.2))
        }
    }

    /// Distances to the seats on the left and on the right, m; at an end of the track the distance on the other side.
    pub fn spacings(&self, seat: usize, alone: f64) -> [f64; 2] {
        let x = self.seats[seat].0;
        // rounded differences, so that equal distances are exactly equal
        let apart = |other: f64| ((x - other).abs() * 1e9).round() / 1e9;
        let left = seat.checked_sub(1).map(|i| apart(self.seats[i].0));
        let right = self.seats.get(seat + 1).map(|next| apart(next.0));
        let own = left.or(right).unwrap_or(alone);
        [left.unwrap_or(right.unwrap_or(own)), right.unwrap_or(own)]
    }
}
