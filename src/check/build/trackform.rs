//! What a trackform is made of: its parts as far as they are understood, each checked against the others.

use super::asked::Asked;
use super::given::given;
use crate::check::build::asked::stands_on_layers;
use crate::check::build::given::agree;
use crate::check::build::springs::spring_at;
use crate::check::build::strata::Stratum;
use crate::check::build::strata::strata;
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::along::Along;
use crate::check::places::along::along;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{AuxiliaryRails, Beam, Given, Pad, Rail, Seating, Slab, SleeperBody};
use crate::units::number;
use std::rc::Rc;

/// Steel, where a rail says neither its density nor its modulus: kg/m^3 and N/m^2.
const STEEL_DENSITY: f64 = 7850.0;
const STEEL_MODULUS: f64 = 210e9;

/// A trackform as far as it is understood; the outer `None` of a part is one that is not.
pub struct Built {
    pub name: String,
    /// None at all in a rig that leaves it out.
    pub rail: Option<Option<Rail>>,
    pub spacing: Option<Given>,
    pub slab: Option<Slab>,
    pub sleeper: Option<Rc<Record>>,
    pub auxiliary_rails: Option<Option<AuxiliaryRails>>,
    /// As `rail`.
    pub pad: Option<Option<Damped>>,
    pub foot: Option<Base>,
    pub settlement: Option<Along>,
    pub layers: Option<Vec<Stratum>>,
    /// Where its layers stand, or the trackform itself.
    pub layers_span: Span,
}

/// What the pads stand on.
pub enum Base {
    Sleeper(Box<Bed>),
    Rigid,
    Slab,
}

/// A sleeper and what lies under it.
pub struct Bed {
    pub mass: Option<Given>,
    pub support: Option<Damped>,
    /// Whether the layers carry it, and nothing that is stated.
    pub by_layers: bool,
    pub seating: Option<Option<Seating>>,
    pub usp: Option<Option<Cushion>>,
}

/// A spring with its damper, which may be stated as a time.
pub struct Damped {
    pub record: Rc<Record>,
    pub stiffness: Along,
    pub damping: Option<Along>,
    pub time: Option<Given>,
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
    pub fn stands_on_layers(&self) -> bool {
        matches!(&self.foot, Some(Base::Sleeper(bed)) if bed.by_layers)
    }

