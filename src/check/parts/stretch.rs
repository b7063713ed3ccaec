//! Stretches: changes over a span of the track. Each extends the trackform under it with the fields that it sets. Two
//! overlapping stretches must set different fields, so that their order has no effect.

use super::plate::approach_slab;
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::records::object_kind;
use crate::check::evaluate::value::{Change, Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::{Places, TINY};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Stretch};
use crate::schema::{self, Kind};
use crate::syntax::tree::Name;
use crate::units::{Dimension, number};
use std::ops::Range;
use std::rc::Rc;

/// Parts that are the same along a whole section.
const WHOLE_SECTION: [&str; 4] = ["rail", "slab", "crib", "shoulder"];
/// A stretch at one of its transitions.
pub struct Instance {
    pub stretch: Rc<Record>,
    /// The transition from which its places count.
    pub transition: usize,
    /// Chainage of its first and of its last end, m.
    ends: [f64; 2],
    /// The covered span, m, ascending: a span of sleepers reaches half a bay beyond them.
    pub reach: (f64, f64),
    pub seats: Range<usize>,
    pub plate: Option<ApproachSlab>,
}

impl Instance {
    /// Whether it changes a field of the trackform.
    pub fn sets(&self, field: &str) -> bool {
        self.stretch.changes.iter().any(|c| c.field.path.names[0].text == field)
    }

    /// Whether it changes the ground under the sleepers.
    pub(super) fn regrades(&self) -> bool {
        self.sets("layers") || self.plate.is_some()
    }

    /// The place of its span in the text, or of the stretch.
    pub fn over(&self) -> Span {
        self.stretch.get("over").map_or(self.stretch.span, |slot| slot.span)
    }

    /// The seats that it shares with others, if any.
    pub fn common(&self, seats: &Range<usize>) -> Option<Range<usize>> {
        let common = self.seats.start.max(seats.start)..self.seats.end.min(seats.end);
        (!common.is_empty()).then_some(common)
    }
}

/// Puts stretches on the track. All mistakes are reported; `None` if there was one.
pub fn stand(stretches: &[Rc<Record>], places: &Places, findings: &mut Findings) -> Option<Vec<Instance>> {
    let stood: Vec<Option<Vec<Instance>>> =
        stretches.iter().map(|stretch| stand_one(stretch, places, findings)).collect();
    let stood: Vec<Instance> = stood.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
    do_not_clash(&stood, places, findings).then_some(stood)
}

fn stand_one(stretch: &Rc<Record>, places: &Places, findings: &mut Findings) -> Option<Vec<Instance>> {
    let slot = stretch.get("over")?;
    let (Val::Range(a, b), over) = (&slot.value, slot.span) else { return None };
    let transitions: Vec<Option<usize>> = match stretch.get("from").map(|s| &s.value) {
        Some(Val::List(names)) => names
            .iter()
            .map(|slot| match &slot.value {
                Val::Text(name) => places.transition(Some((name, slot.span)), over, findings),
                _ => None,
            })
            .collect(),
        Some(_) => return None,
        None => vec![places.transition(None, over, findings)],
    };
    let sound = says_something(stretch, findings);
    let mut stood = Vec::new();
    for transition in transitions.into_iter().collect::<Option<Vec<_>>>()? {
        let (first, last) = (
            places.chainage_from(*a, transition, over, findings),
            places.chainage_from(*b, transition, over, findings),
        );
        let ends = [first?, last?];
        let by_sleepers = a.dimension == Dimension::SLEEPERS;
        let seats = places.seats_between(ends, transition, by_sleepers || b.value > TINY);
        if seats.is_empty() {
            findings.report(
                Diagnostic::new(Code::E0417, format!("no sleeper lies in stretch `{}`", stretch.name))
                    .label(
                        over,
                        format!("from {} m to {} m", number(ends[0].min(ends[1])), number(ends[0].max(ends[1]))),
                    )
                    .help("lengthen the span, or give it in sleepers"),
            );
            return None;
        }
        let reach = match by_sleepers {
            true => (places.cell(seats.start).0, places.cell(seats.end - 1).1),
            false => (ends[0].min(ends[1]), ends[0].max(ends[1])),
        };
        let plate = approach_slab(stretch, transition, reach, places, findings)?;
        stood.push(Instance { stretch: stretch.clone(), transition, ends, reach, seats, plate });
    }
    Some(stood).filter(|_| sound)
}

/// Whether a stretch changes at least one part, and no part that is the same along a whole section.
fn says_something(stretch: &Record, findings: &mut Findings) -> bool {
    let nothing = stretch.changes.is_empty()
        && !matches!(stretch.get("approach_slab"), Some(s) if !matches!(s.value, Val::Word { .. }));
    if nothing && !stretch.partial {
        findings.report(
            Diagnostic::new(Code::E0417, format!("stretch `{}` changes nothing", stretch.name))
                .label(stretch.span, "gives a place but no change")
                .help("give the changes, such as `usp = usps.medium` or `pad.stiffness = 60 MN/m`"),
        );
    }
    let mut sound = !stretch.partial && !nothing;
    for change in &stretch.changes {
        let name = &change.field.path.names[0];
        if WHOLE_SECTION.contains(&name.text.as_str()) {
            findings.report(
                Diagnostic::new(
                    Code::E0411,
                    format!("this version does not change the `{}` in a stretch yet", name.text),
                )
                .label(change.field.path.span, "the same along its section")
                .help("make it a section of the track with a trackform of its own"),
            );
            sound = false;
        }
    }
    sound
}

