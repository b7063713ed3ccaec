//! The support of each seat from the layers under it, and what stretches make of these.

use super::asked::Asked;
use super::layers::lay_strata;
use super::strata::Stratum;
use super::support::{Carried, Stack, Supports};
use super::trackform::Built;
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Given, Layer};
use crate::solvers::foundation::FoundationError;
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

/// By what the layers of a track carry its sleepers.
pub struct Carrying {
    pub asked: Asked,
    /// Damping over stiffness of a support that layers make, s.
    pub damping_time: Option<Given>,
    pub supports: Supports,
}

impl Carrying {
    /// Begins with nothing computed.
    pub fn new(asked: Asked, damping_time: Option<Given>) -> Carrying {
        Carrying { asked, damping_time, supports: Supports::new(asked.support_method, asked.quiet_base) }
    }
}

/// What the layers are to some seats of a section; empty where there are none, or where a modulus is not known and nothing
/// depends on it.
pub fn carried(
    built: &Built,
    places: &Places,
    section: usize,
    seats: Range<usize>,
    under: Under<'_>,
    carrying: &mut Carrying,
    findings: &mut Findings,
) -> Option<Vec<Carried>> {
    let strata = built.layers.as_ref()?;
    let regrade = if let Under::Regraded(regrade) = under { Some(regrade) } else { None };
    let depends = built.stands_on_layers() || regrade.is_some_and(|regrade| regrade.scales);
    let (Some(body), false) = (built.sleeper_body(), strata.is_empty()) else { return Some(Vec::new()) };
    if !knows_moduli(built, strata, regrade, depends, carrying.asked, findings)? {
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
        let spacings = places.spacings(seat, built.spacing.map_or(0.6, |s| *s));
        Stack::under(&body, spacings, x, &layers, plate, plain.map(|regrade| regrade.before))
    };
    let stacks: Vec<Stack> = seats.clone().map(of_seat).collect::<Option<_>>()?;
    let mut carried = Vec::with_capacity(seats.len());
    for (seat, found) in seats.zip(carrying.supports.carried(&stacks)) {
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
