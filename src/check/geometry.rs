//! Lays the sections out side by side, puts a seat on every place, and turns places into chainages.
//!
//! Sleeper -1 lies one spacing before a boundary, seat +1 on it, unless the transition says otherwise; a section in metres holds the sleepers that fit inside,
//! one in sleepers ends one spacing beyond its last. On a track of one section the sleepers stand in the middle of
//! their bays.

use super::Checker;
use super::value::Number;
use crate::diag::{Code, Diagnostic, Span, nearest::nearest};
use crate::scenario::{Side, Transition};
use crate::units::{Dimension, number};

/// A section before it is placed.
pub(super) struct Plan {
    pub name: String,
    pub spacing: f64,
    /// Bays of another spacing, counted inwards from its left and from its right boundary, m.
    pub bays: [Vec<f64>; 2],
    /// Distance of the nearest seat from its left and from its right boundary, m, where the transition states it.
    pub first: [Option<f64>; 2],
    /// m, or a number of sleepers.
    pub length: Number,
    /// Where the length stands.
    pub span: Span,
}

impl Plan {
    /// Seats that it may hold at most.
    pub fn most_seats(&self) -> usize {
        let most = if self.length.dimension == Dimension::SLEEPERS { 1.0 } else { CLOSEST };
        (self.length.value / most).ceil() as usize
    }
}

/// The places of a track.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    /// Chainage of both ends of every section.
    pub sections: Vec<(f64, f64)>,
    pub transitions: Vec<Transition>,
    /// Chainage, section, transition and number of every seat.
    pub seats: Vec<(f64, usize, usize, i32)>,
}

/// How a section meets one of its boundaries.
#[derive(Clone, Copy, PartialEq)]
enum Edge {
    /// An end of the model.
    End,
    /// The boundary of a transition, a bay away from the nearest seat: as on its softer side.
    Apart,
    /// The boundary of a transition, with a seat on it: as on its stiffer side.
    Seated,
}

pub(super) const MOST_SEATS: usize = 1_000_000;
pub(super) const CLOSEST: f64 = 0.3; // m: the least spacing of the language
const TINY: f64 = 1e-6; // m: two places closer than this are one

