//! Granular materials and soils, from complete records.

use super::given::{agree, argument, given};
use super::grading::grading;
use super::surface::grain_surfaces;
use crate::check::evaluate::value::{Record, Val};
use crate::check::findings::Findings;
use crate::check::places::along::{Along, along};
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic};
use crate::scenario::{Bond, Contact, Given, Granular, Packing, Shape, Strength};
use crate::solvers::granular::packing::Restored;
use crate::units::number;

/// A material before the layout of its layer along the track.
pub enum Ground {
    /// With its modulus as a continuum, if it is given.
    Granular(Box<Granular>, Option<Along>),
    Soil {
        youngs_modulus: Along,
        poisson_ratio: Given,
        density: Given,
        spread: Given,
        strength: Strength,
    },
}

/// The material of a layer; `None` if a diagnostic has been given.
pub fn ground(record: &Record, files: &mut Files<'_>, findings: &mut Findings) -> Option<Ground> {
    if record.kind.name == "soil" {
        soil(record, findings)
    } else {
        if record.unknown("youngs_modulus") {
            return None;
        }
        let along = along(record, "youngs_modulus");
        granular(record, files, findings).map(|granular| Ground::Granular(Box::new(granular), along))
    }
}

fn granular(record: &Record, files: &mut Files<'_>, findings: &mut Findings) -> Option<Granular> {
    let grading = record.record("grading").cloned().and_then(|g| grading(&g, files, findings));
    let shape = grain_shape(record, files, findings);
    let contact = contact(record, findings);
    let packing = record.record("packing")?;
    let bond = match record.record("bond") {
        Some(bond) => Some(Bond {
            stiffness: given(bond, "stiffness")?,
            tensile_strength: given(bond, "tensile_strength")?,
            shear_strength: given(bond, "shear_strength")?,
        }),
        None if record.unknown("bond") => return None,
        None => None,
    };
    let friction = given(record, "friction")?;
    let wall_friction = match record.get("wall_friction") {
        Some(_) => given(record, "wall_friction")?,
        None => friction,
    };
    let granular = Granular {
        grading: grading?,
        scale: given(record, "scale")?,
        density: given(record, "density")?,
        shape: shape?,
        contact: contact?,
        shear_ratio: given(record, "shear_ratio")?,
        friction,
        wall_friction,
        local_damping: given(record, "local_damping")?,
        viscous_damping: given(record, "viscous_damping")?,
        shear_damping: given(record, "shear_damping")?,
        dashpots_pull: record.word("dashpots")? == "full",
        packing: Packing {
            lifts: packing.number("lifts")?.value as u32,
            pressure: given(packing, "pressure")?,
            friction: given(packing, "friction")?,
            local_damping: given(packing, "local_damping")?,
            viscous_damping: given(packing, "viscous_damping")?,
            restored: match packing.word("restored")? {
                "pressed" => Restored::Pressed,
                "unloaded" => Restored::Unloaded,
                _ => Restored::Eased,
            },
            reloads: packing.number("reloads")?.value as u32,
        },
        bond,
        youngs_modulus: None,
        poisson_ratio: given(record, "poisson_ratio")?,
        spread: given(record, "spread")?,
    };
    Some(granular.coarsened())
}

fn grain_shape(record: &Record, files: &mut Files<'_>, findings: &mut Findings) -> Option<Shape> {
    let Val::Word { word, arguments } = &record.get("shape")?.value else { return None };
    if word.name == "spheres" {
        return Some(Shape::Spheres);
    }
    let slot = arguments.get("pebbles")?;
    let pebbles = match slot.value {
        Val::Number(n) => [n.value; 2],
        Val::Range(from, to) => [from.value, to.value],
        _ => return None,
    };
    if let Some(part) = pebbles.iter().find(|n| n.fract() != 0.0) {
        findings.report(
            Diagnostic::new(Code::E0405, format!("a clump has a whole number of pebbles, found {}", number(*part)))
                .label(slot.span, "not whole"),
        );
        return None;
    }
    let surfaces = grain_surfaces(word, arguments, files, findings)?;
    Some(Shape::Clumps {
        pebbles: pebbles.map(|n| n as u32),
        ratio: argument(arguments, "ratio")?,
        distance: argument(arguments, "distance")?,
        surfaces,
    })
}

