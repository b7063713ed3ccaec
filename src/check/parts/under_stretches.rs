//! Changes of seats and of auxiliary rails by stretches.

use super::ground::{Carrying, Regrade, Under};
use super::groundwork::has_ground;
use super::rails::auxiliary_rails;
use super::seats::lay_seats;
use super::stretch::{Instance, extended_by};
use super::trackform::trackform;
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::{Change, Record, Val};
use crate::check::findings::Findings;
use crate::check::places::chainage::{Places, TINY};
use crate::diag::{Code, Diagnostic};
use crate::scenario::{AuxiliaryRailSpan, Layer, Seat};
use std::ops::Range;
use std::rc::Rc;

/// Fields that only sleepers on an elastic support have.
const OF_SLEEPERS: [&str; 6] = ["sleeper", "usp", "law", "support", "settlement", "layers"];

/// A section before stretches change it.
pub struct Unchanged<'a> {
    pub form: &'a Record,
    pub section: usize,
    /// `None` if they are not understood.
    pub layers: Option<&'a [Layer]>,
}

/// Changes the seats of a section by the stretches over them; returns whether all was understood.
///
/// The trackform under a set of stretches is built here, because overlaps are known only after stretches have their
/// places.
pub fn change_seats(
    unchanged: &Unchanged<'_>,
    stood: &[Instance],
    places: &Places,
    laid: &mut [Seat],
    carrying: Carrying,
    eval: &mut Evaluator<'_>,
) -> bool {
    let whole = places.seats_of(unchanged.section);
    let here: Vec<(&Instance, Range<usize>)> =
        stood.iter().filter_map(|instance| Some((instance, instance.common(&whole)?))).collect();
    let mut put = |stretches: &[&Instance], seats: Range<usize>| {
        let changed = changed(unchanged, stretches, places, seats.clone(), carrying, eval);
        if let Some(changed) = &changed {
            laid[seats.start - whole.start..seats.end - whole.start].clone_from_slice(changed);
        }
        changed.is_some()
    };
    // each alone first, so that a mistake in one is reported once
    let wrong: Vec<&Instance> = here
        .iter()
        .filter(|(instance, seats)| !put(&[instance], seats.clone()))
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
            sound &= put(&stretches, start..end);
        }
        start = end;
    }
    sound
}

/// Seats of one section under the same stretches.
fn changed(
    unchanged: &Unchanged<'_>,
    stretches: &[&Instance],
    places: &Places,
    seats: Range<usize>,
    carrying: Carrying,
    eval: &mut Evaluator<'_>,
) -> Option<Vec<Seat>> {
    let Unchanged { form, section, layers } = *unchanged;
    let extended = extended_by(form, stretches, eval);
    for instance in stretches {
        stands_right(instance, form, &extended, &places.named(&seats), &mut eval.findings)?;
    }
    let complete = eval.complete(&extended);
    let built = trackform(&complete, true, carrying.asked, &mut eval.files, &mut eval.findings);
    if !stretches.iter().any(|instance| instance.regrades()) {
        return lay_seats(&built, places, section, seats, Under::Section(layers), carrying, &mut eval.findings);
    }
    let before = layers?;
    let scales = !stretches.iter().any(|instance| instance.sets("support"));
    for instance in stretches.iter().filter(|_| before.is_empty()) {
        has_ground(instance, form, &mut eval.findings)?;
    }
    let plate = stretches.iter().find_map(|instance| instance.plate);
    lay_seats(
        &built,
        places,
        section,
        seats,
        Under::Regraded(&Regrade { before, plate, scales }),
        carrying,
        &mut eval.findings,
    )
}

/// Refuses fields of sleepers if there are no sleepers.
fn stands_right(
    instance: &Instance,
    form: &Record,
    under: &Record,
    seats: &str,
    findings: &mut Findings,
) -> Option<()> {
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
    findings.report(
        Diagnostic::new(Code::E0418, message)
            .label(at, "only sleepers on a support have it")
            .label(instance.over(), "reaches too far")
            .label(ground, what)
            .help(
                "end the span at the last sleeper, as `over = -20 .. -1 sleepers` does; pads can differ on both sides",
            ),
    );
    None
}

/// Auxiliary rails along the track: the rails of sections, cut by stretches that change them, and the rails of
/// stretches.
pub fn auxiliary_spans(
    forms: &[Rc<Record>],
    stood: &[Instance],
    places: &Places,
    of_sections: Vec<AuxiliaryRailSpan>,
    eval: &mut Evaluator<'_>,
) -> Option<Vec<AuxiliaryRailSpan>> {
    let mut spans = of_sections;
    for instance in stood.iter().filter(|instance| instance.sets("auxiliary_rails")) {
        let (start, end) = instance.reach;
        spans = spans.into_iter().flat_map(|span| span.without(start, end)).collect();
        let section = places.seats[instance.seats.start].1;
        let extended = extended_by(&forms[section], &[instance], eval);
        let complete = eval.complete(&extended);
        let Some(rails) = auxiliary_rails(&complete, &mut eval.findings)? else { continue };
        if instance.seats.len() < 2 {
            let message = format!("the auxiliary rails of stretch `{}` lie on one sleeper", instance.stretch.name);
            eval.findings.report(
                Diagnostic::new(Code::E0418, message)
                    .label(instance.over(), "too short")
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
