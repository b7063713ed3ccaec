//! Spacing that varies in a stretch or over a section. Bays are laid out from the transition outwards; the length of
//! each bay is the spacing at the sleeper before it. The bay between a boundary and sleeper -1 has the spacing of
//! sleeper -1.
//!
//! The places of sleepers depend on the bays before them, so a profile of spacing is read before the track is laid out:
//! here with its end values beyond its places. When the seats have places, the profile is laid along them like any
//! other, and gaps are reported.

use super::along::lay_profile;
use super::chainage::{Places, TINY};
use super::cover::Cover;
use super::geometry::{CLOSEST, MOST_SEATS, Plan};
use super::random_field::RandomField;
use crate::check::evaluate::number::Number;
use crate::check::evaluate::shape::{Reach, Shape, ShapeKind};
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Given, Seat, Side};
use crate::units::{Dimension, number};
use std::rc::Rc;

/// Spacing over a stretch, m, counted from one transition.
struct Graded {
    /// Its ends: m, or numbers of sleepers.
    over: [Number; 2],
    shape: Rc<Shape>,
    /// A ramp without places of its own runs from the last end of `over` to its first.
    turned: bool,
    ground: Ground,
}

/// Conversion of places to chainages, for profiles that are read at chainages.
#[derive(Clone, Copy)]
struct Ground {
    /// Whether places grow with chainage.
    grows: bool,
    /// Chainage of place 0, m.
    origin: f64,
    /// The seed of random values.
    seed: u64,
}

/// The place of a value: counted from the transition in sleepers and in m, and as chainage, m.
#[derive(Clone, Copy)]
struct At {
    sleeper: f64,
    metres: f64,
    chainage: f64,
}

/// The side of a boundary on which bays are laid out.
#[derive(Clone, Copy, PartialEq)]
enum Bank {
    Soft,
    Stiff,
}

/// The spacing of a section, m; if it varies, the mean of the values that it names.
pub fn usual_spacing(form: &Record) -> Option<Given> {
    let slot = form.get("spacing")?;
    match &slot.value {
        Val::Number(n) => Some(Given { value: n.value, origin: slot.origin }),
        Val::Profile(shape) => Some(Given { value: shape.middle(), origin: slot.origin }),
        _ => None,
    }
}

