//! Rails: their mass and stiffnesses, and the auxiliary rails beside them.

use super::given::{agree, given};
use super::spring::{damped, spring_at};
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::along::Along;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{AuxiliaryRails, Beam, Given, Pad, Rail};
use crate::units::number;

/// Steel, for a rail without density and modulus: kg/m^3 and N/m^2.
const STEEL_DENSITY: f64 = 7850.0;
const STEEL_MODULUS: f64 = 210e9;

/// A rail, from a complete record.
pub fn rail(record: &Record, findings: &mut Findings) -> Option<Rail> {
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
    // rho I, with I from EI if the rail does not give I
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

/// `Some(None)` if there are none.
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
            Diagnostic::new(Code::E0406, "the pads of auxiliary rails cannot vary along the track")
                .label(span, "a profile"),
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
            .label(rail.span, "not given");
    if let Some(span) = asked {
        mistake = mistake.label(span, "asked for here");
    }
    // 0.4 G A with G = 80.8 GPa and A = m / rho, to whole MN
    let mass = given(rail, "mass").or_else(|| Some(Given::derived(*given(rail, "density")? * *given(rail, "area")?)));
    let area = given(rail, "area").map(|area| *area).or(mass.map(|mass| *mass / STEEL_DENSITY));
    let typical = area.map_or(240.0, |area| (0.4 * 80.8e9 * area / 1e6).round());
    findings.report(mistake.help(format!(
        "add `shear_stiffness = {} MN`, which is 0.4 G A, or the value of the manufacturer",
        number(typical)
    )));
}
