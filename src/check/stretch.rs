//! Stretches: what differs over a span of the track. Each extends the trackform under it with the fields that it sets; where
//! two overlap they must set different things, so that their order means nothing.

use super::Checker;
use super::geometry::Places;
use super::ground::{Regrade, Under};
use super::groundwork::two_plates;
use super::records::object_kind;
use super::value::{Change, Record, Slot, Val};
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, AuxiliaryRailSpan, Layer, Seat, Stretch};
use crate::schema::{self, Kind};
use crate::syntax::tree::Name;
use crate::units::{Dimension, number};
use std::ops::Range;
use std::rc::Rc;

/// Two chainages closer than this are one place, m.
const TINY: f64 = 1e-6;
/// Parts that make a section what it is from end to end.
const WHOLE_SECTION: [&str; 2] = ["rail", "slab"];
/// What only sleepers on a support that gives have.
const OF_SLEEPERS: [&str; 5] = ["sleeper", "usp", "support", "settlement", "layers"];

/// A stretch at one of its transitions.
pub(super) struct Instance {
    pub stretch: Rc<Record>,
    /// From which its places count.
    transition: usize,
    /// Chainage of its first and of its last end, m.
    ends: [f64; 2],
    /// What it covers, m, ascending: a span of sleepers reaches half a bay beyond them.
    pub reach: (f64, f64),
    seats: Range<usize>,
    pub plate: Option<ApproachSlab>,
}

impl Instance {
    pub fn sets(&self, field: &str) -> bool {
        self.stretch.changes.iter().any(|c| c.field.path.names[0].text == field)
    }

    /// Whether it changes what lies under the sleepers.
    pub fn regrades(&self) -> bool {
        self.sets("layers") || self.plate.is_some()
    }

    pub fn over(&self) -> Span {
        self.stretch.get("over").map_or(self.stretch.span, |slot| slot.span)
    }

    pub fn common(&self, seats: &Range<usize>) -> Option<Range<usize>> {
        let common = self.seats.start.max(seats.start)..self.seats.end.min(seats.end);
        (!common.is_empty()).then_some(common)
    }
}

