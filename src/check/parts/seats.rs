//! The seats of a section: if a field varies along the track, each seat takes the value at its place.

use super::ground::{Carrying, Under, stacks};
use super::spring::{LaidSpring, lay_spring, pad_at, spring_at};
use super::trackform::{Base, Built, Cushion, UnderSleeper};
use crate::check::evaluate::evaluator::Evaluator;
use crate::check::evaluate::value::Val;
use crate::check::findings::Findings;
use crate::check::places::along::{Laid, lay};
use crate::check::places::chainage::Places;
use crate::check::places::cover::Cover;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Foot, Given, Origin, Seat, Seating, SettlementLaw, Support, Usp};
use crate::schema;
use crate::units::number;
use std::ops::Range;

/// A [`Base`] laid along the track.
enum LaidFoot<'a> {
    Sleeper {
        mass: Given,
        support: LaidSupport<'a>,
        seating: Option<Seating>,
        usp: Option<(&'a Cushion, Laid)>,
        law: Option<&'a SettlementLaw>,
    },
    Fixed(Foot),
}

/// The support of sleepers.
enum LaidSupport<'a> {
    Stated(LaidSpring<'a>),
    /// Computed from the layers of each seat when the scene is planned.
    OfLayers,
}

/// Some seats of a section, each with the values at its place. Varying fields are laid out even if other parts are not
/// understood.
pub fn lay_seats(
    built: &Built,
    places: &Places,
    section: usize,
    range: Range<usize>,
    under: Under<'_>,
    carrying: Carrying,
    findings: &mut Findings,
) -> Option<Vec<Seat>> {
    let (start, end) = places.sections[section];
    let cover = |what: &str| Cover {
        what: format!("the {what} of trackform `{}`", built.name),
        start,
        end,
        seats: Some(range.clone()),
        smooth: false,
    };
    let pad = match &built.pad {
        Some(Some(pad)) => lay_spring(pad, places, "pad", &cover, findings).map(Some),
        Some(None) => Some(None),
        None => None,
    };
    let settlement = built.settlement.as_ref().and_then(|along| lay(along, places, &cover("settlement"), findings));
    let foot = match built.foot.as_ref() {
        Some(Base::Sleeper(bed)) => lay_bed(built, bed, places, range.clone(), &cover, findings),
        Some(Base::Rigid) => Some(LaidFoot::Fixed(Foot::Rigid)),
        Some(Base::Slab) => Some(LaidFoot::Fixed(Foot::Slab)),
        None => None,
    };
    let stacks = stacks(built, places, section, range.clone(), under, carrying, findings);
    let (pad, settlement, foot, stacks) = (pad?, settlement?, foot?, stacks?);
    let mut stacks = stacks.into_iter();
    let mut seats = Vec::with_capacity(range.len());
    for &(x, section, transition, number) in &places.seats[range] {
        let pad = match &pad {
            Some(pad) => Some(pad_at(pad, x, findings)?),
            None => None,
        };
        let foot = match &foot {
            LaidFoot::Sleeper { mass, support, seating, usp, law } => {
                let support = match support {
                    LaidSupport::Stated(spring) => {
                        let (stiffness, damping) = spring_at(spring, x, findings)?;
                        Some(Support { stiffness, damping, seating: *seating })
                    }
                    LaidSupport::OfLayers => None,
                };
                let usp = usp.as_ref().map(|(usp, modulus)| usp.pad_at(modulus, x));
                Foot::Sleeper { mass: *mass, support, usp, law: law.map(|law| Box::new(law.clone())) }
            }
            LaidFoot::Fixed(foot) => foot.clone(),
        };
        let (initial_settlement, sleeper) = (settlement.value_at(x), built.sleeper_body());
        let stack = stacks.next();
        seats.push(Seat { number, transition, x, section, pad, foot, sleeper, initial_settlement, stack });
    }
    Some(seats)
}

fn lay_bed<'a>(
    built: &Built,
    bed: &'a UnderSleeper,
    places: &Places,
    seats: Range<usize>,
    cover: &dyn Fn(&str) -> Cover,
    findings: &mut Findings,
) -> Option<LaidFoot<'a>> {
    let support = match &bed.support {
        _ if bed.by_layers => Some(LaidSupport::OfLayers),
        Some(support) => lay_spring(support, places, "support", cover, findings).map(LaidSupport::Stated),
        None => None,
    };
    let usp = match &bed.usp {
        Some(Some(usp)) => {
            lay(&usp.bedding_modulus, places, &cover("bedding modulus"), findings).map(|laid| Some((usp, laid)))
        }
        Some(None) => Some(None),
        None => None,
    };
    let soft = match (bed.seating, &support) {
        (Some(Some(seating)), Some(LaidSupport::Stated(support))) => {
            let seats = places.seats[seats].iter().map(|seat| seat.0);
            seats_softly(built, seating, support, seats, findings)
        }
        _ => true,
    };
    let law = bed.law.as_ref()?.as_ref();
    let (mass, support, seating, usp) = (bed.mass?, support?, bed.seating?, usp?);
    soft.then_some(LaidFoot::Sleeper { mass, support, seating, usp, law })
}

/// The default of a support's `damping_time`.
pub fn usual_damping_time(eval: &mut Evaluator<'_>) -> Option<Given> {
    let support = schema::kind("support")?;
    let (name, text) = support.alternatives.iter().find_map(|alternative| alternative.default)?;
    match eval.default_value(&support.field(name)?.form, text).value {
        Val::Number(time) => Some(Given { value: time.value, origin: Origin::Default }),
        _ => None,
    }
}

/// Checks that the seating stiffness is not above the stiffness under load.
fn seats_softly(
    built: &Built,
    seating: Seating,
    support: &LaidSpring<'_>,
    mut seats: impl Iterator<Item = f64>,
    findings: &mut Findings,
) -> bool {
    let Some(stiffness) = seats.find_map(|x| Some(support.stiffness.value_at(x)).filter(|k| **k < *seating.stiffness))
    else {
        return true;
    };
    let shown = |given: Given| format!("{} MN/m per seat", number(*given / 1e6));
    let message = format!("the support of trackform `{}` is stiffer during seating than under load", built.name);
    let mut mistake = Diagnostic::new(Code::E0407, message);
    for (given, what) in [(seating.stiffness, "during seating"), (stiffness, "under load")] {
        if let Some(span) = given.origin.span() {
            mistake = mistake.label(span, format!("{} {what}", shown(given)));
        }
    }
    findings.report(mistake.help("ballast becomes stiffer under load: give `seating` the smaller stiffness"));
    false
}

impl Cushion {
    fn pad_at(&self, modulus: &Laid, x: f64) -> Usp {
        let modulus = modulus.value_at(x);
        let stiffness = Given { value: *modulus * self.half_area, origin: modulus.origin };
        let damping = Given { value: *self.time * *stiffness, origin: Origin::Derived };
        Usp { stiffness, damping, thickness: self.thickness }
    }
}
