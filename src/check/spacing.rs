//! Spacing that varies in a stretch or over a section: bays laid out from the transition outwards, each as long as the spacing at the sleeper that
//! it follows. The bay between a boundary and sleeper -1 is that of sleeper -1.

use super::Checker;
use super::geometry::{MOST_SEATS, Plan};
use super::profile::{Shape, ShapeKind};
use super::value::{Number, Record, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Given, Side};
use crate::units::Dimension;
use std::rc::Rc;

const TINY: f64 = 1e-6; // m

/// Spacing over a stretch, m, counted from one transition.
struct Graded {
    /// Its ends: m, or numbers of sleepers.
    over: [Number; 2],
    /// At its first and last end; a cubic with level ends between them if smooth.
    ends: [f64; 2],
    smooth: bool,
}

/// On which side of a boundary bays are laid out.
#[derive(Clone, Copy, PartialEq)]
enum Bank {
    Soft,
    Stiff,
}

impl Checker<'_> {
    /// The spacing of a section, m; where it varies the mean of both ends.
    pub(super) fn usual_spacing(&mut self, form: &Record) -> Option<Given> {
        let slot = form.get("spacing")?;
        match &slot.value {
            Val::Number(n) => Some(Given { value: n.value, origin: slot.origin }),
            Val::Profile(_) => {
                let (ends, ..) = self.graded(form)??;
                Some(Given { value: 0.5 * (ends[0] + ends[1]), origin: slot.origin })
            }
            _ => None,
        }
    }

    /// Gives sections the bays that stretches change. What is wrong with their places is said where they stand.
    pub(super) fn spread(
        &mut self,
        plans: &mut [Plan],
        sides: &[(String, Side)],
        forms: &[Rc<Record>],
        stretches: &[Rc<Record>],
    ) -> Option<()> {
        let mut graded: Vec<(usize, Graded)> = Vec::new();
        for stretch in stretches {
            let Some(Val::Range(a, b)) = stretch.get("over").map(|slot| &slot.value) else { continue };
            let Some((ends, smooth, span)) = self.graded(stretch)? else { continue };
            if sides.is_empty() && a.dimension == Dimension::LENGTH {
                self.only_graded(span, "counted in sleepers, on a track of one section");
                return None;
            }
            for transition in from_of(stretch, sides) {
                graded.push((transition, Graded { over: [*a, *b], ends, smooth }));
            }
        }
        for (section, (plan, form)) in plans.iter().zip(forms).enumerate() {
            if let Some(Val::Profile(_)) = form.get("spacing").map(|slot| &slot.value) {
                let (ends, smooth, span) = self.graded(form)??;
                let Some(own) = whole_section(section, plan, sides, ends, smooth) else {
                    self.only_graded(span, "one value in a section in metres between two transitions");
                    return None;
                };
                graded.push(own);
            }
        }
        for (section, (plan, form)) in plans.iter_mut().zip(forms).enumerate() {
            // a section lies right of the transition before it and left of the one after it
            let [before, after] = [section.checked_sub(1), Some(section)].map(|t| Some((t?, sides.get(t?)?.1)));
            let bank = |side: Side, left_of_it: bool| match (side == Side::SoftToStiff) == left_of_it {
                true => Bank::Soft,
                false => Bank::Stiff,
            };
            let of = |transition: usize| graded.iter().filter(|g| g.0 == transition).map(|g| &g.1).collect::<Vec<_>>();
            if let Some((transition, side)) = before {
                plan.bays[0] = bays(&of(transition), bank(side, false), plan, plan.first[0]);
            } else if sides.is_empty() {
                plan.bays[0] = bays(&of(0), Bank::Stiff, plan, None);
            }
            if let Some((transition, side)) = after {
                plan.bays[1] = bays(&of(transition), bank(side, true), plan, plan.first[1]);
            }
            if let (Some(Val::Profile(_)), Dimension::SLEEPERS) =
                (form.get("spacing").map(|slot| &slot.value), plan.length.dimension)
            {
                // a bay at an end where no seat stands on the boundary
                let alone = sides.is_empty();
                let apart = |stiffer: Option<bool>, first: Option<f64>| match (stiffer, first) {
                    (_, Some(distance)) => distance > TINY,
                    (Some(stiffer), None) => !stiffer,
                    (None, None) => !alone,
                };
                let left = apart(before.map(|(_, side)| side == Side::SoftToStiff), plan.first[0]);
                let right = apart(after.map(|(_, side)| side == Side::StiffToSoft), plan.first[1]);
                let count = (plan.length.value as usize + usize::from(left) + usize::from(right)).saturating_sub(1);
                plan.bays.iter_mut().for_each(|bays| bays.truncate(count));
            }
        }
        Some(())
    }

    /// The spacing that a stretch sets, with its place; the outer `None` where it is not understood.
    #[allow(clippy::type_complexity)]
    fn graded(&mut self, stretch: &Record) -> Option<Option<([f64; 2], bool, Span)>> {
        let Some(slot) = stretch.get("spacing") else { return Some(None) };
        match &slot.value {
            Val::Number(n) => Some(Some(([n.value; 2], false, slot.span))),
            Val::Profile(shape) => match &**shape {
                Shape { kind: ShapeKind::Ramp { from, to, smooth, over: None }, span, .. } => {
                    Some(Some(([from.value, to.value], *smooth, *span)))
                }
                other => {
                    self.only_graded(
                        other.span,
                        "constant, `ramp(a .. b)` or `smooth(a .. b)` over its stretch or section",
                    );
                    None
                }
            },
            _ => None,
        }
    }

    fn only_graded(&mut self, span: Span, how: &str) {
        let message = format!("this version takes a `spacing` that varies {how}");
        self.report(Diagnostic::new(Code::E0411, message).at(span, "not this one"));
    }
}