/// Gives sections the bays that stretches change. Mistakes in their places are reported elsewhere.
pub fn spread(
    plans: &mut [Plan],
    sides: &[(String, Side)],
    forms: &[Rc<Record>],
    stretches: &[Rc<Record>],
    seed: u64,
    findings: &mut Findings,
) -> Option<()> {
    let mut graded: Vec<(usize, Graded)> = Vec::new();
    for stretch in stretches {
        let Some(Val::Range(a, b)) = stretch.get("over").map(|slot| &slot.value) else { continue };
        let Some(shape) = graded_by(stretch) else { continue };
        if sides.is_empty() && a.dimension == Dimension::LENGTH {
            only_graded(shape.span, "in stretches counted in sleepers, on a track with one section", findings);
            return None;
        }
        readable(&shape, sides, false, findings)?;
        for transition in from_of(stretch, sides) {
            let ground = ground_of(sides, plans, seed);
            graded.push((transition, Graded { over: [*a, *b], shape: shape.clone(), turned: false, ground }));
        }
    }
    for (section, (plan, form)) in plans.iter().zip(forms).enumerate() {
        if let Some(Val::Profile(shape)) = form.get("spacing").map(|slot| &slot.value) {
            readable(shape, sides, true, findings)?;
            let ground = ground_of(sides, plans, seed);
            let Some(own) = whole_section(section, plan, sides, shape, ground) else {
                only_graded(shape.span, "in sections that do not lie in metres between two transitions", findings);
                return None;
            };
            graded.push(own);
        }
    }
    for (section, (plan, form)) in plans.iter_mut().zip(forms).enumerate() {
        // a section lies right of the transition before it and left of the transition after it
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
            // a bay at an end without a seat on the boundary
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

/// Refuses profiles that are read at chainages if these are not known yet.
fn readable(shape: &Shape, sides: &[(String, Side)], of_section: bool, findings: &mut Findings) -> Option<()> {
    let by_chainage = shape.asks(&|kind| matches!(kind, ShapeKind::Random(_) | ShapeKind::Table { .. }));
    let by_places = shape.asks(&|kind| {
        matches!(kind, ShapeKind::Points(_) | ShapeKind::Spans(_) | ShapeKind::Ramp { over: Some(_), .. })
    });
    if sides.len() > 1 && (by_chainage || by_places && of_section) {
        let how = "by places counted from the transition of a stretch, on a track with several transitions";
        only_graded(shape.span, how, findings);
        return None;
    }
    Some(())
}

fn ground_of(sides: &[(String, Side)], plans: &[Plan], seed: u64) -> Ground {
    let grows = sides.first().is_none_or(|(_, side)| *side == Side::SoftToStiff);
    // without a transition sleeper +1 lies in the middle of its bay
    let origin = if sides.is_empty() { plans.first().map_or(0.0, |plan| plan.spacing / 2.0) } else { 0.0 };
    Ground { grows, origin, seed }
}

/// Lays the profiles of spacing along the seats that they made: each must cover all its seats.
pub fn prove_spacing(
    forms: &[Rc<Record>],
    stretches: &[Rc<Record>],
    places: &Places,
    findings: &mut Findings,
) -> Option<()> {
    let mut sound = true;
    for (section, form) in forms.iter().enumerate() {
        let Some(slot) = form.get("spacing") else { continue };
        let Val::Profile(shape) = &slot.value else { continue };
        let (start, end) = places.sections[section];
        let what = format!("the spacing of trackform `{}`", form.name);
        let cover = Cover { what, start, end, seats: Some(places.seats_of(section)), smooth: false };
        sound &= lay_profile(shape, slot.origin, places, &cover, findings).is_some();
    }
    for stretch in stretches {
        let Some((slot, over)) = stretch.get("spacing").zip(stretch.get("over")) else { continue };
        let (Val::Profile(shape), Val::Range(a, b)) = (&slot.value, &over.value) else { continue };
        let sides: Vec<_> = places.transitions.iter().map(|t| (t.name.clone(), t.side)).collect();
        for transition in from_of(stretch, &sides) {
            let ends = [*a, *b].map(|place| places.chainage_from(place, transition, over.span, findings));
            // a span off the track is reported when the stretch is placed
            let [Some(from), Some(to)] = ends else { return Some(()) };
            let (start, end) = (from.min(to), from.max(to));
            let first = places.seats.partition_point(|seat| seat.0 < start - TINY);
            let last = places.seats.partition_point(|seat| seat.0 <= end + TINY);
            let mut shape = (**shape).clone();
            shape.settle(transition, [from, to]);
            let what = format!("the spacing of stretch `{}`", stretch.name);
            let cover = Cover { what, start, end, seats: Some(first..last), smooth: false };
            sound &= lay_profile(&shape, slot.origin, places, &cover, findings).is_some();
        }
    }
    sound.then_some(())
}

/// Refuses sleepers that overlap, once per section.
pub fn sleepers_apart(seats: &[Seat], forms: &[Rc<Record>], places: &Places, findings: &mut Findings) -> Option<()> {
    let mut told = None;
    for (pair, at) in seats.windows(2).zip(places.seats.windows(2)) {
        let (Some(left), Some(right)) = (pair[0].sleeper, pair[1].sleeper) else { continue };
        let (apart, wide) = (pair[1].x - pair[0].x, 0.5 * (left.base_width + right.base_width));
        let section = at[0].1;
        if apart > wide - TINY || told == Some(section) {
            continue;
        }
        told = Some(section);
        let message = format!(
            "sleepers {:+} and {:+} overlap: they are {} m apart, but each is {} m wide",
            at[0].3,
            at[1].3,
            number((1e3 * apart).round() / 1e3),
            number((1e3 * wide).round() / 1e3)
        );
        let form = &forms[section];
        let span = form.get("spacing").map_or(form.span, |slot| slot.span);
        findings.report(
            Diagnostic::new(Code::E0407, message)
                .label(span, "spacing of this section")
                .help("write a larger `spacing` or a smaller `base_width`; stretches can change both"),
        );
    }
    told.is_none().then_some(())
}

fn only_graded(span: Span, how: &str, findings: &mut Findings) {
    let message = format!("this version allows a varying `spacing` only {how}");
    findings.report(Diagnostic::new(Code::E0411, message).label(span, "not allowed here"));
}

/// The existing transitions from which a stretch counts.
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

/// The spacing that a stretch sets.
fn graded_by(stretch: &Record) -> Option<Rc<Shape>> {
    let slot = stretch.get("spacing")?;
    match &slot.value {
        Val::Number(n) => {
            Some(Rc::new(Shape { kind: ShapeKind::Constant(*n), span: slot.span, from: None, runs: None }))
        }
        Val::Profile(shape) => Some(shape.clone()),
        _ => None,
    }
}

/// The spacing of a whole section, treated as a stretch that counts from the transition at its left, or else at its
/// right; `None` for a section in metres between two transitions, because the bays from the two transitions would have
/// to meet.
fn whole_section(
    section: usize,
    plan: &Plan,
    sides: &[(String, Side)],
    shape: &Rc<Shape>,
    ground: Ground,
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
    // a ramp runs in the direction of x; places run against x if the softer side lies right
    Some((transition, Graded { over, shape: shape.clone(), turned: side != Side::SoftToStiff, ground }))
}

/// Bays outwards from a boundary, up to the last changed bay. The first is the bay between the boundary and the nearest
/// seat, if the seat is not on the boundary (`first` m away, if the transition gives it). Then follows the bay beyond
/// each sleeper, up to the largest number of bays of the section.
fn bays(graded: &[&Graded], bank: Bank, plan: &Plan, first: Option<f64>) -> Vec<f64> {
    let usual = plan.spacing;
    // one bay more than sleepers: the bay before the first sleeper
    let most = (plan.most_seats() + 1).min(MOST_SEATS);
    let mut bays = Vec::new();
    let mut distance = 0.0;
    let mut changed = 0;
    if bank == Bank::Soft || first.is_some_and(|first| first > TINY) {
        let graded = graded.iter().find_map(|g| g.spacing_at(1, distance, bank)).filter(|_| bank == Bank::Soft);
        let stated = first.or(graded);
        changed = usize::from(stated.is_some());
        bays.push(stated.unwrap_or(usual));
        distance = bays[0];
    }
    let mut sleeper = 1;
    while bays.len() < most && graded.iter().any(|g| g.goes_on(sleeper, distance, bank)) {
        let bay = graded.iter().find_map(|g| g.spacing_at(sleeper, distance, bank));
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

    /// The spacing at a sleeper; `None` if it is not given.
    fn spacing_at(&self, sleeper: usize, distance: f64, bank: Bank) -> Option<f64> {
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
        let sign = if bank == Bank::Soft { -1.0 } else { 1.0 };
        let Ground { grows, origin, seed } = self.ground;
        let metres = sign * distance + origin;
        let chainage = if grows { metres } else { -metres };
        let at = At { sleeper: sign * sleeper as f64, metres, chainage };
        let over = if self.turned { [self.over[1], self.over[0]] } else { self.over };
        // spacings out of range are reported when the seats have places
        Some(self.shape.read(at, over, seed).clamp(CLOSEST, 2.0))
    }
}

impl At {
    /// The place in the unit of a key of this dimension.
    fn counted_by(self, key: Number) -> f64 {
        if key.dimension == Dimension::SLEEPERS { step(self.sleeper, key) } else { self.metres }
    }
}

/// A place on a line without the gap at sleeper 0, which does not exist.
fn step(place: f64, key: Number) -> f64 {
    if key.dimension == Dimension::SLEEPERS && place > 0.0 { place - 1.0 } else { place }
}

impl Shape {
    /// Whether a part of the shape has some kind.
    fn asks(&self, of: &dyn Fn(&ShapeKind) -> bool) -> bool {
        let inside = match &self.kind {
            ShapeKind::Spans(spans) => spans.iter().any(|(_, inner)| inner.asks(of)),
            _ => false,
        };
        inside || of(&self.kind)
    }

    /// The mean of the values that it names.
    fn middle(&self) -> f64 {
        let mean = |values: &mut dyn ExactSizeIterator<Item = f64>| {
            let count = values.len().max(1) as f64;
            values.sum::<f64>() / count
        };
        match &self.kind {
            ShapeKind::Constant(n) => n.value,
            ShapeKind::Ramp { from, to, .. } => 0.5 * (from.value + to.value),
            ShapeKind::Points(points) => mean(&mut points.iter().map(|(.., n)| n.value)),
            ShapeKind::Spans(spans) => mean(&mut spans.iter().map(|(_, inner)| inner.middle())),
            ShapeKind::Random(random) => random.mean.value,
            ShapeKind::Table { rows, .. } => mean(&mut rows.iter().map(|(_, n)| n.value)),
        }
    }

    /// Its value at a place; beyond its own places its end values. A ramp without a span of its own runs over `over`.
    fn read(&self, at: At, over: [Number; 2], seed: u64) -> f64 {
        match &self.kind {
            ShapeKind::Constant(n) => n.value,
            ShapeKind::Ramp { from, to, smooth, over: own } => {
                let [a, b] = own.map_or(over, |reach| [reach.from, reach.to]);
                let [first, last] = [step(a.value, a), step(b.value, b)];
                let share =
                    if first == last { 0.0 } else { ((at.counted_by(a) - first) / (last - first)).clamp(0.0, 1.0) };
                let share = if *smooth { share * share * (3.0 - 2.0 * share) } else { share };
                from.value + share * (to.value - from.value)
            }
            ShapeKind::Points(points) => {
                let row = |i: usize| points.get(i).map(|(key, _, n)| [step(key.value, *key), n.value]);
                points.first().map_or(0.0, |(key, ..)| between(points.len(), &row, at.counted_by(*key)))
            }
            ShapeKind::Spans(spans) => {
                // if two meet, the right one counts
                let reach = |(reach, _): &&(Reach, Shape)| {
                    let [a, b] = [reach.from, reach.to].map(|end| step(end.value, end));
                    let place = at.counted_by(reach.from);
                    (a.min(b) - place).max(place - a.max(b)).max(0.0)
                };
                let least = spans.iter().map(|span| reach(&span)).fold(f64::INFINITY, f64::min);
                let found = spans.iter().rev().find(|span| reach(span) <= least + TINY);
                found.map_or(0.0, |(reach, inner)| inner.read(at, [reach.from, reach.to], seed))
            }
            ShapeKind::Random(random) => {
                let field = RandomField::new(random.seed.unwrap_or(seed), &random.path, random.correlation);
                random.value(field.value(at.chainage))
            }
            ShapeKind::Table { rows, .. } => {
                between(rows.len(), &|i| rows.get(i).map(|(x, n)| [*x, n.value]), at.chainage)
            }
        }
    }
}

/// The value of a broken line through points `[place, value]` in order, constant beyond them.
fn between(count: usize, point: &dyn Fn(usize) -> Option<[f64; 2]>, place: f64) -> f64 {
    let falls = matches!((point(0), point(count.saturating_sub(1))), (Some(a), Some(b)) if a[0] > b[0]);
    let row = |i: usize| point(if falls { count.checked_sub(i + 1)? } else { i });
    let (mut below, mut above) = (0, count);
    while below < above {
        let middle = below.midpoint(above);
        if row(middle).is_some_and(|[x, _]| x <= place) { below = middle + 1 } else { above = middle }
    }
    match (below.checked_sub(1).and_then(row), row(below)) {
        (Some([a, from]), Some([b, to])) => from + (to - from) * (place - a) / (b - a),
        (Some([_, value]), None) | (None, Some([_, value])) => value,
        (None, None) => 0.0,
    }
}
