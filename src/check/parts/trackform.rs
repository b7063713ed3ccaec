//! The parts of a trackform, as far as they are understood, each checked against the others.

use super::asked::{Asked, stands_on_layers};
use super::crib::crib;
use super::given::given;
use super::law::settlement_law;
use super::rails::{auxiliary_rails, rail};
use super::spring::{Damped, damped};
use super::strata::{Stratum, strata};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::along::{Along, along};
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{AuxiliaryRails, Crib, Given, Rail, Seating, SettlementLaw, Slab, SleeperBody};
use crate::units::number;
use std::rc::Rc;

/// A trackform as far as it is understood; the outer `None` of a part means that the part is not understood.
pub struct Built {
    pub name: String,
    /// `Some(None)` if a rig leaves it out.
    pub rail: Option<Option<Rail>>,
    pub spacing: Option<Given>,
    pub slab: Option<Slab>,
    pub sleeper: Option<Rc<Record>>,
    pub auxiliary_rails: Option<Option<AuxiliaryRails>>,
    /// `Some(None)` if a rig leaves it out.
    pub pad: Option<Option<Damped>>,
    pub foot: Option<Base>,
    pub settlement: Option<Along>,
    pub layers: Option<Vec<Stratum>>,
    /// The place of its layers in the text, or of the trackform.
    pub layers_span: Span,
    pub crib: Option<Crib>,
}

/// The part under the pads.
pub enum Base {
    Sleeper(Box<UnderSleeper>),
    Rigid,
    Slab,
}

/// A sleeper and the parts under it.
pub struct UnderSleeper {
    pub mass: Option<Given>,
    pub support: Option<Damped>,
    /// Whether the layers carry it, without a stated support.
    pub by_layers: bool,
    pub seating: Option<Option<Seating>>,
    pub usp: Option<Option<Cushion>>,
    pub law: Option<Option<SettlementLaw>>,
}

/// An under sleeper pad under half a sleeper of that base area, m^2.
pub struct Cushion {
    pub bedding_modulus: Along,
    pub half_area: f64,
    pub time: Given,
    pub thickness: f64,
}

impl Built {
    /// Whether its layers carry the sleepers.
    pub(super) fn stands_on_layers(&self) -> bool {
        matches!(&self.foot, Some(Base::Sleeper(bed)) if bed.by_layers)
    }

    /// Size of its sleepers, as far as it is known.
    pub(super) fn sleeper_body(&self) -> Option<SleeperBody> {
        let sleeper = self.sleeper.as_ref()?;
        let of = |field: &str| sleeper.number(field).map(|n| n.value);
        Some(SleeperBody {
            length: of("length")?,
            base_width: of("base_width")?,
            height: of("height")?,
            base_area: base_area(sleeper)?,
            seat_distance: of("seat_distance")?,
        })
    }
}

/// Bearing area of a sleeper, m^2.
fn base_area(sleeper: &Record) -> Option<f64> {
    let of = |field: &str| sleeper.number(field).map(|n| n.value);
    of("base_area").or_else(|| Some(of("length")? * of("base_width")?))
}

