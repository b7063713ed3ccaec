//! From the objects of a track to the track of the scenario: sections, seats and what each stands on.

use super::Checker;
use super::geometry::{Places, Plan};
use super::value::{Number, Record, Val};
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Foot, Given, Origin, Pad, Rail, RailEnds, Seat, Section, Side, Slab, Support, Track};
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

impl Checker<'_> {
    /// The track, from a complete record.
    pub(super) fn track(&mut self, record: &Record) -> Option<Track> {
        let Val::Pairs(pairs) = &record.get("sections")?.value else { return None };
        let sides = self.sides(record, pairs.len());
        let mut forms: Vec<Rc<Record>> = Vec::new();
        let mut plans = Vec::new();
        let lengths: Vec<Origin> = pairs.iter().map(|(_, length)| length.origin).collect();
        for (key, length) in pairs {
            let Val::Record(form) = &key.value else { continue };
            forms.push(form.clone());
            if let (Some(spacing), Val::Number(n)) = (form.number("spacing"), &length.value) {
                plans.push(Plan { name: form.name.clone(), spacing: spacing.value, length: *n, span: length.span });
            }
        }
        let built: Vec<Option<Built>> = forms.iter().map(|form| self.trackform(form)).collect();
        if plans.len() < pairs.len() || plans.is_empty() {
            if pairs.is_empty() {
                self.report(
                    Diagnostic::new(Code::E0502, "a track needs at least one section").at(record.span, "no sections"),
                );
            }
            return None;
        }
        let places = self.lay_out(&plans, &sides?)?;
        self.seat_places = Some(places.clone());
        let built: Vec<Built> = built.into_iter().collect::<Option<_>>()?;
        Some(assemble(record, &places, &forms, &built, &lengths))
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

    fn trackform(&mut self, form: &Record) -> Option<Built> {
        let rail = self.part(form, "rail", "to carry the wheels").and_then(|r| self.rail(&r));
        let pad = self.part(form, "pad", "between rail and seat").and_then(|r| self.pad(&r));
        let spacing = given(form, "spacing");
        let sleeper = form.record("sleeper").cloned();
        let slab = form.record("slab").cloned();
        let foot = if let Some(slab_record) = &slab {
            if let (Some(_), Some(slab), Some(slot)) = (&sleeper, form.get("slab"), form.get("sleeper")) {
                self.report(
                    Diagnostic::new(Code::E0407, format!("trackform `{}` has a slab and sleepers", form.name))
                        .at(slab.span, "a slab")
                        .at(slot.span, "and sleepers")
                        .help("write `sleeper = none`: the pads stand on the slab"),
                );
            }
            let slab = self.slab(slab_record)?;
            return Some(Built {
                rail: rail?,
                pad: pad?,
                spacing: spacing?,
                slab: Some(slab),
                foot: Foot::Slab,
                sleeper: None,
            });
        } else if form.unknown("slab") {
            None
        } else if form.word("support") == Some("rigid") {
            Some(Foot::Rigid)
        } else {
            let mass = self.part(form, "sleeper", "or a slab, under the pads").and_then(|s| given(&s, "mass"));
            let support = self.part(form, "support", "under the sleepers").and_then(|s| self.support(&s));
            mass.zip(support).map(|(mass, support)| Foot::Sleeper { mass, support })
        };
        Some(Built { rail: rail?, pad: pad?, spacing: spacing?, slab: None, foot: foot?, sleeper })
    }

    /// A part that a trackform cannot do without.
    fn part(&mut self, form: &Record, name: &str, why: &str) -> Option<Rc<Record>> {
        if let Some(record) = form.record(name) {
            return Some(record.clone());
        }
        if !form.unknown(name) {
            let span = form.get(name).map_or(form.span, |slot| slot.span);
            let mistake = Diagnostic::new(Code::E0403, format!("trackform `{}` needs a `{name}` {why}", form.name))
                .at(span, "not given");
            self.lacks(form, name, mistake);
        }
        None
    }

    fn rail(&mut self, record: &Record) -> Option<Rail> {
        let product = |a: &str, b: &str| {
            let (a, b) = (given(record, a)?, given(record, b)?);
            Some(Given::derived(*a * *b))
        };
        let mass = self.agree(
            record,
            "mass",
            &[("mass", given(record, "mass")), ("density * area", product("density", "area"))],
            "kg/m",
        );
        let stiffness = self.agree(
            record,
            "bending stiffness",
            &[
                ("bending_stiffness", given(record, "bending_stiffness")),
                ("youngs_modulus * second_moment", product("youngs_modulus", "second_moment")),
            ],
            "MN m^2",
        );
        Some(Rail { mass: mass?, bending_stiffness: stiffness?, height: record.number("height")?.value })
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

    fn pad(&mut self, record: &Record) -> Option<Pad> {
        let stiffness = given(record, "stiffness")?;
        Some(Pad { stiffness, damping: self.damping(record, stiffness)? })
    }

    fn support(&mut self, record: &Record) -> Option<Support> {
        let stiffness = given(record, "stiffness")?;
        Some(Support { stiffness, damping: self.damping(record, stiffness)? })
    }

    /// `damping`, or `damping_time` times the stiffness.
    fn damping(&mut self, record: &Record, stiffness: Given) -> Option<Given> {
        let by_time = record.number("damping_time").map(|t| {
            let origin = record.get("damping_time").map_or(Origin::Derived, |s| s.origin);
            Given { value: t.value * *stiffness, origin }
        });
        self.agree(
            record,
            "damping",
            &[("damping", given(record, "damping")), ("damping_time * stiffness", by_time)],
            "kN s/m",
        )
    }

    fn slab(&mut self, record: &Record) -> Option<Slab> {
        let stiffness = given(record, "foundation_stiffness")?;
        let time = given(record, "foundation_damping_time")?;
        Some(Slab {
            bending_stiffness: given(record, "bending_stiffness")?,
            mass: given(record, "mass")?,
            foundation_stiffness: stiffness,
            foundation_damping: Given { value: *time * *stiffness, origin: time.origin },
        })
    }
}

/// A trackform as built.
struct Built {
    rail: Rail,
    pad: Pad,
    spacing: Given,
    slab: Option<Slab>,
    foot: Foot,
    sleeper: Option<Rc<Record>>,
}

fn assemble(record: &Record, places: &Places, forms: &[Rc<Record>], built: &[Built], lengths: &[Origin]) -> Track {
    let size = |r: &Rc<Record>| {
        let of = |f: &str| r.number(f).map(|n: Number| n.value);
        Some([of("length")?, of("base_width")?, of("height")?])
    };
    let sections = built
        .iter()
        .zip(forms)
        .zip(places.sections.iter().zip(lengths))
        .map(|((b, form), (&(start, end), length_origin))| Section {
            name: form.name.clone(),
            start,
            end,
            length_origin: *length_origin,
            rail: b.rail.clone(),
            spacing: b.spacing,
            slab: b.slab.clone(),
            sleeper_size: b.sleeper.as_ref().and_then(size),
        })
        .collect();
    let seats = places
        .seats
        .iter()
        .map(|&(x, section, transition, number)| Seat {
            number,
            transition,
            x,
            section,
            pad: built[section].pad.clone(),
            foot: built[section].foot.clone(),
        })
        .collect();
    let rail_ends = match record.word("rail_ends") {
        Some("pinned") => RailEnds::Pinned,
        Some("free") => RailEnds::Free,
        _ => RailEnds::Clamped,
    };
    Track { name: record.name.clone(), sections, transitions: places.transitions.clone(), seats, rail_ends }
}
