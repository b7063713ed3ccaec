//! Lays the sections out side by side, puts a seat on every place, and turns places into chainages.
//!
//! Sleeper -1 lies one spacing before a boundary and seat +1 on the boundary, unless the transition states other
//! places. A section in metres holds the sleepers that fit inside; a section in sleepers ends one spacing beyond its
//! last sleeper. On a track with one section the sleepers lie in the middle of their bays.

use super::chainage::{Places, TINY};
use crate::check::evaluate::number::Number;
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Side, Transition};
use crate::units::{Dimension, number};

/// A section before it is placed.
pub struct Plan {
    pub name: String,
    pub spacing: f64,
    /// Bays of another spacing, counted inwards from its left and from its right boundary, m.
    pub bays: [Vec<f64>; 2],
    /// Distance of the nearest seat from its left and from its right boundary, m, if the transition states it.
    pub first: [Option<f64>; 2],
    /// m, or a number of sleepers.
    pub length: Number,
    /// The place of the length in the text.
    pub span: Span,
}

impl Plan {
    /// Largest number of seats.
    pub(super) fn most_seats(&self) -> usize {
        let most = if self.length.dimension == Dimension::SLEEPERS { 1.0 } else { CLOSEST };
        (self.length.value / most).ceil() as usize
    }
}

/// The kind of a boundary of a section.
#[derive(Clone, Copy, PartialEq)]
enum Edge {
    /// An end of the model.
    End,
    /// The boundary of a transition, a bay away from the nearest seat, on its softer side.
    Apart,
    /// The boundary of a transition with a seat on it, on its stiffer side.
    Seated,
}

/// Seats of one track.
pub const MOST_SEATS: usize = 1_000_000;
/// The least spacing of the language, m.
pub const CLOSEST: f64 = 0.3;

