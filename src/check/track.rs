//! From the objects of a track to the track of the scenario: sections, seats and what each stands on.

use super::Checker;
use super::geometry::{Places, Plan};
use super::ground::Under;
use super::seats::{Along, Cover};
use super::stretch::described;
use super::trackform::Built;
use super::value::{Record, Slot, Val};
use crate::diag::{Code, Diagnostic};
use crate::scenario::{AuxiliaryRailSpan, Curve, Given, Layer, Origin, Piece, Profile, RailEnds, Section, Side, Track};
use crate::units::number;
use std::rc::Rc;

impl Given {
    fn of(record: &Record, field: &str) -> Option<Given> {
        let slot = record.at(field)?;
        match slot.value {
            Val::Number(n) => Some(Given { value: n.of_rail(), origin: slot.origin }),
            _ => None,
        }
    }
}

/// A number of one rail with its origin; `None` where a diagnostic has been given.
pub(super) fn given(record: &Record, field: &str) -> Option<Given> {
    Given::of(record, field)
}

/// The least distance of sleeper -1 from its boundary, m.
const CLOSE: f64 = 0.01;

impl Checker<'_> {
    /// The track, from a complete record.
    pub(super) fn track(&mut self, record: &Record) -> Option<Track> {
        let Val::Pairs(pairs) = &record.get("sections")?.value else { return None };
        // how many there are is not known where one could not be read
        let known = |slot: &Slot| !matches!(slot.value, Val::Error);
        let read = pairs.iter().all(|(key, length)| known(key) && known(length));
        let sides = if read { self.sides(record, pairs.len()) } else { None };
        let (stretches, mut sound) = self.listed(record);
        let mut forms: Vec<Rc<Record>> = Vec::new();
        let mut plans = Vec::new();
        let lengths: Vec<Origin> = pairs.iter().map(|(_, length)| length.origin).collect();
        for (key, length) in pairs {
            let Val::Record(form) = &key.value else { continue };
            forms.push(form.clone());
            if let (Some(spacing), Val::Number(n)) = (self.usual_spacing(form), &length.value) {
                let (name, spacing, span) = (form.name.clone(), *spacing, length.span);
                let (bays, first) = (Default::default(), Default::default());
                plans.push(Plan { name, spacing, bays, first, length: *n, span });
            }
        }
        let built: Vec<Built> = forms.iter().map(|form| self.trackform(form, false)).collect();
        if plans.len() < pairs.len() || plans.is_empty() {
            if pairs.is_empty() {
                self.report(
                    Diagnostic::new(Code::E0502, "a track needs at least one section").at(record.span, "no sections"),
                );
            }
            return None;
        }
        let sides = sides?;
        self.first_seats(record, &mut plans, &sides)?;
        self.spread(&mut plans, &sides, &forms, &stretches)?;
        let places = self.lay_out(&plans, &sides)?;
        self.seat_places = Some(places.clone());
        sound &= self.prove_spacing(&forms, &stretches, &places).is_some();
        let irregularity = self.irregularity(record, &places);
        let bed = self.bed(record, &built);
        let stood = self.stand(&stretches, &places);
        sound &= stood.is_some();
        let stood = stood.unwrap_or_default();
        let mut seats = Vec::with_capacity(places.seats.len());
        let mut sections = Vec::new();
        let mut beside = Vec::new();
        let mut groundworks = Vec::new();
        for (i, built) in built.iter().enumerate() {
            let layers = self.lay_layers(built, &places, i);
            let mut laid = self.seats(built, &places, i, places.seats_of(i), Under::Section(layers.as_deref()));
            let spacing = built.spacing.or_else(|| self.usual_spacing(&forms[i]));
            if let Some(laid) = &mut laid {
                sound &= self.change_seats(&forms[i], &stood, &places, i, layers.as_deref(), laid);
            }
            if let Some(before) = layers.as_deref().filter(|_| laid.is_some()) {
                let found = self.groundworks(&forms[i], &stood, &places, i, before);
                sound &= found.is_some();
                groundworks.extend(found.unwrap_or_default());
            }
            let section = layers.and_then(|layers| section(built, spacing, places.sections[i], lengths[i], layers));
            sound &= laid.is_some() && section.is_some() && built.auxiliary_rails.is_some();
            seats.extend(laid.unwrap_or_default());
            sections.extend(section);
            let (start, end) = places.sections[i];
            let rails = built.auxiliary_rails.clone().flatten();
            beside.extend(rails.map(|rails| AuxiliaryRailSpan { start, end, rails }));
        }
        if !sound {
            return None;
        }
        self.sleepers_apart(&seats, &forms, &places)?;
        let auxiliary_rails = self.auxiliary_spans(&forms, &stood, &places, beside)?;
        let rail_ends = match record.word("rail_ends") {
            Some("pinned") => RailEnds::Pinned,
            Some("free") => RailEnds::Free,
            Some("absorbing") => RailEnds::Absorbing,
            _ => RailEnds::Clamped,
        };
        let irregularity = irregularity?;
        Some(Track {
            name: record.name.clone(),
            sections,
            transitions: places.transitions,
            seats,
            auxiliary_rails,
            stretches: described(&stood),
            groundworks,
            rail_ends,
            irregularity,
            bed: bed?,
        })
    }

    /// Name and side of every boundary.
    fn sides(&mut self, record: &Record, sections: usize) -> Option<Vec<(String, Side)>> {
        let Some(slot) = record.get("transitions") else {
            if sections > 2 && record.partial {
                return None;
            }
            if sections > 2 {
                self.report(
                    Diagnostic::new(
                        Code::E0504,
                        format!("{sections} sections have {} transitions: say which side is which", sections - 1),
                    )
                    .at(record.span, "no `transitions` given")
                    .help("add `transitions = [west: stiff_to_soft, east: soft_to_stiff]`"),
                );
                return None;
            }
            return Some(vec![(String::new(), Side::SoftToStiff); sections.saturating_sub(1)]);
        };
        let Val::Pairs(pairs) = &slot.value else { return None };
        if pairs.len() + 1 != sections {
            self.report(
                Diagnostic::new(
                    Code::E0504,
                    format!(
                        "{sections} sections have {} transitions, found {}",
                        sections.saturating_sub(1),
                        pairs.len()
                    ),
                )
                .at(slot.span, "one for each inner boundary"),
            );
            return None;
        }
        for (i, (name, _)) in pairs.iter().enumerate() {
            let Val::Text(text) = &name.value else { continue };
            let first = pairs[..i].iter().find(|(n, _)| matches!(&n.value, Val::Text(t) if t == text));
            if let Some((first, _)) = first {
                self.report(
                    Diagnostic::new(Code::E0202, format!("two transitions are called `{text}`"))
                        .at(name.span, "again here")
                        .at(first.span, "first here"),
                );
                return None;
            }
        }
        pairs
            .iter()
            .map(|(name, side)| match (&name.value, &side.value) {
                (Val::Text(name), Val::Word { word, .. }) => Some((
                    name.clone(),
                    if word.name == "soft_to_stiff" { Side::SoftToStiff } else { Side::StiffToSoft },
                )),
                _ => None,
            })
            .collect()
    }

    /// Places the seats beside a boundary where its transition states them.
    fn first_seats(&mut self, record: &Record, plans: &mut [Plan], sides: &[(String, Side)]) -> Option<()> {
        let Some(Val::Pairs(pairs)) = record.get("transitions").map(|slot| &slot.value) else { return Some(()) };
        let mut sound = true;
        for (boundary, ((_, word), (_, side))) in pairs.iter().zip(sides).enumerate() {
            let Val::Word { arguments, .. } = &word.value else { continue };
            let Some(slot) = arguments.get("seats") else { continue };
            let Val::Range(before, behind) = slot.value else { return None };
            if before.value > -CLOSE || behind.value < 0.0 {
                let text = format!("`seats` goes from {} m to {} m", number(before.value), number(behind.value));
                self.report(
                    Diagnostic::new(Code::E0514, text)
                        .at(slot.span, "from sleeper -1, before the boundary, to seat +1, on or behind it")
                        .help("write something like `seats = -0.3 .. 0.3 m`"),
                );
                sound = false;
                continue;
            }
            let (soft, stiff) = (Some(-before.value), Some(behind.value));
            let (left, right) = if *side == Side::SoftToStiff { (soft, stiff) } else { (stiff, soft) };
            plans[boundary].first[1] = left;
            plans[boundary + 1].first[0] = right;
        }
        sound.then_some(())
    }

    /// The level of the rail as built; `None` where it is not understood.
    fn irregularity(&mut self, record: &Record, places: &Places) -> Option<Option<Profile>> {
        let (start, end) = (places.sections.first()?.0, places.sections.last()?.1);
        match self.along(record, "irregularity")? {
            Along::Fixed(level) if *level == 0.0 => Some(None),
            Along::Fixed(level) => {
                let curve = Curve::constant(*level);
                Some(Some(Profile { pieces: vec![Piece { start, end, curve }], origin: level.origin }))
            }
            Along::Varies(shape, origin) => {
                let what = format!("the irregularity of track `{}`", record.name);
                let cover = Cover { what, start, end, seats: None, smooth: true };
                self.profile(&shape, origin, places, &cover).map(Some)
            }
        }
    }

    /// The first of several ways to say one thing; those that are given must agree within 2 %.
    pub(super) fn agree(
        &mut self,
        record: &Record,
        what: &str,
        ways: &[(&str, Option<Given>)],
        unit: &str,
    ) -> Option<Given> {
        let known: Vec<(&str, Given)> = ways.iter().filter_map(|(name, g)| Some((*name, (*g)?))).collect();
        let (_, first) = *known.first()?;
        if let Some((name, other)) = known[1..].iter().find(|(_, g)| (**g - *first).abs() > 0.02 * first.abs()) {
            let size = crate::units::parse_unit(unit).map_or(1.0, |u| u.factor);
            let show = |g: Given| format!("{} {unit}", number(*g / size));
            let span = first.origin.span().unwrap_or(record.span);
            self.report(
                Diagnostic::new(
                    Code::E0407,
                    format!("the {what} of {} `{}` is said twice and differs", record.kind.name, record.name),
                )
                .at(span, format!("{}: {}", known[0].0, show(first)))
                .at(record.span, format!("{name}: {}", show(*other)))
                .help("keep one way of the two"),
            );
        }
        Some(first)
    }
}

/// What a section is made of, as far as it does not vary.
fn section(
    built: &Built,
    spacing: Option<Given>,
    (start, end): (f64, f64),
    length_origin: Origin,
    layers: Vec<Layer>,
) -> Option<Section> {
    Some(Section {
        name: built.name.clone(),
        start,
        end,
        length_origin,
        rail: built.rail.clone()?,
        spacing: spacing?,
        slab: built.slab.clone(),
        layers,
    })
}