    /// Size of its sleepers, as far as it is known.
    pub fn sleeper_body(&self) -> Option<SleeperBody> {
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

/// The parts of a trackform, or of one that a stretch extends.
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
    let settlement = along(form, "settlement");
    let sleeper = form.record("sleeper").cloned();
    let (foot, slab) = under_the_pads(form, sleeper.as_ref(), asked, findings);
    let sleeper = sleeper.filter(|_| slab.is_none());
    let layers = strata(form, of_stretch, files, findings);
    let layers_span = form.get("layers").map_or(form.span, |slot| slot.span);
    let name = form.name.clone();
    Built { name, rail, spacing, slab, sleeper, auxiliary_rails, pad, foot, settlement, layers, layers_span }
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
                    .at(slab.span, "a slab")
                    .at(slot.span, "and sleepers")
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
    let sleeper = part(form, "sleeper", "or a slab, under the pads", findings);
    let mass = sleeper.as_ref().and_then(|s| given(s, "mass"));
    let usp = match form.record("usp").cloned() {
        Some(record) => sleeper.as_ref().and_then(|s| cushion(&record, s)).map(Some),
        None => (!form.unknown("usp")).then_some(None),
    };
    if let Some(sleeper) = &sleeper {
        bears(sleeper, findings);
    }
    let by_layers = stands_on_layers(form);
    let record = if by_layers { None } else { part(form, "support", "or layers, under the sleepers", findings) };
    let seating = if by_layers { Some(None) } else { record.as_ref().and_then(|r| seating(r)) };
    let support = record.and_then(|s| damped(&s));
    (Some(Base::Sleeper(Box::new(Bed { mass, support, by_layers, seating, usp }))), None)
}

/// Refuses what only a sleeper on a support can have.
fn without_support(form: &Record, field: &str, stands: &str, findings: &mut Findings) {
    let Some(base) = form.get(field).map(|slot| slot.span) else { return };
    let has = |slot: &Slot| match &slot.value {
        Val::Number(n) => n.value != 0.0,
        value => matches!(value, Val::Profile(_) | Val::Record(_)),
    };
    let layered = |slot: &Slot| field == "slab" && matches!(&slot.value, Val::Pairs(pairs) if !pairs.is_empty());
    let has = |slot: &Slot| has(slot) || layered(slot);
    for (name, nothing) in [("usp", "none"), ("settlement", "0 mm"), ("layers", "[]")] {
        if let Some(slot) = form.get(name).filter(|slot| has(slot)) {
            let message =
                format!("trackform `{}` {stands} and has a `{name}`, which only sleepers on a support have", form.name);
            findings.report(
                Diagnostic::new(Code::E0407, message)
                    .at(slot.span, format!("`{name}`"))
                    .at(base, "instead of a support that gives")
                    .help(format!("write `{name} = {nothing}`")),
            );
        }
    }
}

/// A part above the sleepers, which a rig for sleepers does without: `Some(None)`.
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

/// A part that a trackform cannot do without.
fn part(form: &Record, name: &str, why: &str, findings: &mut Findings) -> Option<Rc<Record>> {
    if let Some(record) = form.record(name) {
        return Some(record.clone());
    }
    if !form.unknown(name) {
        let span = form.get(name).map_or(form.span, |slot| slot.span);
        let mistake = Diagnostic::new(Code::E0403, format!("trackform `{}` needs a `{name}` {why}", form.name))
            .at(span, "not given");
        form.lacks(name, mistake, findings);
    }
    None
}

fn rail(record: &Record, findings: &mut Findings) -> Option<Rail> {
    let product = |a: &str, b: &str| {
        let (a, b) = (given(record, a)?, given(record, b)?);
        Some(Given::derived(*a * *b))
    };
    let mass = agree(
        record,
        "mass",
        &[("mass", given(record, "mass")), ("density * area", product("density", "area"))],
        "kg/m",
        findings,
    );
    let stiffness = agree(
        record,
        "bending stiffness",
        &[
            ("bending_stiffness", given(record, "bending_stiffness")),
            ("youngs_modulus * second_moment", product("youngs_modulus", "second_moment")),
        ],
        "MN m^2",
        findings,
    );
    let (mass, bending_stiffness) = (mass?, stiffness?);
    // rho I, with I from EI where the rail does not say it
    let rotary_inertia = product("density", "second_moment")
        .map_or(*bending_stiffness * STEEL_DENSITY / STEEL_MODULUS, |inertia| *inertia);
    Some(Rail {
        mass,
        bending_stiffness,
        shear_stiffness: given(record, "shear_stiffness"),
        rotary_inertia,
        height: record.number("height")?.value,
    })
}

/// `Some(None)` where there are none.
pub fn auxiliary_rails(form: &Record, findings: &mut Findings) -> Option<Option<AuxiliaryRails>> {
    let Some(record) = form.record("auxiliary_rails").cloned() else {
        return (!form.unknown("auxiliary_rails")).then_some(None);
    };
    let rail = record.record("rail").cloned().and_then(|r| rail(&r, findings));
    let pad = record.record("pad").cloned().and_then(|r| damped(&r));
    let count = record.number("count")?;
    let origin = record.get("count")?.origin;
    let (rail, pad) = (rail?, pad?);
    let half = count.value / 2.0;
    let times = |given: Given| Given { value: half * *given, ..given };
    let varies = [Some(&pad.stiffness), pad.damping.as_ref()].into_iter().flatten().find_map(|a| match a {
        Along::Varies(shape, _) => Some(shape.span),
        Along::Fixed(_) => None,
    });
    if let Some(span) = varies {
        findings.report(
            Diagnostic::new(Code::E0406, "the pads of auxiliary rails are the same all along them")
                .at(span, "a profile"),
        );
        return None;
    }
    let pad = spring_at(&pad.laid_anywhere()?, 0.0, findings)?;
    Some(Some(AuxiliaryRails {
        count: Given { value: count.value as u32, origin },
        rail: Rail {
            mass: times(rail.mass),
            bending_stiffness: times(rail.bending_stiffness),
            shear_stiffness: rail.shear_stiffness.map(times),
            rotary_inertia: half * rail.rotary_inertia,
            height: rail.height,
        },
        pad: Pad { stiffness: times(pad.0), damping: times(pad.1) },
    }))
}

fn damped(record: &Rc<Record>) -> Option<Damped> {
    let stiffness = along(record, "stiffness")?;
    let (damping, time) = (along(record, "damping"), given(record, "damping_time"));
    if damping.is_none() && time.is_none() {
        return None;
    }
    Some(Damped { record: record.clone(), stiffness, damping, time })
}

/// `Some(None)` where there is none.
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

/// A sleeper cannot bear on more than its base.
fn bears(sleeper: &Record, findings: &mut Findings) {
    let of = |field: &str| sleeper.number(field).map(|n| n.value);
    let (Some(area), Some(length), Some(width)) = (of("base_area"), of("length"), of("base_width")) else { return };
    if area > 1.02 * length * width {
        let span = sleeper.get("base_area").map_or(sleeper.span, |s| s.span);
        findings.report(
            Diagnostic::new(
                Code::E0407,
                format!(
                    "the base of sleeper `{}` bears on {} m^2, but it is {} m x {} m, {} m^2",
                    sleeper.name,
                    number(area),
                    number(length),
                    number(width),
                    number(length * width)
                ),
            )
            .at(span, "larger than the base")
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

/// Timoshenko's beam needs the shear stiffness of every rail.
pub fn shear_stiffnesses(track: &Record, beam: Given<Beam>, findings: &mut Findings) {
    let Val::Pairs(pairs) = &track.get("sections").map_or(&Val::Error, |s| &s.value) else { return };
    if *beam != Beam::Timoshenko {
        return;
    }
    for (form, _) in pairs {
        let Val::Record(form) = &form.value else { continue };
        for rail in ["rail", "auxiliary_rails.rail"].iter().filter_map(|path| form.record(path)) {
            if rail.get("shear_stiffness").is_none() && !rail.partial {
                without_shear(rail, beam.origin.span(), findings);
            }
        }
    }
}

fn without_shear(rail: &Record, asked: Option<Span>, findings: &mut Findings) {
    let name = if rail.name == "rail" { "the rail".into() } else { format!("rail `{}`", rail.name) };
    let mut mistake =
        Diagnostic::new(Code::E0403, format!("{name} needs its `shear_stiffness` for `beam = timoshenko`"))
            .at(rail.span, "not given");
    if let Some(span) = asked {
        mistake = mistake.at(span, "asked for here");
    }
    // 0.4 G A with G = 80.8 GPa and A = m / rho, to whole MN
    let mass = given(rail, "mass").or_else(|| Some(Given::derived(*given(rail, "density")? * *given(rail, "area")?)));
    let area = given(rail, "area").map(|area| *area).or(mass.map(|mass| *mass / STEEL_DENSITY));
    let typical = area.map_or(240.0, |area| (0.4 * 80.8e9 * area / 1e6).round());
    findings.report(
        mistake.help(format!(
            "add `shear_stiffness = {} MN`, which is 0.4 G A, or say what its maker says",
            number(typical)
        )),
    );
}