/// Places sections and seats; `sides` has one entry per boundary.
pub fn lay_out(plans: &[Plan], sides: &[(String, Side)], seed: u64, findings: &mut Findings) -> Option<Places> {
    let edges: Vec<(Edge, Edge)> = (0..plans.len()).map(|i| edges(i, plans, sides)).collect();
    let mut sections = Vec::new();
    let mut offsets = Vec::new();
    let mut x = 0.0;
    let mut sound = true;
    let mut most = MOST_SEATS;
    for (plan, &edge) in plans.iter().zip(&edges) {
        let Some((length, seats)) = lay_section(plan, edge, findings) else {
            sound = false;
            continue;
        };
        let Some(left) = most.checked_sub(seats.len()) else {
            findings.report(
                Diagnostic::new(Code::E0103, format!("the track has more than {MOST_SEATS} seats"))
                    .label(plan.span, "too many from here on"),
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
    let mut places = Places { sections, transitions, seats: Vec::new(), seed };
    for (section, seats) in offsets.iter().enumerate() {
        let start = places.sections[section].0;
        for (i, offset) in seats.iter().enumerate() {
            let (transition, number) = count(i, seats.len(), section, start + offset, &places);
            places.seats.push((tidy(start + offset), section, transition, number));
        }
    }
    Some(places)
}

/// Share of a bay by which a section may differ from a whole number of bays: about a tenth of a millimetre.
const WHOLE: f64 = 2e-4;

/// Length of a section and the seats in it, as distances from its left end.
fn lay_section(plan: &Plan, (left, right): (Edge, Edge), findings: &mut Findings) -> Option<(f64, Vec<f64>)> {
    let alone = left == Edge::End && right == Edge::End;
    // bays before the first seat and after the last
    let [before, after] = if alone { [0, 0] } else { [left, right].map(|edge| usize::from(edge != Edge::Seated)) };
    let [from_left, from_right] = [0, 1].map(|end| Row::new(plan.spacing, &plan.bays[end]));
    let changed = from_left.changed() + from_right.changed();
    if plan.length.dimension == Dimension::SLEEPERS {
        let n = whole_sleepers(plan, findings)?;
        let bays = n - 1 + before + after;
        if changed > bays {
            too_far(plan, bays, findings);
            return None;
        }
        let ends = if alone { plan.spacing / 2.0 } else { 0.0 };
        let usual = bays - changed;
        let length = from_left.reach(from_left.changed() + usual) + from_right.reach(from_right.changed()) + 2.0 * ends;
        let place = |bay: usize| match bay + from_right.changed() <= bays {
            true => ends + from_left.reach(bay),
            false => length - ends - from_right.reach(bays - bay),
        };
        return Some((length, (before..before + n).map(place).collect()));
    }
    let length = plan.length.value;
    if length < plan.spacing * (1.0 - TINY) {
        too_short(plan, findings);
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
            let usual =
                (length - from_left.reach(from_left.changed()) - from_right.reach(from_right.changed())) / plan.spacing;
            if (usual - usual.round()).abs() > WHOLE || usual < -WHOLE {
                does_not_meet(plan, usual, findings);
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
        findings.report(
            Diagnostic::new(Code::E0502, format!("section `{}` is too short to hold a seat", plan.name))
                .label(plan.span, "too short"),
        );
        return None;
    }
    Some((length, seats))
}

/// The number of sleepers that a section holds.
fn whole_sleepers(plan: &Plan, findings: &mut Findings) -> Option<usize> {
    let n = plan.length.value;
    if n.fract() != 0.0 || n < 1.0 {
        findings.report(
            Diagnostic::new(
                Code::E0502,
                format!("a section must hold a whole number of sleepers, found {}", number(n)),
            )
            .label(plan.span, "not a whole number"),
        );
        return None;
    }
    Some(n as usize)
}

fn too_short(plan: &Plan, findings: &mut Findings) {
    let (length, bay) = (number(plan.length.value), number(plan.spacing));
    let message = format!("section `{}` of {length} m is shorter than one bay of {bay} m", plan.name);
    findings.report(Diagnostic::new(Code::E0502, message).label(plan.span, "too short"));
}

fn too_far(plan: &Plan, bays: usize, findings: &mut Findings) {
    let (changed, name) = (plan.bays[0].len() + plan.bays[1].len(), &plan.name);
    let message = format!("stretches change the spacing of {changed} bays of section `{name}`, which has {bays}");
    findings.report(
        Diagnostic::new(Code::E0502, message)
            .label(plan.span, "too few sleepers")
            .help(format!("shorten the stretches that set `spacing`: they may change {bays} bays at most")),
    );
}

fn does_not_meet(plan: &Plan, usual: f64, findings: &mut Findings) {
    let [bay, length] = [plan.spacing, plan.length.value];
    let fits = |n: f64| number(tidy(length + (n - usual) * bay));
    let more = if plan.bays.iter().all(Vec::is_empty) { "" } else { " beside those that stretches change" };
    let over = (usual - usual.floor().max(0.0)) * bay * 1e3;
    let message = format!(
        "section `{}` lies between two transitions and holds {} bays of {} m{more} and {} mm, not a whole number",
        plan.name,
        number(usual.floor().max(0.0)),
        number(bay),
        number((over * 10.0).round() / 10.0)
    );
    let plain = plan.bays.iter().all(Vec::is_empty) && plan.first == [None; 2];
    // the length of a structure is fixed
    let spacing = match usual.round() {
        bays if plain && bays >= 1.0 => {
            format!("; if the length is fixed, write `spacing = {} m / {}`", number(length), number(bays))
        }
        _ => String::new(),
    };
    findings.report(
        Diagnostic::new(Code::E0502, message).label(plan.span, "the bays from the two transitions do not meet").help(
            format!(
                "write `{} m` or `{} m`, or give the length in sleepers{spacing}",
                fits(usual.floor().max(0.0)),
                fits(usual.ceil().max(0.0))
            ),
        ),
    );
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

/// Bays from one end of a section: first bays of another spacing, then the usual bays.
struct Row {
    usual: f64,
    /// Additional length of the first bays compared with usual bays, m: for no bay, one bay, ..., all bays of another
    /// spacing.
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

    /// Length of a number of bays, m.
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

/// Rounds sums of spacings, so that a seat on a boundary lies exactly on it.
fn tidy(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}