/// Refuses stretches that set the same field at the same sleepers.
fn do_not_clash(stood: &[Instance], places: &Places, findings: &mut Findings) -> bool {
    let mut sound = true;
    for (i, later) in stood.iter().enumerate() {
        for first in &stood[..i] {
            let Some(seats) = first.common(&later.seats) else { continue };
            if let (Some(_), Some(_)) = (first.plate, later.plate) {
                sound = false;
                findings.report(two_plates(first, later, &places.named(&seats)));
            }
            let pairs = first.stretch.changes.iter().flat_map(|a| later.stretch.changes.iter().map(move |b| (a, b)));
            let Some((a, b)) = pairs.into_iter().find(|(a, b)| overlap(a, b) || rivals(a, b)) else { continue };
            sound = false;
            findings.report(clash(first, a, later, b, &places.named(&seats)));
        }
    }
    sound
}

/// A trackform as stretches change it, without defaults of the changes.
pub fn extended_by(form: &Record, stretches: &[&Instance], eval: &mut Evaluator<'_>) -> Record {
    let mut extended = form.clone();
    for instance in stretches {
        for change in &instance.stretch.changes {
            eval.change(&mut extended, change);
            if let Some(slot) = slot_at(&mut extended, &change.field.path.names) {
                settle(slot, instance);
            }
        }
    }
    extended
}

/// Stretches of the scene, for drawing.
pub fn described(stood: &[Instance]) -> Vec<Stretch> {
    let what = |instance: &Instance| {
        let mut paths: Vec<String> = instance.stretch.changes.iter().map(|c| c.field.path.text()).collect();
        paths.dedup();
        paths.extend(instance.plate.map(|_| "approach_slab".to_string()));
        paths.join(", ")
    };
    let stretch = |instance: &Instance| {
        let (start, end) = instance.reach;
        Stretch { name: instance.stretch.name.clone(), start, end, changes: what(instance), span: instance.over() }
    };
    stood.iter().map(stretch).collect()
}

/// Whether one path is the other, or lies inside it.
fn overlap(a: &Change, b: &Change) -> bool {
    a.field.path.names.iter().zip(&b.field.path.names).all(|(a, b)| a.text == b.text)
}

/// Whether two paths give the same quantity in different ways, like `pad.damping` and `pad.damping_time`.
fn rivals(a: &Change, b: &Change) -> bool {
    fn within(kind: &'static Kind, a: &[Name], b: &[Name]) -> bool {
        let ([a, inside_a @ ..], [b, inside_b @ ..]) = (a, b) else { return false };
        if a.text == b.text {
            let inner = kind.field(&a.text).and_then(|field| object_kind(&field.form));
            return inner.is_some_and(|inner| within(inner, inside_a, inside_b));
        }
        kind.alternatives.iter().any(|alternative| {
            let way = |name: &Name| alternative.ways.iter().position(|way| way.contains(&name.text.as_str()));
            matches!((way(a), way(b)), (Some(a), Some(b)) if a != b)
        })
    }
    schema::kind("trackform").is_some_and(|form| within(form, &a.field.path.names, &b.field.path.names))
}

fn clash(first: &Instance, a: &Change, later: &Instance, b: &Change, seats: &str) -> Diagnostic {
    let (one, two) = (&first.stretch.name, &later.stretch.name);
    if first.stretch.span == later.stretch.span {
        let mistake = Diagnostic::new(Code::E0512, format!("stretch `{one}` overlaps itself at {seats}"));
        return mistake.label(first.over(), "reaches too far").help("shorten its span, or list it once");
    }
    let (path, other) = (a.field.path.text(), b.field.path.text());
    let message = match path == other {
        true => format!("stretches `{one}` and `{two}` both set `{path}` at {seats}"),
        false => format!("stretch `{one}` sets `{path}` and stretch `{two}` `{other}` at {seats}"),
    };
    Diagnostic::new(Code::E0512, message)
        .label(b.field.path.span, format!("set by `{two}`"))
        .label(a.field.path.span, format!("set by `{one}`"))
        .help("let one span end at the beginning of the other, or set it in only one stretch")
}

/// The value at a path of an object.
fn slot_at<'a>(record: &'a mut Record, path: &[Name]) -> Option<&'a mut Slot> {
    let (name, rest) = path.split_first()?;
    let slot = record.fields.get_mut(name.text.as_str())?;
    let [next, ..] = rest else { return Some(slot) };
    match &mut slot.value {
        Val::Record(inner) => slot_at(Rc::make_mut(inner), rest),
        Val::Word { arguments, .. } => arguments.get_mut(next.text.as_str()),
        Val::Pairs(pairs) => pairs
            .iter_mut()
            .find(|(key, _)| matches!(&key.value, Val::Record(r) if r.name == next.text))
            .map(|(_, value)| value),
        _ => None,
    }
}

/// Profiles that a stretch sets run over it, and count from its transition.
fn settle(slot: &mut Slot, ground: &Instance) {
    match &mut slot.value {
        Val::Profile(shape) => Rc::make_mut(shape).settle(ground.transition, ground.ends),
        Val::Record(record) => Rc::make_mut(record).fields.values_mut().for_each(|slot| settle(slot, ground)),
        Val::Word { arguments, .. } => arguments.values_mut().for_each(|slot| settle(slot, ground)),
        Val::List(slots) => slots.iter_mut().for_each(|slot| settle(slot, ground)),
        Val::Pairs(pairs) => pairs.iter_mut().for_each(|(key, value)| {
            settle(key, ground);
            settle(value, ground);
        }),
        _ => {}
    }
}

/// Two stretches that put a plate under the same seats.
fn two_plates(first: &Instance, later: &Instance, seats: &str) -> Diagnostic {
    Diagnostic::new(Code::E0512, format!("two approach slabs overlap at {seats}"))
        .label(later.over(), format!("the slab of `{}`", later.stretch.name))
        .label(first.over(), format!("the slab of `{}`", first.stretch.name))
        .help("let one span end at the beginning of the other")
}
