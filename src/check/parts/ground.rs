//! The ground under each seat, and its changes by stretches.

use super::asked::Asked;
use super::layers::lay_strata;
use super::stack::Ground;
use super::strata::Stratum;
use super::trackform::Built;
use crate::check::findings::Findings;
use crate::check::places::chainage::Places;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{ApproachSlab, Given, Layer, Stack};
use std::ops::Range;

/// The ground of some seats.
#[derive(Clone, Copy)]
pub enum Under<'a> {
    /// The layers of their section; `None` if they are not understood.
    Section(Option<&'a [Layer]>),
    Regraded(&'a Regrade<'a>),
}

/// Changes of the layers under some seats by a stretch.
pub struct Regrade<'a> {
    /// The layers of the section.
    pub before: &'a [Layer],
    pub plate: Option<ApproachSlab>,
    /// Whether the stretch changes layers but not the stated `support`; the support then changes with the layers.
    pub scales: bool,
}

/// Requirements for the ground of a track.
#[derive(Clone, Copy)]
pub struct Carrying {
    pub asked: Asked,
    /// Damping over stiffness of a support that is computed from layers, s.
    pub damping_time: Option<Given>,
}

/// The layers under some seats of a section; empty without layers, or if a modulus is not known and nothing depends on
/// it.
pub fn stacks(
    built: &Built,
    places: &Places,
    section: usize,
    seats: Range<usize>,
    under: Under<'_>,
    carrying: Carrying,
    findings: &mut Findings,
) -> Option<Vec<Stack>> {
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
    let ground = Ground {
        body,
        layers: &layers,
        plate,
        before: plain.map(|regrade| regrade.before),
        damping_time: carrying.damping_time?,
        span: built.layers_span,
    };
    let at_seat = |seat: usize| {
        let spacings = places.spacings(seat, built.spacing.map_or(0.6, |s| *s));
        ground.at_seat(places.seats[seat].0, spacings)
    };
    seats.map(at_seat).collect()
}

/// Whether every layer has a modulus; `None` if a modulus is missing and something depends on it.
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
            "granular `{name}` under the stretch needs its `youngs_modulus`: the support changes with the layers"
        );
        findings.report(
            Diagnostic::new(Code::E0419, message)
                .label(built.layers_span, "compared with the layers under the stretch")
                .help(
                    "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or let the stretch \
                     state its `support`",
                ),
        );
    }
    unknown.into_iter().for_each(|stratum| without_modulus(&built.name, stratum, findings));
    None
}

fn without_modulus(form: &str, stratum: &Stratum, findings: &mut Findings) {
    let (name, at, used): (&str, Span, Span) = stratum.places();
    findings.report(
        Diagnostic::new(
            Code::E0419,
            format!(
                "granular `{name}` needs its `youngs_modulus`: the layers of trackform `{form}` carry its sleepers"
            ),
        )
        .label(at, "no modulus given")
        .label(used, "the support is computed from these layers")
        .help(
            "add `youngs_modulus = 110 MPa` to it (ballast of Zhai, Wang and Lin 2004), or state the trackform's \
             `support`",
        ),
    );
}
