//! Changes of the ground by stretches along the track: other layers, and approach slabs in the layers.

use super::asked::Asked;
use super::layers::{TOLERANCE, depth, hold_their_grains, lay_strata, mm};
use super::stretch::{Instance, extended_by};
use super::trackform::{Built, trackform};
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::Record;
use crate::check::findings::Findings;
use crate::check::places::chainage::{Places, TINY};
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Groundwork, Layer};
use std::ops::Range;

/// The ground of a section that stretches change.
pub fn groundworks(
    form: &Record,
    stood: &[Instance],
    places: &Places,
    section: usize,
    before: &[Layer],
    asked: Asked,
    eval: &mut Evaluator<'_>,
) -> Option<Vec<Groundwork>> {
    // a stretch over a slab is refused when its seats are changed
    if form.record("slab").is_some() {
        return Some(Vec::new());
    }
    let (start, end) = places.sections[section];
    let whole = places.seats_of(section);
    let here: Vec<&Instance> =
        stood.iter().filter(|instance| instance.regrades() && instance.common(&whole).is_some()).collect();
    let mut cuts: Vec<f64> = here.iter().flat_map(|i| [i.reach.0, i.reach.1]).map(|x| x.clamp(start, end)).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() < TINY);
    let mut found = Vec::new();
    let mut sound = true;
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let over: Vec<&Instance> = here.iter().filter(|i| i.reach.0 < middle && middle < i.reach.1).copied().collect();
        let common = |seats: Option<Range<usize>>, instance: &&Instance| instance.common(&seats?);
        let Some(seats) = over.iter().fold(Some(whole.clone()), common).filter(|_| !over.is_empty()) else {
            continue;
        };
        let extended = extended_by(form, &over, eval);
        let complete = eval.complete(&extended);
        let built = trackform(&complete, true, asked, &mut eval.files, &mut eval.findings);
        if before.is_empty() && !built.stands_on_layers() {
            continue;
        }
        let Some(layers) = lay_strata(&built, places, section, seats.clone(), Some(before), &mut eval.findings) else {
            sound = false;
            continue;
        };
        let approach_slab = over.iter().find_map(|instance| instance.plate);
        sound &= hold_their_grains(&built, &layers, &mut eval.findings);
        sound &= over
            .iter()
            .all(|instance| goes_as_deep(instance, &built, &layers, before, places, &seats, &mut eval.findings));
        sound &= over.iter().all(|instance| holds_the_plate(instance, &layers, places, &seats, &mut eval.findings));
        found.push(Groundwork { start: pair[0], end: pair[1], layers, approach_slab });
    }
    Some(found).filter(|_| sound)
}

/// Refuses to change the layers of a trackform that has none.
pub fn has_ground(instance: &Instance, form: &Record, findings: &mut Findings) -> Option<()> {
    let set = instance.stretch.get(if instance.sets("layers") { "layers" } else { "approach_slab" });
    let Some(slot) = set.filter(|_| instance.regrades()) else { return Some(()) };
    let message = format!(
        "stretch `{}` changes the ground, but trackform `{}` gives no layers under its sleepers",
        instance.stretch.name, form.name
    );
    findings.report(
        Diagnostic::new(Code::E0418, message)
            .label(slot.span, "there are no layers to change")
            .label(form.span, "no `layers`")
            .help("give the trackform its `layers`; its `support` may stay and changes with the layers"),
    );
    None
}

/// Checks that the layers of a stretch are as deep as the layers that they replace, because the track keeps its level.
fn goes_as_deep(
    instance: &Instance,
    built: &Built,
    layers: &[Layer],
    before: &[Layer],
    places: &Places,
    seats: &Range<usize>,
    findings: &mut Findings,
) -> bool {
    if !instance.sets("layers") {
        return true;
    }
    let differs = |x: f64| (depth(layers, x) - depth(before, x)).abs() > TOLERANCE;
    let Some(seat) = seats.clone().find(|seat| differs(places.seats[*seat].0)) else { return true };
    let x = places.seats[seat].0;
    let (own, under) = (depth(layers, x), depth(before, x));
    let message = format!(
        "the layers of stretch `{}` are {} mm deep at {}, but the layers of trackform `{}` are {} mm deep",
        instance.stretch.name,
        mm(own),
        places.named(&(seat..seat + 1)),
        built.name,
        mm(under)
    );
    findings.report(
        Diagnostic::new(Code::E0424, message)
            .label(instance.stretch.get("layers").map_or(instance.over(), |slot| slot.span), "different depth")
            .help(
                "write `rest` for the thickness of one layer, which then fills the depth; make a section of its own \
                 for ground of another depth",
            ),
    );
    false
}

/// Checks that an approach slab lies in layers.
fn holds_the_plate(
    instance: &Instance,
    layers: &[Layer],
    places: &Places,
    seats: &Range<usize>,
    findings: &mut Findings,
) -> bool {
    let (Some(plate), Some(slot)) = (instance.plate, instance.stretch.get("approach_slab")) else { return true };
    let bottom = *plate.depth + *plate.thickness;
    let Some(seat) = seats.clone().find(|seat| bottom > depth(layers, places.seats[*seat].0) + TOLERANCE) else {
        return true;
    };
    let message = format!(
        "the approach slab of stretch `{}` reaches {} mm below the sleepers, but the layers at {} reach {} mm",
        instance.stretch.name,
        mm(bottom),
        places.named(&(seat..seat + 1)),
        mm(depth(layers, places.seats[seat].0))
    );
    let help = if layers.is_empty() {
        "give the trackform `layers` around the slab"
    } else {
        "lay it higher with a smaller `depth`, or make the lowest layer deeper"
    };
    let at = plate.depth.origin.span().unwrap_or(slot.span);
    findings.report(Diagnostic::new(Code::E0426, message).label(at, "depth of its top").help(help));
    false
}