impl Checker<'_> {
    /// The stretches that a track lists, and whether all of them are understood.
    pub(super) fn listed(&self, track: &Record) -> (Vec<Rc<Record>>, bool) {
        let Some(Val::List(slots)) = track.get("stretches").map(|slot| &slot.value) else { return (Vec::new(), false) };
        let record = |slot: &Slot| if let Val::Record(r) = &slot.value { Some(r.clone()) } else { None };
        let found: Vec<Rc<Record>> = slots.iter().filter_map(record).collect();
        let sound = found.len() == slots.len();
        (found, sound)
    }

    /// Puts stretches on the track. All mistakes are said; `None` where there was one.
    pub(super) fn stand(&mut self, stretches: &[Rc<Record>], places: &Places) -> Option<Vec<Instance>> {
        let stood: Vec<Option<Vec<Instance>>> =
            stretches.iter().map(|stretch| self.stand_one(stretch, places)).collect();
        let stood: Vec<Instance> = stood.into_iter().collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
        self.do_not_clash(&stood, places).then_some(stood)
    }

    fn stand_one(&mut self, stretch: &Rc<Record>, places: &Places) -> Option<Vec<Instance>> {
        let slot = stretch.get("over")?;
        let (Val::Range(a, b), over) = (&slot.value, slot.span) else { return None };
        let transitions: Vec<Option<usize>> = match stretch.get("from").map(|s| &s.value) {
            Some(Val::List(names)) => names
                .iter()
                .map(|slot| match &slot.value {
                    Val::Text(name) => self.transition(places, Some((name, slot.span)), over),
                    _ => None,
                })
                .collect(),
            Some(_) => return None,
            None => vec![self.transition(places, None, over)],
        };
        let sound = self.says_something(stretch);
        let mut stood = Vec::new();
        for transition in transitions.into_iter().collect::<Option<Vec<_>>>()? {
            let (first, last) =
                (self.counted(places, *a, transition, over), self.counted(places, *b, transition, over));
            let ends = [first?, last?];
            let by_sleepers = a.dimension == Dimension::SLEEPERS;
            let seats = places.seats_between(ends, transition, by_sleepers || b.value > TINY);
            if seats.is_empty() {
                self.report(
                    Diagnostic::new(Code::E0417, format!("no sleeper lies in stretch `{}`", stretch.name))
                        .at(
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
            let plate = self.plate(stretch, transition, reach, places)?;
            stood.push(Instance { stretch: stretch.clone(), transition, ends, reach, seats, plate });
        }
        Some(stood).filter(|_| sound)
    }

    /// Whether a stretch changes anything, and nothing that a section is from end to end.
    fn says_something(&mut self, stretch: &Record) -> bool {
        let nothing = stretch.changes.is_empty()
            && !matches!(stretch.get("approach_slab"), Some(s) if !matches!(s.value, Val::Word { .. }));
        if nothing && !stretch.partial {
            self.report(
                Diagnostic::new(Code::E0417, format!("stretch `{}` changes nothing", stretch.name))
                    .at(stretch.span, "says where, not what")
                    .help("say what differs there, such as `usp = usps.medium` or `pad.stiffness = 60 MN/m`"),
            );
        }
        let mut sound = !stretch.partial && !nothing;
        for change in &stretch.changes {
            let name = &change.field.path.names[0];
            if WHOLE_SECTION.contains(&name.text.as_str()) {
                self.report(
                    Diagnostic::new(
                        Code::E0411,
                        format!("this version does not change the `{}` in a stretch yet", name.text),
                    )
                    .at(change.field.path.span, "the same along its section")
                    .help("make it a section of the track with a trackform of its own"),
                );
                sound = false;
            }
        }
        sound
    }

    /// Refuses stretches that set the same thing at the same sleepers.
    fn do_not_clash(&mut self, stood: &[Instance], places: &Places) -> bool {
        let mut sound = true;
        for (i, later) in stood.iter().enumerate() {
            for first in &stood[..i] {
                let Some(seats) = first.common(&later.seats) else { continue };
                if let (Some(_), Some(_)) = (first.plate, later.plate) {
                    sound = false;
                    self.report(two_plates(first, later, &places.named(&seats)));
                }
                let pairs =
                    first.stretch.changes.iter().flat_map(|a| later.stretch.changes.iter().map(move |b| (a, b)));
                let Some((a, b)) = pairs.into_iter().find(|(a, b)| overlap(a, b) || rivals(a, b)) else { continue };
                sound = false;
                self.report(clash(first, a, later, b, &places.named(&seats)));
            }
        }
        sound
    }

    /// A trackform as stretches change it, without the defaults of what they bring.
    pub(super) fn extended_by(&mut self, form: &Record, stretches: &[&Instance]) -> Record {
        let mut extended = form.clone();
        for instance in stretches {
            for change in &instance.stretch.changes {
                self.change(&mut extended, change);
                if let Some(slot) = slot_at(&mut extended, &change.field.path.names) {
                    settle(slot, instance);
                }
            }
        }
        extended
    }

    /// Gives the seats of a section what the stretches over them say; whether all was understood.
    pub(super) fn change_seats(
        &mut self,
        form: &Record,
        stood: &[Instance],
        places: &Places,
        section: usize,
        layers: Option<&[Layer]>,
        laid: &mut [Seat],
    ) -> bool {
        let whole = places.seats_of(section);
        let here: Vec<(&Instance, Range<usize>)> =
            stood.iter().filter_map(|instance| Some((instance, instance.common(&whole)?))).collect();
        let mut put = |checker: &mut Self, stretches: &[&Instance], seats: Range<usize>| {
            let changed = checker.changed(form, stretches, places, (section, layers), seats.clone());
            if let Some(changed) = &changed {
                laid[seats.start - whole.start..seats.end - whole.start].clone_from_slice(changed);
            }
            changed.is_some()
        };
        // each alone first, so that a mistake in one is said once
        let wrong: Vec<&Instance> = here
            .iter()
            .filter(|(instance, seats)| !put(self, &[instance], seats.clone()))
            .map(|(instance, _)| *instance)
            .collect();
        let mut sound = wrong.is_empty();
        let told = |stretches: &[&Instance]| wrong.iter().any(|w| stretches.iter().any(|s| std::ptr::eq(*w, *s)));
        let over =
            |seat: usize| here.iter().filter(|(_, seats)| seats.contains(&seat)).map(|(i, _)| *i).collect::<Vec<_>>();
        let same =
            |a: &[&Instance], b: &[&Instance]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| std::ptr::eq(*a, *b));
        let mut start = whole.start;
        while start < whole.end && here.len() > 1 {
            let stretches = over(start);
            let end = (start + 1..whole.end).find(|seat| !same(&over(*seat), &stretches)).unwrap_or(whole.end);
            if stretches.len() > 1 && !told(&stretches) {
                sound &= put(self, &stretches, start..end);
            }
            start = end;
        }
        sound
    }

    /// Seats of one section under the same stretches.
    fn changed(
        &mut self,
        form: &Record,
        stretches: &[&Instance],
        places: &Places,
        (section, layers): (usize, Option<&[Layer]>),
        seats: Range<usize>,
    ) -> Option<Vec<Seat>> {
        let extended = self.extended_by(form, stretches);
        for instance in stretches {
            self.stands_right(instance, form, &extended, &places.named(&seats))?;
        }
        let complete = self.complete(&extended);
        let built = self.trackform(&complete, true);
        if !stretches.iter().any(|instance| instance.regrades()) {
            return self.seats(&built, places, section, seats, Under::Section(layers));
        }
        let before = layers?;
        let scales = !stretches.iter().any(|instance| instance.sets("support"));
        for instance in stretches.iter().filter(|_| before.is_empty()) {
            self.has_ground(instance, form)?;
        }
        let plate = stretches.iter().find_map(|instance| instance.plate);
        self.seats(&built, places, section, seats, Under::Regraded(&Regrade { before, plate, scales }))
    }

    /// Refuses what only sleepers have where there are none.
    fn stands_right(&mut self, instance: &Instance, form: &Record, under: &Record, seats: &str) -> Option<()> {
        let (ground, what) = match (form.record("slab").and(form.get("slab")), under.word("support")) {
            (Some(slab), _) => (slab.span, "a slab"),
            (None, Some("rigid")) => (under.get("support")?.span, "rigid supports"),
            _ => return Some(()),
        };
        let has = |name: &str| match under.get(name).map(|slot| &slot.value) {
            Some(Val::Number(n)) => n.value != 0.0,
            Some(Val::Pairs(pairs)) => !pairs.is_empty(),
            value => matches!(value, Some(Val::Profile(_) | Val::Record(_))),
        };
        let wrong = |change: &&Change| {
            let name = change.field.path.names[0].text.as_str();
            OF_SLEEPERS.contains(&name) && has(name)
        };
        let path = instance.stretch.changes.iter().find(wrong).map(|change| &change.field.path);
        let plate = instance.stretch.get("approach_slab").filter(|_| instance.plate.is_some());
        let (path, at) = match (path, plate) {
            (Some(path), _) => (path.text(), path.span),
            (None, Some(slot)) => ("approach_slab".into(), slot.span),
            (None, None) => return Some(()),
        };
        let message = format!("stretch `{}` sets `{path}`, but {seats} stand on {what}", instance.stretch.name);
        self.report(
            Diagnostic::new(Code::E0418, message)
                .at(at, "only sleepers on a support have it")
                .at(instance.over(), "reaches too far")
                .at(ground, what)
                .help("end the span at the last sleeper, as `over = -20 .. -1 sleepers` does; pads can differ on both sides"),
        );
        None
    }

    /// Auxiliary rails along the track: those of sections, cut where a stretch says otherwise, and those of stretches.
    pub(super) fn auxiliary_spans(
        &mut self,
        forms: &[Rc<Record>],
        stood: &[Instance],
        places: &Places,
        of_sections: Vec<AuxiliaryRailSpan>,
    ) -> Option<Vec<AuxiliaryRailSpan>> {
        let mut spans = of_sections;
        for instance in stood.iter().filter(|instance| instance.sets("auxiliary_rails")) {
            let (start, end) = instance.reach;
            spans = spans.into_iter().flat_map(|span| span.without(start, end)).collect();
            let section = places.seats[instance.seats.start].1;
            let extended = self.extended_by(&forms[section], &[instance]);
            let complete = self.complete(&extended);
            let Some(rails) = self.auxiliary_rails(&complete)? else { continue };
            if instance.seats.len() < 2 {
                let message = format!("the auxiliary rails of stretch `{}` lie on one sleeper", instance.stretch.name);
                self.report(
                    Diagnostic::new(Code::E0418, message)
                        .at(instance.over(), "too short")
                        .help("let them reach over two sleepers or more"),
                );
                return None;
            }
            spans.push(AuxiliaryRailSpan { start, end, rails });
        }
        let carried = |span: &AuxiliaryRailSpan| {
            places.seats.iter().filter(|s| (span.start - TINY..=span.end + TINY).contains(&s.0)).count() > 1
        };
        spans.retain(carried);
        spans.sort_by(|a, b| a.start.total_cmp(&b.start));
        Some(spans)
    }
}

/// Stretches as the scene keeps them, for drawing.
pub(super) fn described(stood: &[Instance]) -> Vec<Stretch> {
    let what = |instance: &Instance| {
        let mut paths: Vec<String> = instance.stretch.changes.iter().map(|c| c.field.path.text()).collect();
        paths.dedup();
        paths.extend(instance.plate.map(|_| "approach_slab".to_string()));
        paths.join(", ")
    };
    let stretch = |instance: &Instance| {
        let (start, end) = instance.reach;
        Stretch { name: instance.stretch.name.clone(), start, end, changes: what(instance) }
    };
    stood.iter().map(stretch).collect()
}

/// Whether one path is the other, or lies inside it.
fn overlap(a: &Change, b: &Change) -> bool {
    a.field.path.names.iter().zip(&b.field.path.names).all(|(a, b)| a.text == b.text)
}

/// Whether two paths say the same thing in different ways, as `pad.damping` and `pad.damping_time` do.
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
        let mistake = Diagnostic::new(Code::E0512, format!("stretch `{one}` meets itself at {seats}"));
        return mistake.at(first.over(), "reaches too far").help("shorten its span, or list it once");
    }
    let (path, other) = (a.field.path.text(), b.field.path.text());
    let message = match path == other {
        true => format!("stretches `{one}` and `{two}` both set `{path}` at {seats}"),
        false => format!("stretch `{one}` sets `{path}` and stretch `{two}` `{other}` at {seats}"),
    };
    Diagnostic::new(Code::E0512, message)
        .at(b.field.path.span, format!("set by `{two}`"))
        .at(a.field.path.span, format!("set by `{one}`"))
        .help("let one span end where the other begins, or set it in one of them")
}

/// What stands at a path of an object.
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

impl Places {
    /// Indices of the seats between two chainages. A span in metres that ends at the transition stays on its side: the seat
    /// on the boundary belongs to what goes on beyond it.
    fn seats_between(&self, ends: [f64; 2], transition: usize, beyond: bool) -> Range<usize> {
        let (low, high) = (ends[0].min(ends[1]) - TINY, ends[0].max(ends[1]) + TINY);
        let boundary = self.transitions.get(transition).map(|t| t.x).filter(|_| !beyond);
        let inside = |seat: &(f64, usize, usize, i32)| {
            (low..=high).contains(&seat.0) && boundary.is_none_or(|x| (seat.0 - x).abs() > TINY)
        };
        let start = self.seats.iter().position(inside).unwrap_or(0);
        start..start + self.seats[start..].iter().take_while(|seat| inside(seat)).count()
    }

    /// `sleepers -6 .. -1`, of which transition where there are several.
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
}