fn contact(record: &Record, findings: &mut Findings) -> Option<Contact> {
    let Val::Word { word, arguments } = &record.get("contact")?.value else { return None };
    if word.name == "hertz" {
        return Some(Contact::Hertz {
            youngs_modulus: argument(arguments, "youngs_modulus")?,
            poisson_ratio: argument(arguments, "poisson_ratio")?,
        });
    }
    if record.get("contact_stiffness").is_none() {
        let message = format!("granular `{}` needs its `contact_stiffness` for `contact = linear`", record.name);
        let mistake = Diagnostic::new(Code::E0403, message)
            .label(record.span, "not given")
            .help("add `contact_stiffness = 13 MN/m per contact`, or write `contact = hertz(...)`");
        record.lacks("contact_stiffness", mistake, findings);
    }
    given(record, "contact_stiffness").map(|stiffness| Contact::Linear { stiffness })
}

fn soil(record: &Record, findings: &mut Findings) -> Option<Ground> {
    let strength = strength(record, findings);
    let from_moduli = moduli(record, findings)?;
    let (of_young, of_poisson) = from_moduli.unzip();
    let along = along(record, "youngs_modulus");
    let fixed = if let Some(Along::Fixed(given)) = along { Some(given) } else { None };
    let youngs_modulus = match along {
        Some(Along::Varies(shape, origin)) => Along::Varies(shape, origin),
        _ => {
            let ways = [("youngs_modulus", fixed), ("9 K G / (3 K + G)", of_young)];
            Along::Fixed(agree(record, "Young's modulus", &ways, "MPa", findings)?)
        }
    };
    // contradicting moduli contradict in both values, but are reported once
    let differ = fixed.zip(of_young).is_some_and(|(own, other)| (*own - *other).abs() > 0.02 * *own);
    let own = given(record, "poisson_ratio");
    let ways = [("poisson_ratio", own), ("(3 K - 2 G) / (6 K + 2 G)", of_poisson.filter(|_| !differ))];
    let poisson_ratio = agree(record, "Poisson's ratio", &ways, "", findings)?;
    let (density, spread) = (given(record, "density")?, given(record, "spread")?);
    Some(Ground::Soil { youngs_modulus, poisson_ratio, density, spread, strength: strength? })
}

/// Young's modulus 9 K G / (3 K + G) and Poisson's ratio (3 K - 2 G) / (6 K + 2 G) of bulk modulus K and shear modulus
/// G; `Some(None)` if these are not given.
fn moduli(record: &Record, findings: &mut Findings) -> Option<Option<(Given, Given)>> {
    let (Some(bulk), Some(shear)) = (given(record, "bulk_modulus"), given(record, "shear_modulus")) else {
        return Some(None);
    };
    let (k, g) = (*bulk, *shear);
    let poisson = (3.0 * k - 2.0 * g) / (6.0 * k + 2.0 * g);
    if !(0.0..=0.49).contains(&poisson) {
        let span = |field: &str| record.get(field).map_or(record.span, |slot| slot.span);
        let message = format!(
            "the moduli of soil `{}` give a Poisson's ratio of {}, which is outside 0 .. 0.49",
            record.name,
            number((poisson * 1e3).round() / 1e3)
        );
        findings.report(
            Diagnostic::new(Code::E0407, message)
                .label(span("bulk_modulus"), format!("K = {} MPa", number(k / 1e6)))
                .label(span("shear_modulus"), format!("G = {} MPa", number(g / 1e6)))
                .help("K lies between 2/3 G and 50 G; or give `youngs_modulus` and `poisson_ratio` instead"),
        );
        return None;
    }
    let origin = bulk.origin;
    let young = 9.0 * k * g / (3.0 * k + g);
    Some(Some((Given { value: young, origin }, Given { value: poisson, origin })))
}

fn strength(record: &Record, findings: &mut Findings) -> Option<Strength> {
    let Val::Word { word, arguments } = &record.get("strength")?.value else { return None };
    if word.name == "elastic" {
        return Some(Strength::Elastic);
    }
    let (friction_angle, dilation) = (argument(arguments, "friction_angle")?, argument(arguments, "dilation")?);
    if *dilation > *friction_angle {
        let span = |name: &str| arguments.get(name).map_or(record.span, |slot| slot.span);
        let shown = |angle: Given| number((angle.to_degrees() * 1e6).round() / 1e6);
        findings.report(
            Diagnostic::new(Code::E0407, format!("the dilation of soil `{}` exceeds its friction angle", record.name))
                .label(span("dilation"), format!("dilation of {} deg", shown(dilation)))
                .label(span("friction_angle"), format!("friction angle of {} deg", shown(friction_angle)))
                .help("such a soil would gain energy; dilation is usually a third of the friction angle or less"),
        );
        return None;
    }
    Some(Strength::MohrCoulomb {
        cohesion: argument(arguments, "cohesion")?,
        friction_angle,
        dilation,
        tension: argument(arguments, "tension")?,
    })
}
