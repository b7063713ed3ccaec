//! Spacing that varies in a stretch: bays laid out from the transition outwards, each as long as the spacing at the sleeper that
//! it follows. The bay between a boundary and sleeper -1 is that of sleeper -1.

use super::Checker;
use super::geometry::{MOST_SEATS, Plan};
use super::profile::{Shape, ShapeKind};
use super::value::{Number, Record, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::Side;
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
    /// A section has one spacing; only stretches vary it.
    pub(super) fn one_spacing(&mut self, form: &Record) {
        if let Some(Val::Profile(shape)) = form.get("spacing").map(|slot| &slot.value) {
            self.report(
                Diagnostic::new(Code::E0411, "this version varies the `spacing` of a stretch only")
                    .at(shape.span, "of a whole section")
                    .help("write one spacing here, and `stretch closer { over = ..., spacing = ramp(a .. b) }`"),
            );
        }
    }

    /// Gives sections the bays that stretches change. What is wrong with their places is said where they stand.
    pub(super) fn spread(
        &mut self,
        plans: &mut [Plan],
        sides: &[(String, Side)],
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
        for (section, plan) in plans.iter_mut().enumerate() {
            // a section lies right of the transition before it and left of the one after it
            let [before, after] = [section.checked_sub(1), Some(section)].map(|t| Some((t?, sides.get(t?)?.1)));
            let bank = |side: Side, left_of_it: bool| match (side == Side::SoftToStiff) == left_of_it {
                true => Bank::Soft,
                false => Bank::Stiff,
            };
            let of = |transition: usize| graded.iter().filter(|g| g.0 == transition).map(|g| &g.1).collect::<Vec<_>>();
            if let Some((transition, side)) = before {
                plan.bays[0] = bays(&of(transition), bank(side, false), plan);
            } else if sides.is_empty() {
                plan.bays[0] = bays(&of(0), Bank::Stiff, plan);
            }
            if let Some((transition, side)) = after {
                plan.bays[1] = bays(&of(transition), bank(side, true), plan);
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
                    self.only_graded(other.span, "constant, `ramp(a .. b)` or `smooth(a .. b)` over its stretch");
                    None
                }
            },
            _ => None,
        }
    }

    fn only_graded(&mut self, span: Span, how: &str) {
        let message = format!("this version takes the `spacing` of a stretch {how}");
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

/// Bays outwards from a boundary, as far as any is changed: first the one between the boundary and sleeper -1, on its softer
/// side, then the bay beyond each sleeper in turn, no more than the section may have.
fn bays(graded: &[&Graded], bank: Bank, plan: &Plan) -> Vec<f64> {
    let usual = plan.spacing;
    let most = plan.most_seats().min(MOST_SEATS);
    let mut bays = Vec::new();
    let mut distance = 0.0;
    let mut changed = 0;
    if bank == Bank::Soft {
        let first = graded.iter().find_map(|g| g.at(1, distance, bank));
        changed = usize::from(first.is_some());
        bays.push(first.unwrap_or(usual));
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
