//! The layers under the sleepers of a trackform, laid along its section.

use super::material::Ground;
use super::strata::Thickness;
use super::trackform::Built;
use crate::check::findings::Findings;
use crate::check::places::along::{Along, lay};
use crate::check::places::chainage::Places;
use crate::check::places::cover::Cover;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::{Curve, Given, Granular, Layer, Material, Origin, Piece, Profile, Soil, Varying};
use crate::units::number;
use std::ops::Range;

/// Least number of grains across a layer.
const FEWEST_GRAINS: f64 = 2.0;
/// Depths that differ by less are equal, m.
pub const TOLERANCE: f64 = 1e-3;

/// Depth of the lowest layer's bottom, m.
pub fn depth(layers: &[Layer], x: f64) -> f64 {
    layers.iter().map(|layer| layer.thickness.value_at(x)).sum()
}

/// A length in mm, for a message.
pub fn mm(length: f64) -> String {
    number((length * 1e4).round() / 10.0)
}

/// The layers of a trackform under some seats of a section. `before` are the layers of the section that a stretch
/// replaces.
pub fn lay_strata(
    built: &Built,
    places: &Places,
    section: usize,
    seats: Range<usize>,
    before: Option<&[Layer]>,
    findings: &mut Findings,
) -> Option<Vec<Layer>> {
    let (start, end) = places.sections[section];
    let cover = |what: &str, layer: &str| Cover {
        what: format!("the {what} of layer `{layer}` of trackform `{}`", built.name),
        start,
        end,
        seats: Some(seats.clone()),
        smooth: false,
    };
    let mut layers = Vec::new();
    let mut rest = None;
    let mut sound = true;
    for (i, stratum) in built.layers.as_ref()?.iter().enumerate() {
        let thickness = match &stratum.thickness {
            Thickness::Given(along) => {
                lay(along, places, &cover("thickness", &stratum.name), findings).map(Varying::from)
            }
            Thickness::Rest => {
                rest = Some((i, stratum.span));
                Some(Varying::Constant(Given::derived(0.0)))
            }
        };
        let mut modulus =
            |along: &Along| lay(along, places, &cover("Young's modulus", &stratum.name), findings).map(Varying::from);
        let material = match &stratum.ground {
            Ground::Granular(granular, along) => match along.as_ref().map(&mut modulus) {
                Some(None) => None,
                of_continuum => {
                    let youngs_modulus = of_continuum.flatten();
                    Some(Material::Granular(Box::new(Granular { youngs_modulus, ..(**granular).clone() })))
                }
            },
            Ground::Soil { youngs_modulus, poisson_ratio, density, spread, strength } => {
                modulus(youngs_modulus).map(|youngs_modulus| {
                    let (poisson_ratio, density, spread) = (*poisson_ratio, *density, *spread);
                    Material::Soil(Soil { youngs_modulus, poisson_ratio, density, spread, strength: *strength })
                })
            }
        };
        let (Some(thickness), Some(material)) = (thickness, material) else {
            sound = false;
            continue;
        };
        layers.push(Layer { name: stratum.name.clone(), material, thickness });
    }
    if !sound {
        return None;
    }
    if let (Some((i, span)), Some(before)) = (rest, before) {
        if before.is_empty() {
            findings.report(
                Diagnostic::new(Code::E0421, "`rest` needs layers of the trackform under the stretch, which has none")
                    .label(span, "no depth to fill")
                    .help("give the trackform its `layers`, or give every thickness here, such as `1 m`"),
            );
            return None;
        }
        layers[i].thickness = left_over(built, &layers, before, places, &seats, span, findings)?;
    }
    Some(layers)
}

/// The thickness that keeps the depth of the replaced layers, exact at seats and along straight profiles.
fn left_over(
    built: &Built,
    layers: &[Layer],
    before: &[Layer],
    places: &Places,
    seats: &Range<usize>,
    span: Span,
    findings: &mut Findings,
) -> Option<Varying> {
    let at_seats = places.seats[seats.clone()].iter().map(|seat| seat.0);
    let knots = layers.iter().chain(before).flat_map(|layer| layer.thickness.knots());
    let mut xs: Vec<f64> = knots.chain(at_seats).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let left = |x: f64| depth(before, x) - depth(layers, x);
    if let Some(seat) = seats.clone().find(|seat| left(places.seats[*seat].0) < -TOLERANCE) {
        let x = places.seats[seat].0;
        let message = format!(
            "`rest` has no thickness at {}: the other layers are {} mm deep, the layers under the stretch {} mm",
            places.named(&(seat..seat + 1)),
            mm(depth(layers, x)),
            mm(depth(before, x))
        );
        findings.report(
            Diagnostic::new(Code::E0423, message)
                .label(span, "the rest of the depth")
                .help(format!("make the other layers thinner, or the last layer of trackform `{}` deeper", built.name)),
        );
        return None;
    }
    let (start, end) = (*xs.first()?, *xs.last()?);
    let points = xs.into_iter().map(|x| [x, left(x).max(0.0)]).collect();
    let piece = Piece { start, end, curve: Curve::Linear(points) };
    Some(Varying::Profile(Profile { pieces: vec![piece], origin: Origin::Derived }))
}

/// The layers of a section.
pub fn lay_layers(built: &Built, places: &Places, section: usize, findings: &mut Findings) -> Option<Vec<Layer>> {
    let layers = lay_strata(built, places, section, places.seats_of(section), None, findings)?;
    hold_their_grains(built, &layers, findings).then_some(layers)
}

/// Whether each layer is thicker than two grains.
pub fn hold_their_grains(built: &Built, layers: &[Layer], findings: &mut Findings) -> bool {
    let spans: Vec<Span> = built.layers.iter().flatten().map(|stratum| stratum.span).collect();
    layers.iter().zip(spans).fold(true, |sound, (layer, span)| holds_its_grains(layer, span, findings) && sound)
}

fn holds_its_grains(layer: &Layer, span: Span, findings: &mut Findings) -> bool {
    let Some(granular) = layer.granular() else { return true };
    let (thickness, largest) = (layer.thickness.largest(), granular.grading.largest());
    let needed = FEWEST_GRAINS * largest;
    if thickness >= needed * (1.0 - 1e-9) {
        return true;
    }
    let mut mistake = Diagnostic::new(
        Code::E0511,
        format!("layer `{}` of {} mm is thinner than two of its grains", layer.name, mm(thickness)),
    )
    .label(span, format!("its largest grain has {} mm", mm(largest)));
    if let Some(cut) = granular.grading.cut_above.and_then(|cut| cut.origin.span()) {
        mistake = mistake.label(cut, "grains up to this size");
    }
    let coarse = *granular.scale > 1.0;
    if let Some(scale) = granular.scale.origin.span().filter(|_| coarse) {
        mistake = mistake.label(scale, "grains are modelled larger than they are");
    }
    let smaller = if coarse { ", or model its grains with a smaller `scale`" } else { "" };
    findings.report(
        mistake
            .help(format!("make it {} mm or more, or cut the grading with a smaller `cut_above`{smaller}", mm(needed))),
    );
    false
}