impl Checker<'_> {
    /// Places sections and seats; sides are one a boundary.
    pub(super) fn lay_out(&mut self, plans: &[Plan], sides: &[(String, Side)]) -> Option<Places> {
        let edges: Vec<(Edge, Edge)> = (0..plans.len()).map(|i| edges(i, plans, sides)).collect();
        let mut sections = Vec::new();
        let mut offsets = Vec::new();
        let mut x = 0.0;
        let mut sound = true;
        let mut most = MOST_SEATS;
        for (plan, &edge) in plans.iter().zip(&edges) {
            let Some((length, seats)) = self.section(plan, edge) else {
                sound = false;
                continue;
            };
            let Some(left) = most.checked_sub(seats.len()) else {
                self.report(
                    Diagnostic::new(Code::E0103, format!("a track of more than {MOST_SEATS} seats"))
                        .at(plan.span, "too many from here on"),
                );
                return None;
            };
            most = left;
            sections.push((x, x + length));
            offsets.push(seats);
            x += length;
        }
        if !sound {
            return None;
        }
        let origin = if sides.is_empty() { 0.0 } else { sections[0].1 };
        sections.iter_mut().for_each(|(a, b)| {
            *a -= origin;
            *b -= origin;
        });
        let transitions: Vec<Transition> = sides
            .iter()
            .zip(&sections)
            .map(|((name, side), (_, end))| Transition { name: name.clone(), x: *end, side: *side })
            .collect();
        let mut places = Places { sections, transitions, seats: Vec::new() };
        for (section, seats) in offsets.iter().enumerate() {
            let start = places.sections[section].0;
            for (i, offset) in seats.iter().enumerate() {
                let (transition, number) = count(i, seats.len(), section, start + offset, &places);
                places.seats.push((tidy(start + offset), section, transition, number));
            }
        }
        Some(places)
    }

    /// Length of a section and the seats in it, as distances from its left end.
    fn section(&mut self, plan: &Plan, (left, right): (Edge, Edge)) -> Option<(f64, Vec<f64>)> {
        let alone = left == Edge::End && right == Edge::End;
        // bays before the first seat and after the last
        let [before, after] = if alone { [0, 0] } else { [left, right].map(|edge| usize::from(edge != Edge::Seated)) };
        let [from_left, from_right] = [0, 1].map(|end| Row::new(plan.spacing, &plan.bays[end]));
        let changed = from_left.changed() + from_right.changed();
        if plan.length.dimension == Dimension::SLEEPERS {
            let n = self.whole_sleepers(plan)?;
            let bays = n - 1 + before + after;
            if changed > bays {
                self.too_far(plan, bays);
                return None;
            }
            let ends = if alone { plan.spacing / 2.0 } else { 0.0 };
            let usual = bays - changed;
            let length =
                from_left.reach(from_left.changed() + usual) + from_right.reach(from_right.changed()) + 2.0 * ends;
            let place = |bay: usize| match bay + from_right.changed() <= bays {
                true => ends + from_left.reach(bay),
                false => length - ends - from_right.reach(bays - bay),
            };
            return Some((length, (before..before + n).map(place).collect()));
        }
        let length = plan.length.value;
        if length < plan.spacing * (1.0 - TINY) {
            self.too_short(plan);
            return None;
        }
        let seats: Vec<f64> = match (left, right) {
            (Edge::End, Edge::End) => {
                let n = (1..).take_while(|n| from_left.reach(n - 1) + plan.spacing <= length + TINY).count();
                let first = (length - from_left.reach(n - 1)) / 2.0;
                (0..n).map(|i| first + from_left.reach(i)).collect()
            }
            (_, Edge::End) => from_left.inside(before, length).collect(),
            (Edge::End, _) => {
                let mut seats: Vec<f64> = from_right.inside(after, length).map(|d| length - d).collect();
                seats.reverse();
                seats
            }
            _ => {
                let usual = (length - from_left.reach(from_left.changed()) - from_right.reach(from_right.changed()))
                    / plan.spacing;
                if (usual - usual.round()).abs() > 1e-6 || usual < -1e-6 {
                    self.does_not_meet(plan, usual);
                    return None;
                }
                let bays = usual.round() as usize + changed;
                let place = |bay: usize| match bay + from_right.changed() <= bays {
                    true => from_left.reach(bay),
                    false => length - from_right.reach(bays - bay),
                };
                (before..(bays + 1).saturating_sub(after)).map(place).collect()
            }
        };
        if seats.is_empty() {
            self.report(
                Diagnostic::new(Code::E0502, format!("section `{}` is too short to hold a seat", plan.name))
                    .at(plan.span, "too short"),
            );
            return None;
        }
        Some((length, seats))
    }

    /// The number of sleepers that a section holds.
    fn whole_sleepers(&mut self, plan: &Plan) -> Option<usize> {
        let n = plan.length.value;
        if n.fract() != 0.0 || n < 1.0 {
            self.report(
                Diagnostic::new(
                    Code::E0502,
                    format!("a section holds a whole number of sleepers, found {}", number(n)),
                )
                .at(plan.span, "not a whole number"),
            );
            return None;
        }
        Some(n as usize)
    }

    fn too_short(&mut self, plan: &Plan) {
        let (length, bay) = (number(plan.length.value), number(plan.spacing));
        let message = format!("section `{}` of {length} m is shorter than one bay of {bay} m", plan.name);
        self.report(Diagnostic::new(Code::E0502, message).at(plan.span, "too short"));
    }

    fn too_far(&mut self, plan: &Plan, bays: usize) {
        let (changed, name) = (plan.bays[0].len() + plan.bays[1].len(), &plan.name);
        let message = format!("stretches change the spacing of {changed} bays of section `{name}`, which has {bays}");
        self.report(
            Diagnostic::new(Code::E0502, message)
                .at(plan.span, "too few sleepers")
                .help("shorten the stretches that set `spacing`, or lengthen the section"),
        );
    }

    fn does_not_meet(&mut self, plan: &Plan, usual: f64) {
        let [bay, length] = [plan.spacing, plan.length.value];
        let fits = |n: f64| number(tidy(length + (n - usual) * bay));
        let more = if plan.bays.iter().all(Vec::is_empty) { "" } else { " beside those that stretches change" };
        let message = format!(
            "{} m do not hold a whole number of bays of {} m{more} between two transitions",
            number(length),
            number(bay)
        );
        self.report(
            Diagnostic::new(Code::E0502, message).at(plan.span, "the counts from both transitions do not meet").help(
                format!(
                    "write `{} m` or `{} m`, or give the length in sleepers",
                    fits(usual.floor().max(0.0)),
                    fits(usual.ceil().max(0.0))
                ),
            ),
        );
    }

    /// The transition that `from` names; the only one where nothing is named.
    pub(super) fn transition(&mut self, places: &Places, from: Option<(&str, Span)>, place: Span) -> Option<usize> {
        match from {
            Some((name, span)) => {
                let found = places.transitions.iter().position(|t| t.name == name);
                if found.is_none() {
                    let near = nearest(name, places.transitions.iter().map(|t| t.name.as_str()));
                    self.report(
                        Diagnostic::new(Code::E0504, format!("no transition is called `{name}`"))
                            .at(span, "unknown transition")
                            .maybe_help(near.map(|n| format!("did you mean `{n}`?"))),
                    );
                }
                found
            }
            None if places.transitions.len() > 1 => {
                let names: Vec<&str> = places.transitions.iter().map(|t| t.name.as_str()).collect();
                self.report(
                    Diagnostic::new(Code::E0504, "expected the transition from which this place counts, found none")
                        .at(place, "the track has several")
                        .help(format!("add `from = {}`", names.join("` or `from = "))),
                );
                None
            }
            None => Some(0),
        }
    }

    /// Chainage of a place.
    pub(super) fn chainage(
        &mut self,
        places: &Places,
        at: Number,
        from: Option<(&str, Span)>,
        span: Span,
    ) -> Option<f64> {
        let transition = self.transition(places, from, span)?;
        self.counted(places, at, transition, span)
    }

    /// Chainage of a place counted from a transition.
    pub(super) fn counted(&mut self, places: &Places, at: Number, transition: usize, span: Span) -> Option<f64> {
        let (first, last) = (places.sections.first()?.0, places.sections.last()?.1);
        if at.dimension == Dimension::LENGTH {
            let x = match places.transitions.get(transition) {
                Some(t) if t.side == Side::StiffToSoft => t.x - at.value,
                Some(t) => t.x + at.value,
                None => at.value,
            };
            if x < first - TINY || x > last + TINY {
                self.report(
                    Diagnostic::new(
                        Code::E0501,
                        format!("the track reaches from {} m to {} m", number(first), number(last)),
                    )
                    .at(span, format!("x = {} m is off the track", number(x))),
                );
                return None;
            }
            return Some(x);
        }
        match places.seat(transition, at.value) {
            Some(seat) => Some(places.seats[seat].0),
            None => {
                let range = places.range(transition);
                let message = if at.value == 0.0 && !places.transitions.is_empty() {
                    "there is no sleeper 0: the softer side ends with -1, the stiffer one begins with +1".to_string()
                } else {
                    format!("no sleeper has the number {:+}", at.value)
                };
                self.report(
                    Diagnostic::new(Code::E0501, message)
                        .at(span, "not on the track")
                        .help(format!("the track has {range}")),
                );
                None
            }
        }
    }
}