/// The parts of a trackform, or of a trackform that a stretch extends.
pub fn trackform(
    form: &Record,
    of_stretch: bool,
    asked: Asked,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Built {
    let rail = upper(form, "rail", "to carry the wheels", |record, findings| rail(record, findings), asked, findings);
    let pad = upper(form, "pad", "between rail and seat", |record, _| damped(record), asked, findings);
    let spacing = given(form, "spacing");
    let auxiliary_rails = auxiliary_rails(form, findings);
    let sleeper = form.record("sleeper").cloned();
    let (foot, slab) = under_the_pads(form, sleeper.as_ref(), asked, findings);
    // a settlement without ballast has been refused: it is not checked against the section again
    let settlement = match &foot {
        Some(Base::Slab | Base::Rigid) => Some(Along::Fixed(Given::derived(0.0))),
        _ => along(form, "settlement"),
    };
    let sleeper = sleeper.filter(|_| slab.is_none());
    let layers = strata(form, of_stretch, files, findings);
    let layers_span = form.get("layers").map_or(form.span, |slot| slot.span);
    let crib = crib(form, layers.as_deref(), findings);
    let name = form.name.clone();
    Built { name, rail, spacing, slab, sleeper, auxiliary_rails, pad, foot, settlement, layers, layers_span, crib }
}

fn under_the_pads(
    form: &Record,
    sleeper: Option<&Rc<Record>>,
    asked: Asked,
    findings: &mut Findings,
) -> (Option<Base>, Option<Slab>) {
    if let Some(slab_record) = form.record("slab").cloned() {
        if let (Some(_), Some(slab), Some(slot)) = (sleeper, form.get("slab"), form.get("sleeper")) {
            findings.report(
                Diagnostic::new(Code::E0407, format!("trackform `{}` has a slab and sleepers", form.name))
                    .label(slab.span, "a slab")
                    .label(slot.span, "and sleepers")
                    .help("write `sleeper = none`: the pads stand on the slab"),
            );
        }
        without_support(form, "slab", "stands on a slab", findings);
        let slab = slab(&slab_record);
        return (slab.is_some().then_some(Base::Slab), slab);
    }
    if form.unknown("slab") {
        return (None, None);
    }
    if form.word("support") == Some("rigid") {
        without_support(form, "support", "has a rigid support", findings);
        return (Some(Base::Rigid), None);
    }
    if asked.plate && form.get("sleeper").is_none() && !form.unknown("sleeper") {
        return (Some(Base::Rigid), None);
    }
    let by_layers = stands_on_layers(form);
    let lacks = |field: &str| form.record(field).is_none() && !form.unknown(field);
    if !by_layers && lacks("sleeper") && lacks("support") {
        part(form, "sleeper", "on a `support` or on layers, or a `slab`, under the pads", findings);
        return (None, None);
    }
    let sleeper = part(form, "sleeper", "or a slab, under the pads", findings);
    let mass = sleeper.as_ref().and_then(|s| given(s, "mass"));
    let usp = match form.record("usp").cloned() {
        Some(record) => sleeper.as_ref().and_then(|s| cushion(&record, s)).map(Some),
        None => (!form.unknown("usp")).then_some(None),
    };
    let law = match form.get("law").filter(|slot| matches!(slot.value, Val::Record(_))) {
        Some(slot) => settlement_law(slot, findings).map(Some),
        None => (!form.unknown("law")).then_some(None),
    };
    if let Some(sleeper) = &sleeper {
        bears(sleeper, findings);
    }
    let record = if by_layers { None } else { part(form, "support", "or layers, under the sleepers", findings) };
    let seating = if by_layers { Some(None) } else { record.as_ref().and_then(|r| seating(r)) };
    let support = record.and_then(|s| damped(&s));
    (Some(Base::Sleeper(Box::new(UnderSleeper { mass, support, by_layers, seating, usp, law }))), None)
}

/// Refuses fields that only a sleeper on a support can have.
fn without_support(form: &Record, field: &str, stands: &str, findings: &mut Findings) {
    let Some(base) = form.get(field).map(|slot| slot.span) else { return };
    let has = |slot: &Slot| match &slot.value {
        Val::Number(n) => n.value != 0.0,
        value => matches!(value, Val::Profile(_) | Val::Record(_)),
    };
    let layered = |slot: &Slot| field == "slab" && matches!(&slot.value, Val::Pairs(pairs) if !pairs.is_empty());
    let has = |slot: &Slot| has(slot) || layered(slot);
    let fields = [
        ("usp", "none"),
        ("law", "none"),
        ("settlement", "0 mm"),
        ("layers", "[]"),
        ("crib", "none"),
        ("shoulder", "none"),
    ];
    for (name, nothing) in fields {
        if let Some(slot) = form.get(name).filter(|slot| has(slot)) {
            let message =
                format!("trackform `{}` {stands} and has a `{name}`, which only sleepers on a support have", form.name);
            findings.report(
                Diagnostic::new(Code::E0407, message)
                    .label(slot.span, format!("`{name}`"))
                    .label(base, "instead of an elastic support")
                    .help(format!("write `{name} = {nothing}` in trackform `{}`", form.name)),
            );
        }
    }
}

/// A part above the sleepers, which a rig for sleepers does not need: `Some(None)`.
fn upper<T>(
    form: &Record,
    name: &str,
    why: &str,
    read: fn(&Rc<Record>, &mut Findings) -> Option<T>,
    asked: Asked,
    findings: &mut Findings,
) -> Option<Option<T>> {
    if asked.rig && form.record(name).is_none() {
        return (!form.unknown(name)).then_some(None);
    }
    let record = part(form, name, why, findings)?;
    read(&record, findings).map(Some)
}

/// A part that a trackform needs.
fn part(form: &Record, name: &str, why: &str, findings: &mut Findings) -> Option<Rc<Record>> {
    if let Some(record) = form.record(name) {
        return Some(record.clone());
    }
    if !form.unknown(name) {
        let span = form.get(name).map_or(form.span, |slot| slot.span);
        let mistake = Diagnostic::new(Code::E0403, format!("trackform `{}` needs a `{name}` {why}", form.name))
            .label(span, "not given");
        form.lacks(name, mistake, findings);
    }
    None
}

/// `Some(None)` if there is none.
fn seating(support: &Record) -> Option<Option<Seating>> {
    match support.record("seating") {
        Some(record) => {
            Some(Some(Seating { stiffness: given(record, "stiffness")?, closure: given(record, "closure")? }))
        }
        None => (!support.unknown("seating")).then_some(None),
    }
}

fn cushion(record: &Record, sleeper: &Record) -> Option<Cushion> {
    Some(Cushion {
        bedding_modulus: along(record, "bedding_modulus")?,
        half_area: base_area(sleeper)? / 2.0,
        time: given(record, "damping_time")?,
        thickness: record.number("thickness")?.value,
    })
}

/// Checks that the bearing area of a sleeper is not larger than its base.
fn bears(sleeper: &Record, findings: &mut Findings) {
    let of = |field: &str| sleeper.number(field).map(|n| n.value);
    let (Some(area), Some(length), Some(width)) = (of("base_area"), of("length"), of("base_width")) else { return };
    if area > 1.02 * length * width {
        let span = sleeper.get("base_area").map_or(sleeper.span, |s| s.span);
        findings.report(
            Diagnostic::new(
                Code::E0407,
                format!(
                    "the `base_area` of sleeper `{}` is {} m^2, but its base is only {} m x {} m = {} m^2",
                    sleeper.name,
                    number(area),
                    number(length),
                    number(width),
                    number(length * width)
                ),
            )
            .label(span, "larger than the base")
            .help("give the whole sleeper's `length` and `base_width` too"),
        );
    }
}

fn slab(record: &Record) -> Option<Slab> {
    let stiffness = given(record, "foundation_stiffness")?;
    let time = given(record, "foundation_damping_time")?;
    Some(Slab {
        bending_stiffness: given(record, "bending_stiffness")?,
        mass: given(record, "mass")?,
        foundation_stiffness: stiffness,
        foundation_damping: Given { value: *time * *stiffness, origin: time.origin },
    })
}
