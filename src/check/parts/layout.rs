//! The layout of a track: the places of its sections and transitions.

use super::asked::Asked;
use super::sides::sides;
use super::trackform::{Built, trackform};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::check::places::geometry::{Plan, lay_out};
use crate::check::places::spacing::{prove_spacing, spread, usual_spacing};
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Origin, Side};
use crate::units::number;
use std::rc::Rc;

/// The least distance of sleeper -1 from its boundary, m.
const CLOSE: f64 = 0.01;

/// A track whose seats have their places, before its parts are added.
pub struct Layout {
    pub places: Places,
    /// For each section: its record, its parts, and the origin of its length.
    pub forms: Vec<Rc<Record>>,
    pub built: Vec<Built>,
    pub lengths: Vec<Origin>,
    pub stretches: Vec<Rc<Record>>,
    /// Whether all listed stretches are understood.
    pub sound: bool,
}

/// Places the sections of a track, from a complete record; `None` if places cannot be known.
pub fn layout(
    record: &Record,
    asked: Asked,
    seed: u64,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Layout> {
    let Val::Pairs(pairs) = &record.get("sections")?.value else { return None };
    // the number of sections is not known if one could not be read
    let known = |slot: &Slot| !matches!(slot.value, Val::Error);
    let read = pairs.iter().all(|(key, length)| known(key) && known(length));
    let (stretches, sound) = listed(record);
    let mut forms: Vec<Rc<Record>> = Vec::new();
    let mut plans = Vec::new();
    let lengths: Vec<Origin> = pairs.iter().map(|(_, length)| length.origin).collect();
    for (key, length) in pairs {
        let Val::Record(form) = &key.value else { continue };
        forms.push(form.clone());
        plans.extend(plan(form, length));
    }
    let built: Vec<Built> = forms.iter().map(|form| trackform(form, false, asked, files, findings)).collect();
    let sides = if read { sides(record, pairs.len(), &built, &plans, asked, findings) } else { None };
    if plans.len() < pairs.len() || plans.is_empty() {
        if pairs.is_empty() {
            findings.report(
                Diagnostic::new(Code::E0502, "a track needs at least one section").label(record.span, "no sections"),
            );
        }
        return None;
    }
    let sides = sides?;
    first_seats(record, &mut plans, &sides, findings)?;
    spread(&mut plans, &sides, &forms, &stretches, seed, findings)?;
    let places = lay_out(&plans, &sides, seed, findings)?;
    let sound = prove_spacing(&forms, &stretches, &places, findings).is_some() && sound;
    Some(Layout { places, forms, built, lengths, stretches, sound })
}

/// A section before it is placed.
fn plan(form: &Record, length: &Slot) -> Option<Plan> {
    let Val::Number(n) = length.value else { return None };
    let (name, spacing, span) = (form.name.clone(), *usual_spacing(form)?, length.span);
    Some(Plan { name, spacing, bays: Default::default(), first: Default::default(), length: n, span })
}

/// The stretches that a track lists, and whether all of them are understood.
fn listed(track: &Record) -> (Vec<Rc<Record>>, bool) {
    let Some(Val::List(slots)) = track.get("stretches").map(|slot| &slot.value) else { return (Vec::new(), false) };
    let record = |slot: &Slot| if let Val::Record(r) = &slot.value { Some(r.clone()) } else { None };
    let found: Vec<Rc<Record>> = slots.iter().filter_map(record).collect();
    let sound = found.len() == slots.len();
    (found, sound)
}

/// Places the seats beside a boundary if its transition states them.
fn first_seats(record: &Record, plans: &mut [Plan], sides: &[(String, Side)], findings: &mut Findings) -> Option<()> {
    let Some(Val::Pairs(pairs)) = record.get("transitions").map(|slot| &slot.value) else { return Some(()) };
    let mut sound = true;
    for (boundary, ((_, word), (_, side))) in pairs.iter().zip(sides).enumerate() {
        let Val::Word { arguments, .. } = &word.value else { continue };
        let Some(slot) = arguments.get("seats") else { continue };
        let Val::Range(before, behind) = slot.value else { return None };
        if before.value > -CLOSE || behind.value < 0.0 {
            let text = format!(
                "`seats` must go from a negative place to 0 m or more, found {} m to {} m",
                number(before.value),
                number(behind.value)
            );
            findings.report(
                Diagnostic::new(Code::E0514, text)
                    .label(slot.span, "from sleeper -1, before the boundary, to seat +1, on or behind it")
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