/// The transitions from which a stretch counts, as far as there are such.
fn from_of(stretch: &Record, sides: &[(String, Side)]) -> Vec<usize> {
    match stretch.get("from").map(|slot| &slot.value) {
        Some(Val::List(names)) => names
            .iter()
            .filter_map(|slot| match &slot.value {
                Val::Text(name) => sides.iter().position(|(side, _)| side == name),
                _ => None,
            })
            .collect(),
        _ if sides.len() < 2 => vec![0],
        _ => Vec::new(),
    }
}

/// The spacing of a whole section as if a stretch set it, counted from the transition at its left, or else at its right; `None` for a
/// section in metres between two transitions, where the bays would have to meet.
fn whole_section(
    section: usize,
    plan: &Plan,
    sides: &[(String, Side)],
    [left, right]: [f64; 2],
    smooth: bool,
) -> Option<(usize, Graded)> {
    let by_sleepers = plan.length.dimension == Dimension::SLEEPERS;
    let before = section.checked_sub(1).filter(|t| *t < sides.len());
    let after = Some(section).filter(|t| *t < sides.len());
    if before.is_some() && after.is_some() && !by_sleepers {
        return None;
    }
    let transition = before.or(after).unwrap_or(0);
    let side = sides.get(transition).map_or(Side::SoftToStiff, |(_, side)| *side);
    let soft = sides.len() > transition && (before.is_none() == (side == Side::SoftToStiff));
    let end = |value: f64| Number { value, ..plan.length };
    let reach = plan.length.value;
    let first = if by_sleepers { 1.0 } else { 0.0 };
    let over = if soft { [end(-reach), end(-first)] } else { [end(first), end(reach)] };
    // places count as x grows, unless the softer side lies right
    let ends = if side == Side::SoftToStiff { [left, right] } else { [right, left] };
    Some((transition, Graded { over, ends, smooth }))
}

/// Bays outwards from a boundary, as far as any is changed: first the one between the boundary and the nearest seat, where that lies
/// apart from it (`first` m away, where the transition says so), then the bay beyond each sleeper in turn, no more than the
/// section may have.
fn bays(graded: &[&Graded], bank: Bank, plan: &Plan, first: Option<f64>) -> Vec<f64> {
    let usual = plan.spacing;
    // one bay more than sleepers: the one before the first
    let most = (plan.most_seats() + 1).min(MOST_SEATS);
    let mut bays = Vec::new();
    let mut distance = 0.0;
    let mut changed = 0;
    if bank == Bank::Soft || first.is_some_and(|first| first > TINY) {
        let graded = graded.iter().find_map(|g| g.at(1, distance, bank)).filter(|_| bank == Bank::Soft);
        let stated = first.or(graded);
        changed = usize::from(stated.is_some());
        bays.push(stated.unwrap_or(usual));
        distance = bays[0];
    }
    let mut sleeper = 1;
    while bays.len() < most && graded.iter().any(|g| g.goes_on(sleeper, distance, bank)) {
        let bay = graded.iter().find_map(|g| g.at(sleeper, distance, bank));
        bays.push(bay.unwrap_or(usual));
        distance += bay.unwrap_or(usual);
        changed = if bay.is_some() { bays.len() } else { changed };
        sleeper += 1;
    }
    bays.truncate(changed);
    bays
}

impl Graded {
    fn by_sleepers(&self) -> bool {
        self.over[0].dimension == Dimension::SLEEPERS
    }

    /// The place of a sleeper on a bank, in the unit of `over`.
    fn place(&self, sleeper: usize, distance: f64, bank: Bank) -> f64 {
        let place = if self.by_sleepers() { sleeper as f64 } else { distance };
        if bank == Bank::Soft { -place } else { place }
    }

    /// Whether it reaches to or beyond a sleeper.
    fn goes_on(&self, sleeper: usize, distance: f64, bank: Bank) -> bool {
        let place = self.place(sleeper, distance, bank);
        if bank == Bank::Soft { self.over[0].value <= place + TINY } else { self.over[1].value >= place - TINY }
    }

    /// The spacing at a sleeper; `None` where it says nothing.
    fn at(&self, sleeper: usize, distance: f64, bank: Bank) -> Option<f64> {
        let [a, b] = self.over.map(|end| end.value);
        let place = self.place(sleeper, distance, bank);
        // a span in metres that ends at the transition stays on its side
        let beyond = match bank {
            Bank::Soft => a < -TINY,
            Bank::Stiff => b > TINY,
        };
        if !beyond || place < a - TINY || place > b + TINY {
            return None;
        }
        // there is no sleeper 0
        let step = |n: f64| if self.by_sleepers() && n > 0.0 { n - 1.0 } else { n };
        let width = step(b) - step(a);
        let share = if width > 0.0 { (step(place) - step(a)) / width } else { 0.0 };
        let share = if self.smooth { share * share * (3.0 - 2.0 * share) } else { share };
        Some(self.ends[0] + share * (self.ends[1] - self.ends[0]))
    }
}
