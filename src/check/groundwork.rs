//! What stretches do to the ground along the track: layers of their own, and approach slabs in them.

use super::Checker;
use super::geometry::Places;
use super::layers::{TOLERANCE, depth, mm};
use super::stretch::Instance;
use super::track::given;
use super::trackform::Built;
use super::value::{Record, Val};
use crate::diag::{Code, Diagnostic};
use crate::scenario::{ApproachSlab, Groundwork, Layer};
use crate::units::number;
use std::ops::Range;

/// Two chainages closer than this are one place, m.
const TINY: f64 = 1e-6;

impl Checker<'_> {
    /// The approach slab of a stretch that covers some seats; the outer `None` where it is not understood.
    pub(super) fn plate(
        &mut self,
        stretch: &Record,
        transition: usize,
        reach: (f64, f64),
        places: &Places,
    ) -> Option<Option<ApproachSlab>> {
        let slot = stretch.get("approach_slab")?;
        let record = match &slot.value {
            Val::Record(record) => record.clone(),
            Val::Word { .. } => return Some(None),
            _ => return None,
        };
        let hinged = record.word("hinged")? == "yes";
        let boundary = places.transitions.get(transition).map(|t| t.x);
        let ends = match boundary {
            Some(x) if (reach.0 - x).abs() < (reach.1 - x).abs() => [reach.0, reach.1],
            _ => [reach.1, reach.0],
        };
        let between = |seat: &&(f64, usize, usize, i32)| {
            let x = boundary.unwrap_or(f64::INFINITY);
            seat.0 > ends[0].min(x) + TINY && seat.0 < ends[0].max(x) - TINY
        };
        let apart = places.seats.iter().filter(between).count();
        if hinged && (boundary.is_none() || apart > 0) {
            let message = match boundary {
                None => format!("the approach slab of stretch `{}` has no structure to be hinged to", stretch.name),
                Some(x) => format!(
                    "the approach slab of stretch `{}` is hinged to the structure at {} m and ends at {} m",
                    stretch.name,
                    number(x),
                    number((ends[0] * 1e3).round() / 1e3)
                ),
            };
            let over = stretch.get("over").map_or(stretch.span, |over| over.span);
            self.report(
                Diagnostic::new(Code::E0425, message)
                    .at(over, "its span")
                    .at(
                        record
                            .get("hinged")
                            .filter(|s| s.span.file == record.span.file)
                            .map_or(record.span, |s| s.span),
                        "hinged",
                    )
                    .help("let the span end at the transition, as `over = -6 .. 0 m` does, or write `hinged = no`"),
            );
            return None;
        }
        Some(Some(ApproachSlab {
            thickness: given(&record, "thickness")?,
            youngs_modulus: given(&record, "youngs_modulus")?,
            density: given(&record, "density")?,
            depth: given(&record, "depth")?,
            ends: if hinged { [boundary.unwrap_or(ends[0]), ends[1]] } else { ends },
            hinged,
        }))
    }

    /// The ground of a section where stretches change it.
    pub(super) fn groundworks(
        &mut self,
        form: &Record,
        stood: &[Instance],
        places: &Places,
        section: usize,
        before: &[Layer],
    ) -> Option<Vec<Groundwork>> {
        // a stretch over a slab is refused where its seats are changed
        if form.record("slab").is_some() {
            return Some(Vec::new());
        }
        let (start, end) = places.sections[section];
        let whole = places.seats_of(section);
        let here: Vec<&Instance> =
            stood.iter().filter(|instance| instance.regrades() && instance.common(&whole).is_some()).collect();
        let mut cuts: Vec<f64> =
            here.iter().flat_map(|i| [i.reach.0, i.reach.1]).map(|x| x.clamp(start, end)).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|a, b| (*a - *b).abs() < TINY);
        let mut found = Vec::new();
        let mut sound = true;
        for pair in cuts.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let over: Vec<&Instance> =
                here.iter().filter(|i| i.reach.0 < middle && middle < i.reach.1).copied().collect();
            let common = |seats: Option<Range<usize>>, instance: &&Instance| instance.common(&seats?);
            let Some(seats) = over.iter().fold(Some(whole.clone()), common).filter(|_| !over.is_empty()) else {
                continue;
            };
            let extended = self.extended_by(form, &over);
            let complete = self.complete(&extended);
            let built = self.trackform(&complete, true);
            if before.is_empty() && !built.stands_on_layers() {
                continue;
            }
            let Some(layers) = self.lay_strata(&built, places, section, seats.clone(), Some(before)) else {
                sound = false;
                continue;
            };
            let approach_slab = over.iter().find_map(|instance| instance.plate);
            sound &= self.hold_their_grains(&built, &layers);
            sound &= over.iter().all(|instance| self.goes_as_deep(instance, &built, &layers, before, places, &seats));
            sound &= over.iter().all(|instance| self.holds_the_plate(instance, &layers, places, &seats));
            found.push(Groundwork { start: pair[0], end: pair[1], layers, approach_slab });
        }
        Some(found).filter(|_| sound)
    }

    /// Refuses to change the layers of a trackform that has none.
    pub(super) fn has_ground(&mut self, instance: &Instance, form: &Record) -> Option<()> {
        let set = instance.stretch.get(if instance.sets("layers") { "layers" } else { "approach_slab" });
        let Some(slot) = set.filter(|_| instance.regrades()) else { return Some(()) };
        let message = format!(
            "stretch `{}` changes the ground, but trackform `{}` does not say what lies under its sleepers",
            instance.stretch.name, form.name
        );
        self.report(
            Diagnostic::new(Code::E0418, message)
                .at(slot.span, "in the place of what?")
                .at(form.span, "no `layers`")
                .help("give the trackform its `layers`; its `support` may stay beside them and changes as they do"),
        );
        None
    }

    /// The track keeps its level: what a stretch puts under the sleepers is as deep as what was there.
    fn goes_as_deep(
        &mut self,
        instance: &Instance,
        built: &Built,
        layers: &[Layer],
        before: &[Layer],
        places: &Places,
        seats: &Range<usize>,
    ) -> bool {
        if !instance.sets("layers") {
            return true;
        }
        let differs = |x: f64| (depth(layers, x) - depth(before, x)).abs() > TOLERANCE;
        let Some(seat) = seats.clone().find(|seat| differs(places.seats[*seat].0)) else { return true };
        let x = places.seats[seat].0;
        let (own, under) = (depth(layers, x), depth(before, x));
        let message = format!(
            "the layers of stretch `{}` are {} mm deep at {}, those of trackform `{}` {} mm",
            instance.stretch.name,
            mm(own),
            places.named(&(seat..seat + 1)),
            built.name,
            mm(under)
        );
        self.report(
            Diagnostic::new(Code::E0424, message)
                .at(instance.stretch.get("layers").map_or(instance.over(), |slot| slot.span), "of another depth")
                .help("write `rest` for the thickness of one layer: it takes what is left; a track on ground of another depth is a section of its own"),
        );
        false
    }

    /// A plate lies in layers.
    fn holds_the_plate(
        &mut self,
        instance: &Instance,
        layers: &[Layer],
        places: &Places,
        seats: &Range<usize>,
    ) -> bool {
        let (Some(plate), Some(slot)) = (instance.plate, instance.stretch.get("approach_slab")) else { return true };
        let bottom = *plate.depth + *plate.thickness;
        let Some(seat) = seats.clone().find(|seat| bottom > depth(layers, places.seats[*seat].0) + TOLERANCE) else {
            return true;
        };
        let message = format!(
            "the approach slab of stretch `{}` reaches {} mm below the sleepers, the layers at {} {} mm",
            instance.stretch.name,
            mm(bottom),
            places.named(&(seat..seat + 1)),
            mm(depth(layers, places.seats[seat].0))
        );
        let help = if layers.is_empty() {
            "give the trackform `layers` for the slab to lie in"
        } else {
            "lay it higher with a smaller `depth`, or make the lowest layer deeper"
        };
        let at = plate.depth.origin.span().unwrap_or(slot.span);
        self.report(Diagnostic::new(Code::E0426, message).at(at, "depth of its top").help(help));
        false
    }
}

/// Two stretches that put a plate under the same seats.
pub(super) fn two_plates(first: &Instance, later: &Instance, seats: &str) -> Diagnostic {
    Diagnostic::new(Code::E0512, format!("two approach slabs lie in one place at {seats}"))
        .at(later.over(), format!("that of `{}`", later.stretch.name))
        .at(first.over(), format!("that of `{}`", first.stretch.name))
        .help("let one span end where the other begins")
}
