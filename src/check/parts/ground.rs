//! The support of each seat from the layers under it, and what stretches make of these.

use super::asked::Asked;
use super::layers::lay_strata;
use super::strata::Stratum;
use super::support::{Carried, Stack, Supports, bearing};
use super::trackform::Built;
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Layer, Material};
use crate::solvers::foundation::{self, FoundationError};
use std::ops::Range;

/// The ground of some seats.
#[derive(Clone, Copy)]
pub enum Under<'a> {
    /// The layers of their section; `None` where they are not understood.
    Section(Option<&'a [Layer]>),
    Regraded(&'a Regrade<'a>),
}

/// What a stretch changes of the layers under some seats.
pub struct Regrade<'a> {
    /// The layers of the section.
    pub before: &'a [Layer],
    pub plate: Option<ApproachSlab>,
    /// Whether the stretch changes what carries and leaves the stated `support` as it is: the support changes as the layers do.
    pub scales: bool,
}

/// Layers at a chainage as continua; `None` where a modulus is not known.
fn stack(layers: &[Layer], x: f64) -> Option<Vec<foundation::Layer>> {
    let continuum = |layer: &Layer| {
        let (poisson_ratio, density, spread) = match &layer.material {
            Material::Granular(granular) => (granular.poisson_ratio, granular.density, granular.spread),
            Material::Soil(soil) => (soil.poisson_ratio, soil.density, soil.spread),
        };
        Some(foundation::Layer {
            thickness: layer.thickness.at(x).max(0.0),
            youngs_modulus: layer.youngs_modulus()?.at(x),
            poisson_ratio: *poisson_ratio,
            density: *density,
            spread: *spread,
        })
    };
    layers.iter().map(continuum).collect()
}

/// Nearer to its hinge than this share of its length a plate is as stiff as there: the ground must keep a modulus.
const AT_HINGE: f64 = 0.05;

/// How far a load is from the hinge of a plate, as share of its length: by the lever, what of the load the ground bears.
fn lever(plate: &ApproachSlab, x: f64) -> f64 {
    let [structure, far] = plate.ends;
    if plate.hinged { ((x - structure) / (far - structure)).abs().clamp(AT_HINGE, 1.0) } else { 1.0 }
}

/// What the layers are to some seats of a section; empty where there are none, or where a modulus is not known and nothing
/// depends on it.
pub fn carried(
    built: &Built,
    places: &Places,
    section: usize,
    seats: Range<usize>,
    under: Under<'_>,
    supports: &mut Supports,
    findings: &mut Findings,
) -> Option<Vec<Carried>> {
    let strata = built.layers.as_ref()?;
    let regrade = if let Under::Regraded(regrade) = under { Some(regrade) } else { None };
    let depends = built.stands_on_layers() || regrade.is_some_and(|regrade| regrade.scales);
    let (Some(body), false) = (built.sleeper_body(), strata.is_empty()) else { return Some(Vec::new()) };
    if !knows_moduli(built, strata, regrade, depends, supports.asked, findings)? {
        return Some(Vec::new());
    }
    let layers = match under {
        Under::Section(None) if !depends => return Some(Vec::new()),
        Under::Section(layers) => Some(layers?.to_vec()),
        Under::Regraded(regrade) => lay_strata(built, places, section, seats.clone(), Some(regrade.before), findings),
    }?;
    let plate = regrade.and_then(|regrade| regrade.plate);
    let plain = regrade.filter(|regrade| regrade.scales && !built.stands_on_layers());
    let of_seat = |seat: usize| {
        let x = places.seats[seat].0;
        Some(Stack {
            bearing: bearing(&body, places.spacings(seat, built.spacing.map_or(0.6, |s| *s))),
            layers: stack(&layers, x)?,
            plate: plate.map(|plate| (plate, lever(&plate, x))),
            before: plain.and_then(|regrade| stack(regrade.before, x)),
        })
    };
    let stacks: Vec<Stack> = seats.clone().map(of_seat).collect::<Option<_>>()?;
    let mut carried = Vec::with_capacity(seats.len());
    for (seat, found) in seats.zip(supports.carried(&stacks)) {
        match found {
            Ok(found) => carried.push(found),
            Err(_) if !depends => return Some(Vec::new()),
            Err(wrong) => {
                carry_nothing(built, places, seat, wrong, findings);
                return None;
            }
        }
    }
    Some(carried)
}

fn carry_nothing(built: &Built, places: &Places, seat: usize, wrong: FoundationError, findings: &mut Findings) {
    let seat = places.named(&(seat..seat + 1));
    let message = format!("the layers of trackform `{}` carry no sleeper at {seat}: {wrong}", built.name);
    findings.report(
        Diagnostic::new(Code::E0407, message)
            .at(built.layers_span, "its support is computed from these")
            .help("give every layer a thickness and a modulus there, and sleepers that do not lie on each other"),
    );
}

/// Whether every layer has a modulus; `None` where one has none and something depends on it.
fn knows_moduli(
    built: &Built,
    strata: &[Stratum],
    regrade: Option<&Regrade<'_>>,
    depends: bool,
    asked: Asked,
    findings: &mut Findings,
) -> Option<bool> {
    let scaled = regrade.filter(|regrade| regrade.scales && !built.stands_on_layers());
    let before = scaled.and_then(|regrade| regrade.before.iter().find(|layer| layer.youngs_modulus().is_none()));
    let unknown: Vec<&Stratum> = strata.iter().filter(|stratum| stratum.modulus_unknown()).collect();
    if unknown.is_empty() && before.is_none() {
        return Some(true);
    }
    if !depends || asked.layers_do {
        return Some(false);
    }
    if unknown.is_empty() {
        let name = before.map_or("", |layer| layer.name.as_str());
        let message = format!(
            "granular `{name}` under the stretch needs its `youngs_modulus`: the support changes as the layers do"
        );
        findings.report(Diagnostic::new(Code::E0419, message).at(built.layers_span, "compared with the layers under them").help(
            "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or let the stretch state its `support`",
        ));
    }
    unknown.into_iter().for_each(|stratum| without_modulus(&built.name, stratum, findings));
    None
}

fn without_modulus(form: &str, stratum: &Stratum, findings: &mut Findings) {
    let (name, at, used): (&str, Span, Span) = stratum.places();
    findings.report(
        Diagnostic::new(
            Code::E0419,
            format!("granular `{name}` needs its `youngs_modulus`: the layers of trackform `{form}` carry its sleepers"),
        )
        .at(at, "grains know contacts, not a modulus")
        .at(used, "computed from here down")
        .help(
            "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or state the trackform's `support`",
        ),
    );
}