/// Chainages of a span, in ascending order.
pub(super) fn span(
    checker: &mut Checker<'_>,
    places: &Option<Places>,
    a: Number,
    b: Number,
    from: Option<(&str, Span)>,
    span: Span,
) -> Option<(f64, f64)> {
    let places = places.as_ref()?;
    let (a, b) = (checker.chainage(places, a, from, span), checker.chainage(places, b, from, span));
    let (a, b) = (a?, b?);
    Some((a.min(b), a.max(b)))
}

impl Places {
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

    /// Seats of the two sections beside a transition with their numbers from there; all from the left without one.
    fn counted(&self, transition: usize) -> impl Iterator<Item = (usize, i32)> + '_ {
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
        let numbers: Vec<i32> = self.counted(transition).map(|(_, n)| n).collect();
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
}

fn edges(i: usize, plans: &[Plan], sides: &[(String, Side)]) -> (Edge, Edge) {
    let edge = |stiffer: bool, first: Option<f64>| match first {
        Some(distance) if distance > TINY => Edge::Apart,
        Some(_) => Edge::Seated,
        None if stiffer => Edge::Seated,
        None => Edge::Apart,
    };
    let first = plans[i].first;
    let left = i.checked_sub(1).and_then(|b| sides.get(b));
    let right = sides.get(i).filter(|_| i + 1 < plans.len());
    let left = left.map(|(_, side)| edge(*side == Side::SoftToStiff, first[0]));
    let right = right.map(|(_, side)| edge(*side == Side::StiffToSoft, first[1]));
    (left.unwrap_or(Edge::End), right.unwrap_or(Edge::End))
}

/// Bays from one end of a section on: some of another spacing, then as usual.
struct Row {
    usual: f64,
    /// What the first bays together are longer than usual, m: of none, of one, ..., of all that are of another spacing.
    excess: Vec<f64>,
}

impl Row {
    fn new(usual: f64, bays: &[f64]) -> Row {
        let mut excess = vec![0.0];
        for bay in bays {
            excess.push(excess[excess.len() - 1] + bay - usual);
        }
        Row { usual, excess }
    }

    /// Bays of another spacing.
    fn changed(&self) -> usize {
        self.excess.len() - 1
    }

    /// Length of so many bays, m.
    fn reach(&self, bays: usize) -> f64 {
        bays as f64 * self.usual + self.excess[bays.min(self.changed())]
    }

    /// Distances of the seats that fall strictly inside a length.
    fn inside(&self, before: usize, length: f64) -> impl Iterator<Item = f64> {
        (before..).map(|bay| self.reach(bay)).take_while(move |d| *d < length - TINY)
    }
}

/// Transition and number of the `i`-th of `n` seats of a section: counted from the nearer transition.
fn count(i: usize, n: usize, section: usize, x: f64, places: &Places) -> (usize, i32) {
    let boundaries = [section.checked_sub(1), Some(section).filter(|s| *s < places.transitions.len())];
    let nearer = boundaries
        .into_iter()
        .flatten()
        .min_by(|a, b| (places.transitions[*a].x - x).abs().total_cmp(&(places.transitions[*b].x - x).abs()));
    let Some(t) = nearer else { return (0, i as i32 + 1) };
    let left_of_it = t == section;
    let steps = if left_of_it { n - i } else { i + 1 } as i32;
    let soft = left_of_it == (places.transitions[t].side == Side::SoftToStiff);
    (t, if soft { -steps } else { steps })
}

/// Sums of spacings are cleaned of their last digits, so that a seat on a boundary lies on it.
fn tidy(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}
