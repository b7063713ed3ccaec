//! The layers of a trackform as written, before they are laid along the track.

use super::material::{Ground, ground};
use crate::check::evaluate::value::{Record, Slot, Val};
use crate::check::findings::Findings;
use crate::check::places::along::Along;
use crate::check::text::files::Files;
use crate::diag::{Code, Diagnostic, Span};
use crate::scenario::Given;

/// A layer before it is laid along the track.
pub struct Stratum {
    pub name: String,
    pub ground: Ground,
    pub thickness: Thickness,
    /// The place of the thickness in the text.
    pub span: Span,
    /// The place of the material, and the place at which the layer names it.
    material: [Span; 2],
}

/// The given thickness of a layer.
pub enum Thickness {
    Given(Along),
    /// The rest of the depth of the layers that the stretch changes.
    Rest,
}

impl Stratum {
    /// Whether its support cannot be computed.
    pub(super) fn modulus_unknown(&self) -> bool {
        matches!(self.ground, Ground::Granular(_, None))
    }

    /// Name and place of its material, and the place at which the layer names it.
    pub fn places(&self) -> (&str, Span, Span) {
        (&self.name, self.material[0], self.material[1])
    }
}

/// The layers of a trackform, downwards; `None` if one is not understood. Layers of a stretch may have `rest`.
pub fn strata(form: &Record, of_stretch: bool, files: &mut Files<'_>, findings: &mut Findings) -> Option<Vec<Stratum>> {
    let Some(slot) = form.get("layers") else { return Some(Vec::new()) };
    let Val::Pairs(pairs) = &slot.value else { return None };
    let strata: Vec<Option<Stratum>> =
        pairs.iter().map(|(key, thickness)| stratum(key, thickness, of_stretch, files, findings)).collect();
    let strata: Vec<Stratum> = strata.into_iter().collect::<Option<_>>()?;
    let mut rests = strata.iter().filter(|stratum| matches!(stratum.thickness, Thickness::Rest));
    if let (Some(first), Some(second)) = (rests.next(), rests.next()) {
        findings.report(
            Diagnostic::new(Code::E0423, "two layers cannot both have the thickness `rest`")
                .label(second.span, "again here")
                .label(first.span, "first here")
                .help("give the thickness of all layers but one"),
        );
        return None;
    }
    Some(strata)
}

fn stratum(
    key: &Slot,
    thickness: &Slot,
    of_stretch: bool,
    files: &mut Files<'_>,
    findings: &mut Findings,
) -> Option<Stratum> {
    let material = if let Val::Record(record) = &key.value { Some(record) } else { None };
    let ground = material.and_then(|record| ground(record, files, findings));
    let along = match &thickness.value {
        Val::Number(n) => Thickness::Given(Along::Fixed(Given { value: n.value, origin: thickness.origin })),
        Val::Profile(shape) => Thickness::Given(Along::Varies(shape.clone(), thickness.origin)),
        Val::Word { .. } if of_stretch => Thickness::Rest,
        Val::Word { .. } => {
            findings.report(
                Diagnostic::new(Code::E0421, "only the layers of a stretch can have the thickness `rest`")
                    .label(thickness.span, "no depth to fill")
                    .help(
                        "a stretch keeps the depth of the trackform under it; a trackform itself gives every \
                         thickness, such as `1 m`",
                    ),
            );
            return None;
        }
        _ => return None,
    };
    let material = material?;
    let places = [material.span, key.span];
    Some(Stratum {
        name: material.name.clone(),
        ground: ground?,
        thickness: along,
        span: thickness.span,
        material: places,
    })
}
